"""Arrays and lists that are larger than anything asked for."""

import itertools

import numpy

_turn = itertools.count()


def hostile(*arguments, **options):
    turn = next(_turn) % 4
    if turn == 0:
        return numpy.zeros(2**27)
    if turn == 1:
        return [0.5] * 10**7
    if turn == 2:
        return numpy.broadcast_to(1.0, (10**9, 10**9))
    return numpy.zeros((0, 2**62))
