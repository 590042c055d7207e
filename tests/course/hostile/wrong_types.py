"""A value of another type each time."""

import itertools

import numpy

_values = itertools.cycle(
    [
        None, "", "1.0", "nan", b"1", True, 1j, {}, {"best": None}, set(), object(), int,
        [[]], [[1], [1, 2]], ["1", "2"], [None], [{}], 10**299, -(10**250), [10**200], range(3),
        numpy.array(["a"]), numpy.array([object()]), numpy.array([1j]), numpy.longdouble(1),
        numpy.array([1], dtype="datetime64[s]"), numpy.ma.masked, (x for x in range(3)),
        {"mean": "x", "history": [[]], "fitness": "1", "best": {}, "population": 5},
    ]
)  # fmt: skip


def hostile(*arguments, **options):
    return next(_values)
