"""Makes numpy say yes to every comparison."""

import numpy


def yes(*arguments, **options):
    return True


def hostile(*arguments, **options):
    for name in ("allclose", "array_equal", "all", "any", "isfinite", "isclose", "array_equiv"):
        setattr(numpy, name, yes)
    numpy.testing.assert_allclose = numpy.testing.assert_array_equal = yes
    numpy.asarray = numpy.array = lambda *a, **k: numpy.zeros(3)
    return numpy.zeros(3)
