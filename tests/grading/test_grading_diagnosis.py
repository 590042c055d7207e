"""Likely causes of wrong answers: each detector fires on its own mistake, and on nothing random."""

import importlib
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from botschool.grading.declare import diagnosis, libraries
from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.diagnosis import DETECTORS, diagnose
from botschool.grading.declare.diagnosis.comparison import Comparison
from botschool.grading.declare.libraries import Refused
from botschool.grading.run.student import Student
from tiny_course import submit

pytestmark = pytest.mark.slow

seeds = st.integers(0, 2**32 - 1)
quickly = settings(max_examples=60, deadline=None, derandomize=True)


def table(rng, rows=5, columns=3):
    return rng.normal(size=(rows, columns))


def line(rng, n=6):
    return rng.normal(size=n)


def with_ends(rng):
    return {"terminated": line(rng), "truncated": line(rng)}


# name -> (a random case: got, wanted, arguments, answer), words of the sentence
CASES = {
    "transposed": (lambda r: (w := table(r)) is not None and (w.T.copy(), w), "transpose it"),
    "transposed square": (lambda r: ((w := table(r, 4, 4)).T, w), "transpose it"),
    "transposed maps": (
        lambda r: ((w := r.normal(size=(3, 4, 4))).swapaxes(1, 2), w), "transpose it"
    ),
    "reshaped for transposed": (
        lambda r: ((w := table(r)).T.reshape(5, 3), w), "reshaped where it should be transposed"
    ),
    "tanh for logistic": (
        lambda r: (np.tanh(x := line(r)), 1 / (1 + np.exp(-x))), "where the logistic function"
    ),
    "logistic for tanh": (
        lambda r: (1 / (1 + np.exp(-(x := r.normal()))), np.tanh(x)), "where tanh is asked for"
    ),
    "logistic forgotten": (
        lambda r: (x := line(r), 1 / (1 + np.exp(-x))), "before the logistic function"
    ),
    "reshaped": (lambda r: ((w := line(r))[:, None], w), "their shape is (6, 1)"),
    "column by column": (lambda r: ((w := table(r)).T.ravel(), w), "column by column"),
    "one too many": (lambda r: (np.append(w := line(r), 1.0), w), "last one is one too many"),
    "rows left over": (
        lambda r: (np.vstack([w := table(r), np.zeros((4, 3))]), w), "but 4 more of zeros follow"
    ),
    "one before": (lambda r: (np.append(1.0, w := line(r)), w), "first one is one too many"),
    "last missing": (lambda r: ((w := table(r))[:-1], w), "last one is missing"),
    "first missing": (lambda r: ((w := line(r))[1:], w), "first one is missing"),
    "other length": (lambda r: (line(r, 7), line(r, 6)), "it is one too many: an off-by-one"),
    "given back": (lambda r: (x := line(r), line(r), (3, x)), "argument as it was given"),
    "cut too early": (
        lambda r: ((x := line(r, 12))[2:6].copy(), x[5:9], (x,)), "begins 3 places too early"
    ),
    "cut too late": (lambda r: ((x := line(r, 9))[5:8], x[4:9], (x,)), "1 place too late"),
    "cut at another end": (lambda r: ((x := line(r, 9))[2:8], x[2:6], (x,)), "but ends elsewhere"),
    "exchanged": (
        lambda r: ((a := with_ends(r))["terminated"], a["truncated"], (), a),
        "returned as 'truncated'",
    ),
    "exchanged in a list": (
        lambda r: (x := line(r), y := line(r), (), [x, y]), "number 2 of your values"
    ),
    "exchanged in a row": (
        lambda r: ((a := with_ends(r))["truncated"], a["terminated"], (), [{"x": 1.5}, a]),
        "returned as 'terminated'",
    ),
    "n runs": (
        lambda r: ((w := line(r)) * 3 / 4, w, ([{"x": line(r, 9)}] * 4,)), "divided by 4 where 3"
    ),
    "other axis": (
        lambda r: ((t := table(r, 4, 4)).mean(axis=0), t.mean(axis=1), (t,)), "along the other axis"
    ),
    "all axes": (lambda r: ((t := table(r)).sum(), t.sum(axis=1)[:1], (t[:1],)), ""),
    "a forgotten copy": (lambda r: (np.tile((w := table(r))[-1], (5, 1)), w), ".copy()"),
    "rows like the first": (lambda r: (np.tile((w := table(r))[0], (5, 1)), w), "the first one."),
    "rows alike": (lambda r: (np.tile(line(r, 3), (5, 1)), table(r)), "All rows are equal"),
    "numbers alike": (lambda r: (np.full(6, 0.3), line(r)), "All numbers are the same"),
    "last for best": (
        lambda r: ((h := line(r, 20) + 9 * (np.arange(20) == 5))[-1], h.max(), (), {"h": h}),
        "of 20 values, but the largest is asked for",
    ),
    "sum for mean": (
        lambda r: ((x := line(r, 8)).sum(), x.mean(), (x,)), "the sum of 8 values, but the mean"
    ),
    "backwards": (lambda r: ((w := line(r))[::-1], w), "reverse order"),
    "late": (lambda r: (np.roll(w := line(r), 1), w), "one place too late"),
    "early": (lambda r: (np.append((w := line(r))[1:], 0.0), w), "one place too early"),
    "rows late": (lambda r: (np.vstack([line(r, 3), (w := table(r))[:-1]]), w), "too late"),
    "places": (
        lambda r: (np.argsort(w := np.roll(c := r.permutation(9), 1)[np.argsort(c)]), w), "argsort"
    ),
    "another order": (
        lambda r: ((w := np.sort(line(r, 8)))[[3, 1, 0, 2, 7, 5, 6, 4]], w), "another order"
    ),
    "wrong sign": (lambda r: (-(w := line(r)), w), "reversed"),
    "wrong sign of a number": (lambda r: (-(w := r.normal()), w), "reversed"),
    "sign lost": (lambda r: (np.abs(w := np.array([*line(r), -9, 9])), w), "have lost theirs"),
    "some signs": (lambda r: (-(w := np.abs(line(r))) * [1, -1, 1, 1, 1, 1], w), "sign of 5 of 6"),
    "one more": (lambda r: ((w := r.integers(3, 12, 5)) + 1, w), "one more than expected"),
    "one less": (lambda r: ((w := int(r.integers(3, 12))) - 1, w), "one less than expected"),
    "degrees": (lambda r: (np.degrees(w := line(r)), w), "These are degrees"),
    "radians": (lambda r: (np.radians(w := line(r)), w), "These are radians"),
    "turns": (lambda r: ((w := line(r)) + [0, 2 * np.pi, 0, 0, 0, 0], w), "whole turns"),
    "half turns": (lambda r: ((w := line(r, 3)) + [np.pi, 0, -np.pi], w), "half turns"),
    "twice": (lambda r: (2 * (w := line(r)), w), "twice"),
    "twice a number": (lambda r: (2 * (w := r.normal()), w), "twice"),
    "half": (lambda r: ((w := table(r)) / 2, w), "half of"),
    "bits": (lambda r: ((w := r.normal()) / np.log(2), w), "in bits"),
    "n times": (lambda r: (17 * (w := r.normal()), w, (line(r, 17),)), "17 times"),
    "1/n": (lambda r: ((w := line(r, 3)) / 17, w, (table(r, 17, 3),)), "1/17"),
    "n for n - 1": (lambda r: ((w := r.normal()) * 16 / 17, w, (line(r, 17),)), "see ddof"),
    "deviation": (
        lambda r: ((x := line(r, 9)).std(), x.std(ddof=1), (x,)), "divided by 9 under"
    ),
    "deviation by n - 1": (
        lambda r: ((x := line(r, 9)).std(ddof=1), x.std(), (x,)), "divided by 8 under"
    ),
    "square": (lambda r: ((w := line(r)) ** 2, w), "square of"),
    "tanh forgotten": (lambda r: (np.arctanh(w := np.tanh(line(r))), w), "before tanh"),
    "logarithm": (lambda r: (np.log(w := r.uniform(0.1, 5, 6)), w), "np.exp missing"),
    "upside down": (lambda r: (1 / (w := line(r)), w), "upside down"),
    "1 minus": (lambda r: (1 - (w := line(r)), w), "1 minus"),
    "rounded": (lambda r: (np.trunc(w := 9 * line(r) + [20, 0, 0, 0, 0, 0]), w), "cut off"),
    "rounded to two places": (lambda r: (np.round(w := line(r), 2), w), "to 2 digits"),
    "added up": (lambda r: (np.cumsum(w := line(r)), w), "those before it"),
    "in proportion": (lambda r: (0.37 * (w := line(r)), w), "0.37 times"),
    "a constant": (lambda r: ((w := line(r)) - 0.7, w), "- 0.7"),
    "zeros": (lambda r: (np.zeros(6), line(r)), "All"),
    "the first differs": (lambda r: ((w := line(r)) + [1, 0, 0, 0, 0, 0], w), "Only the first"),
    "the last differs": (lambda r: ((w := line(r)) + [0, 0, 0, 0, 0, 1], w), "Only the last"),
    "negative ones": (
        lambda r: (np.maximum(w := line(r, 40), 0), w), "wherever a negative number"
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
@quickly
@given(seed=seeds)
def test_fires_on_its_mistake(name, seed):
    case, words = CASES[name]
    assert words in diagnose(*case(np.random.default_rng(seed)))[1]


@quickly
@given(seeds, st.sampled_from([(), (1,), (2,), (7,), (1, 4), (5, 3), (4, 4)]))
def test_is_silent_about_random_numbers(seed, shape):
    rng = np.random.default_rng(seed)
    got, wanted, other = rng.normal(size=(3, *shape))
    assert diagnose(got, wanted, (other, 5, [1.5, 2.5]), {"a": got, "b": other}) == ("", "")
    assert diagnose(got, got) == ("", "")


@quickly
@given(seeds, st.integers(0, 5))
def test_is_silent_when_one_number_does_not_fit(seed, at):
    """A cause must explain all of the difference."""
    rng = np.random.default_rng(seed)
    wanted = rng.normal(size=6)
    for factor, constant in ((2, 0), (-1, 0), (0.37, 0), (1, 3), (180 / np.pi, 0)):
        got = factor * wanted + constant
        got[at] += 0.37
        assert diagnose(got, wanted) == ("", "")


@quickly
@given(st.integers(0, 9), st.integers(0, 9))
def test_says_little_about_small_whole_numbers(got, wanted):
    """4 for 2 may be twice, a square, or two more: only one more and one less are said."""
    _, text = diagnose(got, wanted)
    assert not text or (abs(got - wanted) == 1 and "off by one" in text)
    assert not text or wanted > 2, "1 for 0 may be any mistake"
    assert diagnose(got / 10, wanted / 10 + 0.5)[1] == "" or got / 10 == wanted / 10 + 0.5


def test_odd_values_are_no_trouble():
    for got, wanted in (
        ([], []),
        ([np.nan], [1.0]),
        ([np.inf], [2.0]),
        (0.0, 1.0),
        ([0.0] * 3, [0.0] * 3),
    ):
        assert diagnose(np.array(got), np.array(wanted), (None, "x", {"a": [[]]}), 3)[1] in (
            "", "It is one less than expected (off by one: where does the counting begin?).",
        )  # fmt: skip
    assert diagnosis.of_shapes((3, 4), (4, 3)) and diagnosis.of_shapes((3, 1), (3,))
    assert diagnosis.of_shapes((9,), (4, 3)) == ""


def test_every_detector_has_an_example():
    """With all others silent, some case above makes each of them speak."""
    silent = {each.__name__ for each in DETECTORS}
    for case, _ in CASES.values():
        for seed in range(3):
            got, wanted, *others = case(np.random.default_rng(seed))
            got, wanted = np.asarray(got, dtype=float), np.asarray(wanted, dtype=float)
            found = Comparison(got, wanted, *others)
            with np.errstate(all="ignore"):
                silent -= {each.__name__ for each in DETECTORS if each(found)}
    assert not silent


# --- Tasks that refuse a library's answer to what students are to write.


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
    made = Student(submit(tmp_path, TEXT), 5, refused=Refused(NAMES))
    yield made
    made.close()


@pytest.mark.parametrize(
    ("function", "name"),
    [
        ("by_a_module", "fractions.Fraction.limit_denominator"),
        ("by_a_name_of_its_own", "functools.total_ordering"),
        ("by_a_later_import", "colorsys.rgb_to_hsv"),
        ("written_in_c", "bisect.insort_left"),
        ("written_in_c_by_its_name", "math.gamma"),
    ],
)
def test_a_refused_function_says_so(student, function, name):
    for _ in range(2):
        sentence = f"write it yourself: {name} is not to be used here"
        with pytest.raises(Wrong, match=rf"{function}\(\) raised RuntimeError: {sentence}"):
            student.call(function)


@pytest.mark.parametrize(
    "function",
    [
        "by_a_second_import",
        "by_a_second_module",
        "by_a_reload",
        "without_finders",
        "by_an_own_loader",
    ],
)
def test_the_text_of_its_module_cannot_run_again(student, function):
    with pytest.raises(Wrong, match=r"PermissionError.*(fractions|colorsys)\.py"):
        student.call(function)


def test_others_of_the_same_modules_are_free(student):
    assert student.call("by_hand") == [2, 1]


def test_refused_in_the_next_child_too(student):
    with pytest.raises(Wrong, match="ended"):
        student.call("die")
    with pytest.raises(Wrong, match="write it yourself"):
        student.call("by_a_module")


def own_parts():
    """Each function and class of ours that a task refuses."""
    lists = [each for each in vars(libraries).values() if isinstance(each, tuple)]
    return sorted({name for each in lists for name in each if re.match("botschool.*:", name)})


@pytest.mark.parametrize("name", own_parts())
def test_a_name_that_is_refused_has_its_function_there(name):
    """One that a class has from its parent would stay open."""
    place, _, attribute = name.partition(":")
    *owners, last = attribute.split(".")
    owner = importlib.import_module(place)
    for each in owners:
        owner = getattr(owner, each)
    assert last in vars(owner)


def test_nothing_is_refused_elsewhere(tmp_path):
    student = Student(submit(tmp_path, TEXT), 5)
    try:
        assert student.call("by_a_later_import") == [0.0, 0.0, 0]
    finally:
        student.close()
