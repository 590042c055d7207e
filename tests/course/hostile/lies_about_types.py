"""Returns objects of classes that pretend to be plain, and of which each look shows another."""

import itertools

import numpy


class Array(numpy.ndarray):
    shape = property(lambda self: (3,))
    size = property(lambda self: 1)
    nbytes = property(lambda self: 0)

    def tobytes(self, *_):
        return b"\xff" * 1000

    def __array_function__(self, *_, **__):
        return True

    def __array_ufunc__(self, *_, **__):
        return True


class Number(float):
    __class__ = property(lambda self: int)
    __eq__ = __le__ = __ge__ = __lt__ = __gt__ = lambda self, other: True
    __hash__ = float.__hash__


class Endless(dict):
    def items(self):
        return ((str(n), Number(n)) for n in itertools.count())


_turn = itertools.count()


def hostile(*arguments, **options):
    answers = (
        numpy.zeros(4).view(Array), [Number(1)] * 3, Endless(a=1), numpy.ma.masked_all(3),
        numpy.zeros(3, dtype=[("a", float)]), numpy.void(b"abc"), {"best": Number(1)},
        type("list", (list,), {"__iter__": lambda self: itertools.count()})([1]),
    )  # fmt: skip
    return answers[next(_turn) % len(answers)]
