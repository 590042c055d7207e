"""Detect numbers computed from the right ones, and the places where the difference is."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from botschool.grading.declare.diagnosis.comparison import Comparison, Detector, adding_to, alike

DETECTORS: list[Detector] = []
detector = adding_to(DETECTORS)

FEW = 3
"""Smaller counts do not show where the counting begins."""

# --- numbers computed from the right ones


@detector
def wrong_sign(c: Comparison) -> str | None:
    if c.same(-c.wanted):
        return "Only the sign is wrong: it is reversed."
    sizes = len(
        np.unique(np.abs(c.wanted[c.wanted != 0]))
    )  # of yes and no, nothing but signs differ
    if c.got.shape == c.wanted.shape and sizes > 1 and alike(np.abs(c.got), np.abs(c.wanted)):
        wrong = int(np.sum(np.sign(c.got) != np.sign(c.wanted)))
        if np.all(c.got >= 0) and c.varied:
            return "Only the sign is wrong: negative values have lost theirs."
        return f"Only the sign of {wrong} of {c.got.size} values is wrong."
    return None


@detector
def one_more_or_less(c: Comparison) -> str | None:
    if np.abs(c.wanted).max() < FEW:  # 1 for 0 may be any mistake
        return None
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
def turns(c: Comparison) -> str | None:
    if c.got.shape != c.wanted.shape:
        return None
    halves = (c.got - c.wanted) / np.pi
    if np.all(np.abs(halves) < 0.5) or not np.allclose(halves, np.round(halves), rtol=0, atol=1e-6):
        return None
    if np.any(np.round(halves) % 2):
        return (
            "Right except for half turns (pi): does the angle count from the opposite direction, "
            "or is it the arctan of a quotient, which cannot tell opposite directions apart "
            "(arctan2 can)?"
        )
    return "Right except for whole turns of 2 pi: in which range must the angle be?"


@detector
def a_known_factor(c: Comparison) -> str | None:
    if not c.telling:
        return None
    each = "Each number is" if c.wanted.ndim else "It is"
    known = (
        (
            2.0,
            "twice what was expected: is a factor 1/2 missing, is something added twice, or is it "
            "a sum instead of a mean of 2?",
        ),
        (
            0.5,
            "half of what was expected: is a factor 1/2 too much, or is it a mean of 2 "
            "instead of a sum?",
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
    near = {n + step for n in c.counts for step in (-1, 1) if n + step > 4}  # 2/3 may be any factor
    for n in sorted({*c.pairs, *c.counts, *near}):
        for power in (1, 0.5, -0.5, -1):
            if c.same(c.wanted * ((n - 1) / n) ** power):
                used, right = (n, n - 1) if power > 0 else (n - 1, n)
                under = "" if abs(power) == 1 else " under a root"
                return (
                    f"It is as if you divided by {used}{under} where {right} belongs (in a "
                    f"variance, covariance or deviation of {n} values: see ddof in NumPy, "
                    "correction in torch)."
                )
    return None


_FORMULAS: tuple[tuple[Callable[[np.ndarray], np.ndarray], str], ...] = (
    (np.square, "It is the square of what was expected: is a root missing?"),
    (np.sqrt, "It is the square root of what was expected."),
    (np.log, "It is the logarithm of what was expected: is np.exp missing?"),
    (np.exp, "It is the exponential of what was expected: is np.log missing?"),
    (np.arctanh, "It is what was expected before tanh: apply np.tanh at the end."),
    (
        lambda x: np.where(
            np.abs(x) < 4, np.tanh(x), np.nan
        ),  # for large numbers, tanh is always 1
        "It is the tanh of what was expected: one tanh too much.",
    ),
    (
        lambda x: np.tanh(np.log(x / (1 - x))),
        "It is tanh where the logistic function is asked for.",
    ),
    (
        lambda x: 1 / (1 + np.exp(-np.arctanh(x))),
        "It is the logistic function where tanh is asked for.",
    ),
    (lambda x: np.log(x / (1 - x)), "It is what was expected before the logistic function."),
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
        if function is np.round and len(np.unique(c.got)) < FEW:  # may be a choice of yes or no
            break
        if np.array_equal(c.got, function(c.wanted)) and np.any(c.got):
            return (
                "The fractions are cut off. An array of integers (made of [0, 0], or with "
                "dtype=int) cannot hold fractions, and // drops them."
            )
    return None


@detector
def rounded_to_places(c: Comparison) -> str | None:
    for places in (1, 2, 3):
        nearly = np.round(c.wanted, places)
        if c.same(nearly) and not alike(nearly, np.round(c.wanted, places - 1)):
            digits = "1 digit" if places == 1 else f"{places} digits"
            return (
                f"Your code rounds to {digits} after the point, but the number itself is asked for."
            )
    return None


@detector
def added_up(c: Comparison) -> str | None:
    if not c.in_rows:
        return None
    if c.same(np.cumsum(c.wanted, axis=0)):
        return "Each value includes those before it, as if a sum went on."
    if c.same(np.cumsum(c.wanted[::-1], axis=0)[::-1]):
        return "Each value includes those after it."
    return None


@detector
def in_proportion(c: Comparison) -> str | None:
    few = 3 if np.all(c.wanted == np.round(c.wanted)) else 2
    if c.got.shape != c.wanted.shape or c.varied < few or not np.any(c.got):
        return None
    largest = np.unravel_index(int(np.abs(c.wanted).argmax()), c.wanted.shape)
    factor = float(c.got[largest] / c.wanted[largest])
    if factor and c.same(factor * c.wanted):
        return f"Each number is {factor:.6g} times what was expected."
    return None


@detector
def a_constant_added(c: Comparison) -> str | None:
    if c.got.shape != c.wanted.shape or len(np.unique(c.wanted)) < 3:
        return None
    constant = float((c.got - c.wanted).flat[0])
    if c.same(c.wanted + constant) and abs(constant) > 1e-4 * np.ptp(c.wanted):
        return f"Each number is what was expected {'+-'[constant < 0]} {abs(constant):.6g}."
    return None


# --- where the difference is


@detector
def at_one_end(c: Comparison) -> str | None:
    """Return a sentence if only one of many numbers differs, at an end."""
    if not c.in_rows:
        return None
    if alike(c.got[1:], c.wanted[1:]):
        return "Only the first one differs; all after it are right."
    if alike(c.got[:-1], c.wanted[:-1]):
        return "Only the last one differs; all before it are right."
    return None


@detector
def not_where_negative(c: Comparison) -> str | None:
    """Return a sentence if numbers are right for one sign only: half of the cases is missing."""
    if c.got.shape != c.wanted.shape or c.got.size < 6:
        return None
    right = np.isclose(c.got, c.wanted, rtol=1e-5, atol=1e-9)
    if not 2 < right.sum() < right.size - 2:
        return None
    for name, which in (("negative", c.wanted < 0), ("positive", c.wanted > 0)):
        if np.array_equal(~right, which):
            return f"It differs wherever a {name} number was expected, and only there."
    return None
