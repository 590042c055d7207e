"""Arrays of another shape each time."""

import itertools

import numpy

_shapes = itertools.cycle([(), (0,), (1,), (0, 5), (1, 1, 1, 1), (7, 3), (2,) * 20, (10**6,)])


def hostile(*arguments, **options):
    return numpy.ones(next(_shapes))
