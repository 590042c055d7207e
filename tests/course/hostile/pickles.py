"""Objects that run a program when they are unpickled, and pickles as such."""

import os
import pickle

import numpy


class Payload:
    def __reduce__(self):
        return os.system, (f"touch {HOME}/pickled",)


def hostile(*arguments, **options):
    if len(arguments) % 2:
        return numpy.array([Payload(), Payload()], dtype=object)
    for name in ("best.npy", "history.npy", "result.npy"):
        numpy.save(name, numpy.array([Payload()], dtype=object), allow_pickle=True)
    return pickle.dumps(Payload())
