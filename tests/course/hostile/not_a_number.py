"""NaN and infinity, in the shape of an argument."""

import numpy


def hostile(*arguments, **options):
    for value in arguments:
        if isinstance(value, numpy.ndarray):
            return value * numpy.nan
    return [float("nan"), float("inf"), float("-inf")]
