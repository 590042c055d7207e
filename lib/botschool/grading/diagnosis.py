"""Likely causes of a wrong answer: what was got against what was wanted.

A detector is a function of a Comparison. It returns a sentence if the cause that it knows explains
the whole difference, to rounding, and None otherwise; they are asked in the order of this file, and
the first sentence is said. A sentence names the mistake, never the right numbers.
To add one: write the function, decorate it with @detector, and give its example in
tests/test_grading_diagnosis.py, which also sees to it that all are silent about random numbers.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from botschool.grading.comparison import MAX_NUMBERS, Comparison, alike, arrays, parts

Detector = Callable[[Comparison], "str | None"]
DETECTORS: list[Detector] = []


def detector(function: Detector) -> Detector:
    """Adds a detector to those that are asked."""
    DETECTORS.append(function)
    return function


def diagnose(
    got: Any,
    wanted: Any,
    arguments: tuple = (),
    answer: Any = None,
    mistakes: dict[str, Any] | None = None,
) -> str:
    """A sentence about the likely cause, or "".

    mistakes: sentence -> what this mistake makes of the answer; these are looked at first.
    """
    got, wanted = np.asarray(got, dtype=np.float64), np.asarray(wanted, dtype=np.float64)
    sizes_fit = 0 < got.size <= MAX_NUMBERS and 0 < wanted.size <= MAX_NUMBERS
    if not sizes_fit or not (np.all(np.isfinite(got)) and np.all(np.isfinite(wanted))):
        return ""
    found = Comparison(got, wanted, arguments, answer)
    if alike(got, wanted):
        return ""
    for text, made in (mistakes or {}).items():
        if alike(got, made) and not alike(wanted, made):
            return text
    with np.errstate(all="ignore"):
        return next((text for each in DETECTORS if (text := each(found))), "")


# --- shapes


def of_shapes(got: tuple[int, ...], wanted: tuple[int, ...]) -> str:
    """A sentence about two shapes, without their numbers; "" if they tell nothing."""
    if len(got) == 2 and got == wanted[::-1]:
        return "Rows and columns are exchanged: transpose it (.T)."
    if [n for n in got if n != 1] == [n for n in wanted if n != 1]:
        return "An axis of length 1 is too much or missing: see keepdims, reshape and indexing."
    if len(got) == len(wanted):
        apart = [i for i in range(len(got)) if got[i] != wanted[i]]
        if len(apart) == 1 and abs(got[apart[0]] - wanted[apart[0]]) == 1:
            which = "one too many" if got[apart[0]] > wanted[apart[0]] else "one is missing"
            return f"Along axis {apart[0]} there is {which}: an off-by-one?"
    return ""


@detector
def transposed(c: Comparison) -> str | None:
    if c.got.ndim == 2 and c.same(c.wanted.T) and not alike(c.wanted, c.wanted.T):
        return "Rows and columns are exchanged: transpose it (.T)."
    return None


@detector
def reshaped(c: Comparison) -> str | None:
    if c.got.shape != c.wanted.shape and c.got.size == c.wanted.size:
        if np.array_equal(c.got.ravel(), c.wanted.ravel()) or alike(
            c.got.ravel(), c.wanted.ravel()
        ):
            return f"The numbers are right, but their shape is {c.got.shape}: reshape it."
        if c.got.ndim == 1 and c.wanted.ndim == 2 and alike(c.got, c.wanted.T.ravel()):
            return "These are the right numbers column by column, in the wrong shape."
    return None


@detector
def one_too_many_or_few(c: Comparison) -> str | None:
    if c.got.ndim != c.wanted.ndim or c.got.ndim == 0 or c.got.shape[1:] != c.wanted.shape[1:]:
        return None
    more = len(c.got) - len(c.wanted)
    if more == 1 and len(c.wanted):
        if alike(c.got[:-1], c.wanted):
            return "The last one is one too many; all before it are right."
        if alike(c.got[1:], c.wanted):
            return "The first one is one too many; all after it are right."
    if more == -1 and len(c.got):
        if alike(c.wanted[:-1], c.got):
            return "The last one is missing; all the others are right."
        if alike(c.wanted[1:], c.got):
            return "The first one is missing; all the others are right."
    return None


@detector
def other_shape(c: Comparison) -> str | None:
    return of_shapes(c.got.shape, c.wanted.shape) if c.got.shape != c.wanted.shape else None


# --- other values that are at hand


@detector
def given_back(c: Comparison) -> str | None:
    if c.wanted.ndim and c.varied > 1 and any(c.same(each) for each in c.given):
        return "This is an argument as it was given, unchanged."
    return None


@detector
def exchanged(c: Comparison) -> str | None:
    """What is expected here stands in another place of the answer."""
    for place, part in parts(c.answer) if c.telling else ():
        found = arrays(part)
        if len(found) == 1 and alike(found[0], c.wanted) and not c.same(found[0]):
            return f"What belongs here is returned as {place}: are the two exchanged?"
    return None


@detector
def along_the_other_axis(c: Comparison) -> str | None:
    functions = {"mean": np.mean, "sum": np.sum, "maximum": np.max, "minimum": np.min,
                 "deviation": np.std}  # fmt: skip
    for table in (each for each in c.given if each.ndim == 2):
        for name, function in functions.items():
            for axis in (0, 1):
                if alike(c.wanted, function(table, axis=axis)):
                    if c.same(function(table, axis=1 - axis)):
                        return f"The {name} is taken along the other axis: see axis=."
                    if c.same(function(table)):
                        return f"The {name} is taken over everything: see axis=."
    return None


_SUMMARIES: dict[str, Callable[[np.ndarray], Any]] = {
    "the largest": np.max,
    "the smallest": np.min,
    "the last": lambda values: values[-1],
    "the first": lambda values: values[0],
    "the mean": np.mean,
    "the sum": np.sum,
    "the median": np.median,
    "the place of the largest": np.argmax,
    "the place of the smallest": np.argmin,
}


@detector
def another_summary(c: Comparison) -> str | None:
    """One number is made of many, but another one than is asked for: the last for the best."""
    if c.wanted.ndim or c.got.ndim:
        return None
    for values in (*arrays(c.answer), *c.given):
        if values.ndim != 1 or len(np.unique(values)) < 3:
            continue
        made = {name: function(values) for name, function in _SUMMARIES.items()}
        wanted = [name for name, value in made.items() if alike(value, c.wanted)]
        got = [name for name, value in made.items() if c.same(value)]
        if wanted and got:
            which = " or ".join(got[:2])
            return f"This is {which} of {len(values)} values, but {wanted[0]} is asked for."
    return None


# --- order


@detector
def rows_alike(c: Comparison) -> str | None:
    if c.got.shape != c.wanted.shape or c.got.ndim == 0 or len(c.got) < 2:
        return None
    if not np.all(c.got == c.got[0]) or np.all(c.wanted == c.wanted[0]):
        return None
    if c.got.ndim == 1:
        return "All numbers are the same, but they should differ." if len(c.got) > 2 else None
    which = "last" if alike(c.got[0], c.wanted[-1]) else (
        "first" if alike(c.got[0], c.wanted[0]) else ""
    )  # fmt: skip
    if which == "last":
        return (
            "All rows are alike, and are the last one: the same array was kept again and again. "
            "Keep a copy each time (.copy())."
        )
    if which:
        return "All rows are alike, and are the first one: nothing changes on the way."
    return "All rows are alike, but they should differ."


def _whole_steps(c: Comparison) -> bool:
    return c.got.shape == c.wanted.shape and c.got.ndim > 0 and len(c.got) > 2


@detector
def backwards(c: Comparison) -> str | None:
    if c.got.shape == c.wanted.shape and c.got.ndim and c.same(c.wanted[::-1]) and c.varied > 1:
        return "The right values in reverse order."
    return None


@detector
def shifted_by_one(c: Comparison) -> str | None:
    if not _whole_steps(c) or c.varied < 2:
        return None
    for one, other, how in (
        (c.got[1:], c.wanted[:-1], "late: each stands where the next one belongs"),
        (c.got[:-1], c.wanted[1:], "early: each stands where the one before it belongs"),
    ):
        if alike(one, other) and np.any(one != one[0]):
            return f"The values come one place too {how} (off by one)."
    return None


@detector
def places_for_order(c: Comparison) -> str | None:
    """argsort for ranks, or ranks for argsort."""
    if c.got.ndim != 1 or c.got.shape != c.wanted.shape or len(np.unique(c.wanted)) < len(c.wanted):
        return None
    if len(c.got) < 3 or not alike(np.sort(c.got), np.sort(c.wanted)):
        return None
    got, wanted = (np.argsort(np.argsort(each)) for each in (c.got, c.wanted))
    if np.array_equal(got[wanted], np.arange(len(got))):
        return (
            "An order and the places in it are mixed up: argsort tells who comes first, second, "
            "..., and the argsort of that tells which place each one has."
        )
    return None


@detector
def in_another_order(c: Comparison) -> str | None:
    if c.got.shape != c.wanted.shape or c.got.size < 2 or c.varied < 2:
        return None
    if alike(np.sort(c.got, axis=None), np.sort(c.wanted, axis=None)):
        return "The right values in another order."
    return None


# --- numbers that are made of the right ones


@detector
def wrong_sign(c: Comparison) -> str | None:
    if c.same(-c.wanted):
        return "Right but for the sign: it is turned around."
    if c.got.shape == c.wanted.shape and alike(np.abs(c.got), np.abs(c.wanted)):
        wrong = int(np.sum(np.sign(c.got) != np.sign(c.wanted)))
        if np.all(c.got >= 0) and c.varied:
            return "Right but for the sign: that of negative values is lost."
        return f"Right but for the sign of {wrong} of {c.got.size} values."
    return None


@detector
def one_more_or_less(c: Comparison) -> str | None:
    whole = np.all(c.wanted == np.round(c.wanted))
    for step, word in ((1, "more"), (-1, "less")):
        if whole and c.same(c.wanted + step):
            each = "Each number is" if c.wanted.ndim else "It is"
            return f"{each} one {word} than expected (off by one: where does the counting begin?)."
    return None


@detector
def degrees(c: Comparison) -> str | None:
    if c.same(np.degrees(c.wanted)):
        return "These are degrees, but radians are asked for."
    if c.same(np.radians(c.wanted)):
        return "These are radians, but degrees are asked for."
    return None


@detector
def whole_turns(c: Comparison) -> str | None:
    if c.got.shape != c.wanted.shape:
        return None
    turns = (c.got - c.wanted) / (2 * np.pi)
    if np.any(np.abs(turns) > 0.5) and np.allclose(turns, np.round(turns), rtol=0, atol=1e-6):
        return "Right but for whole turns of 2 pi: in which range is the angle asked for?"
    return None


@detector
def a_known_factor(c: Comparison) -> str | None:
    if not c.telling:
        return None
    each = "Each number is" if c.wanted.ndim else "It is"
    known = (
        (2.0, "twice what was expected: is a factor 1/2 missing, or a sum taken for a mean of 2?"),
        (
            0.5,
            "half of what was expected: is a factor 1/2 too much, or a mean of 2 taken for a sum?",
        ),
        (1 / np.log(2), "in bits: the natural logarithm (np.log) is asked for, not np.log2."),
        (1 / np.log(10), "by np.log10: the natural logarithm (np.log) is asked for."),
        (100.0, "100 times what was expected: a share is asked for, not per cent."),
    )
    for factor, text in known:
        if c.same(factor * c.wanted):
            return f"{each} {text}"
    for n in c.counts:
        if c.same(n * c.wanted):
            return f"{each} {n} times what was expected, and {n} is a count here: a sum for a mean?"
        if c.same(c.wanted / n):
            return f"{each} 1/{n} of what was expected, and {n} is a count here: a mean for a sum?"
    for n in sorted({2, *(n + step for n in c.counts for step in (-1, 0, 1))}):
        for power in (1, 0.5, -0.5, -1):
            if c.same(c.wanted * ((n - 1) / n) ** power):
                return (
                    f"It is as if n and n - 1 were mixed up (n = {n}) in a mean, a variance or a "
                    "standard deviation: see ddof in NumPy, correction in torch."
                )
    return None


_FORMULAS: tuple[tuple[Callable[[np.ndarray], np.ndarray], str], ...] = (
    (np.square, "It is the square of what was expected: is a root missing?"),
    (np.sqrt, "It is the square root of what was expected."),
    (np.log, "It is the logarithm of what was expected: is np.exp missing?"),
    (np.exp, "It is the exponential of what was expected: is np.log missing?"),
    (np.arctanh, "It is what was expected before tanh: apply np.tanh at the end."),
    (np.tanh, "It is the tanh of what was expected: one tanh too much."),
    (np.reciprocal, "It is 1 divided by what was expected: is a fraction upside down?"),
    (lambda x: 1 - x, "It is 1 minus what was expected."),
)


@detector
def a_formula_too_much_or_missing(c: Comparison) -> str | None:
    if not c.telling or (c.wanted.size > 1 and c.varied < 2):
        return None
    return next((text for function, text in _FORMULAS if c.same(function(c.wanted))), None)


@detector
def rounded(c: Comparison) -> str | None:
    if c.got.shape != c.wanted.shape or not np.all(c.got == np.round(c.got)) or c.wanted.size < 3:
        return None
    for function in (np.trunc, np.floor, np.round):
        if np.array_equal(c.got, function(c.wanted)) and np.any(c.got):
            return (
                "The fractions are cut off: whole numbers were kept. An array of integers (as made "
                "of [0, 0], or with dtype=int) cannot hold others; // divides without rest."
            )
    return None


@detector
def added_up(c: Comparison) -> str | None:
    if not _whole_steps(c):
        return None
    if c.same(np.cumsum(c.wanted, axis=0)):
        return "Each value holds those before it, too: something is not set back to 0."
    if c.same(np.cumsum(c.wanted[::-1], axis=0)[::-1]):
        return "Each value holds those after it, too."
    return None


@detector
def in_proportion(c: Comparison) -> str | None:
    if c.got.shape != c.wanted.shape or c.varied < 3 or not np.any(c.got):
        return None
    largest = np.unravel_index(int(np.abs(c.wanted).argmax()), c.wanted.shape)
    factor = float(c.got[largest] / c.wanted[largest])
    if factor and c.same(factor * c.wanted):
        return (
            f"Each number is {factor:.6g} times what was expected: a factor is missing or too much."
        )
    return None


@detector
def a_constant_added(c: Comparison) -> str | None:
    if c.got.shape != c.wanted.shape or len(np.unique(c.wanted)) < 3:
        return None
    constant = float((c.got - c.wanted).flat[0])
    if c.same(c.wanted + constant) and abs(constant) > 1e-4 * np.ptp(c.wanted):
        return f"Each number is what was expected {'+-'[constant < 0]} {abs(constant):.6g}."
    return None


@detector
def all_zero(c: Comparison) -> str | None:
    if not np.any(c.got) and c.wanted.size > 1:
        return "All of it is 0: was it ever filled in?"
    return None


# --- where the difference is


@detector
def at_one_end(c: Comparison) -> str | None:
    """Only one of many differs, at an end."""
    if not _whole_steps(c):
        return None
    if alike(c.got[1:], c.wanted[1:]):
        return "Only the first one differs; all after it are right."
    if alike(c.got[:-1], c.wanted[:-1]):
        return "Only the last one differs; all before it are right."
    return None


@detector
def not_where_negative(c: Comparison) -> str | None:
    """Right where a sign is positive, or the other way round: half of the cases was forgotten."""
    if c.got.shape != c.wanted.shape or c.got.size < 6:
        return None
    right = np.isclose(c.got, c.wanted, rtol=1e-5, atol=1e-9)
    if not 2 < right.sum() < right.size - 2:
        return None
    for name, which in (("negative", c.wanted < 0), ("positive", c.wanted > 0)):
        if np.array_equal(~right, which):
            return f"It differs wherever a {name} number was expected, and only there."
    return None
