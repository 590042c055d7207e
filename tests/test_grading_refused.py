"""Tasks that refuse a library's answer to what students are to write."""

import pytest

from botschool.grading.declare.checks import Wrong
from botschool.grading.run.student import Student
from tiny_course import submit

NAMES = (
    "fractions:Fraction.limit_denominator",
    "bisect:insort_left",  # written in C, as are these
    "collections:deque.rotate",  # whose type cannot be changed: it stays, and nothing breaks
    "math:gamma",
    "colorsys:rgb_to_hsv",
    "functools:total_ordering",
    "nowhere:nothing",
)
TEXT = """
import fractions
from fractions import Fraction
from functools import total_ordering as ordered

def by_a_module():
    return int(fractions.Fraction(1, 3).limit_denominator(2))

def by_a_name_of_its_own():
    return ordered(int)

def by_a_later_import():
    from colorsys import rgb_to_hsv
    return rgb_to_hsv(0, 0, 0)

def again():
    import sys
    for name in ("fractions", "colorsys"):
        sys.modules.pop(name, None)

def by_a_second_import():
    again()
    from colorsys import rgb_to_hsv
    return rgb_to_hsv(0, 0, 0)

def by_a_second_module():
    again()
    import fractions
    return int(fractions.Fraction(1, 3).limit_denominator(2))

def by_a_reload():
    import importlib
    return int(importlib.reload(fractions).Fraction(1, 3).limit_denominator(2))

def without_finders():
    import sys
    again()
    sys.meta_path[:] = [each for each in sys.meta_path if "importlib" in str(each)]
    sys.path_importer_cache.clear()
    import colorsys
    return colorsys.rgb_to_hsv(0, 0, 0)

def by_an_own_loader():
    from importlib.machinery import SourceFileLoader
    from importlib.util import module_from_spec, spec_from_file_location
    spec = spec_from_file_location("other", fractions.__file__)
    other = module_from_spec(spec)
    spec.loader.exec_module(other)
    return int(other.Fraction(1, 3).limit_denominator(2))

def by_hand():
    import colorsys
    return [int(Fraction(6, 3)), colorsys.hsv_to_rgb(0, 0, 1)[0]]

import bisect
from math import gamma

def written_in_c():
    bisect.insort_left([], 1)

def written_in_c_by_its_name():
    return gamma(3.0)

def die():
    import os
    os._exit(1)
"""


@pytest.fixture
def student(tmp_path):
    made = Student(submit(tmp_path, TEXT), 5, refused=NAMES)
    yield made
    made.close()


@pytest.mark.parametrize(
    ("function", "name"),
    [
        ("by_a_module", "fractions.Fraction.limit_denominator"),
        ("by_a_name_of_its_own", "functools.total_ordering"),
        ("by_a_later_import", "colorsys.rgb_to_hsv"),
        ("by_a_second_import", "colorsys.rgb_to_hsv"),
        ("by_a_second_module", "fractions.Fraction.limit_denominator"),
        ("by_a_reload", "fractions.Fraction.limit_denominator"),
        ("without_finders", "colorsys.rgb_to_hsv"),
        ("written_in_c", "bisect.insort_left"),
        ("written_in_c_by_its_name", "math.gamma"),
        ("by_an_own_loader", "other.Fraction.limit_denominator"),
    ],
)
def test_a_refused_function_says_so(student, function, name):
    for _ in range(2):
        sentence = f"write it yourself: {name} is not to be used here"
        with pytest.raises(Wrong, match=rf"{function}\(\) raised RuntimeError: {sentence}"):
            student.call(function)


def test_others_of_the_same_modules_are_free(student):
    assert student.call("by_hand") == [2, 1]


def test_refused_in_the_next_child_too(student):
    with pytest.raises(Wrong, match="ended"):
        student.call("die")
    with pytest.raises(Wrong, match="write it yourself"):
        student.call("by_a_module")


def test_nothing_is_refused_elsewhere(tmp_path):
    student = Student(submit(tmp_path, TEXT), 5)
    try:
        assert student.call("by_a_later_import") == [0.0, 0.0, 0]
    finally:
        student.close()
