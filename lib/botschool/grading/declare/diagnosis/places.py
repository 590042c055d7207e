"""Detect wrong shapes, values in other places, and wrong order."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from botschool.grading.declare.diagnosis.comparison import (
    Comparison,
    Detector,
    adding_to,
    alike,
    arrays,
    parts,
)

TELLING = 5
"""Places in an order, at least: of three, any wrong order may be the inverse of the right one."""
DETECTORS: list[Detector] = []
detector = adding_to(DETECTORS)

# --- shapes


def of_shapes(got: tuple[int, ...], wanted: tuple[int, ...]) -> str:
    """Return a sentence about two shapes, without their numbers; "" if they show no cause."""
    if len(got) == 2 and got == wanted[::-1]:
        return "The shape is that of the transpose (.T): are rows and columns exchanged?"
    if [n for n in got if n != 1] == [n for n in wanted if n != 1]:
        return (
            "There is one axis of length 1 too many, or one is missing: see keepdims, reshape and "
            "indexing."
        )
    if len(got) == len(wanted):
        apart = [i for i in range(len(got)) if got[i] != wanted[i]]
        near = len(apart) == 1 and abs(got[apart[0]] - wanted[apart[0]]) == 1
        if near and max(got[apart[0]], wanted[apart[0]]) > 2:  # one of two is no slip of counting
            which = "too many" if got[apart[0]] > wanted[apart[0]] else "too few"
            return (
                f"Along axis {apart[0]} it is one {which}: an off-by-one, or the length of "
                "something else?"
            )
    return ""


@detector
def transposed(c: Comparison) -> str | None:
    if c.wanted.ndim > 1 and c.same(np.swapaxes(c.wanted, -1, -2)):
        return "Rows and columns are exchanged: transpose it (.T)."
    return None


@detector
def reshaped_for_transposed(c: Comparison) -> str | None:
    table = c.wanted.ndim == 2 and c.varied > 2
    if table and c.got.shape == c.wanted.shape and c.same(c.wanted.T.reshape(c.wanted.shape)):
        return "It is reshaped where it should be transposed (.T): reshape keeps the order."
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
    many = len(c.wanted)
    if more > 1 and many > 1 and not np.any(c.got[many:]) and alike(c.got[:many], c.wanted):
        return f"The first {many} are right, but {more} more of zeros follow: cut them off."
    if more == -1 and len(c.got):
        if alike(c.wanted[:-1], c.got):
            return "The last one is missing; all the others are right."
        if alike(c.wanted[1:], c.got):
            return "The first one is missing; all the others are right."
    return None


@detector
def other_shape(c: Comparison) -> str | None:
    return of_shapes(c.got.shape, c.wanted.shape) if c.got.shape != c.wanted.shape else None


# --- other values at hand


@detector
def given_back(c: Comparison) -> str | None:
    if c.wanted.ndim and c.varied > 1 and any(c.same(each) for each in c.given):
        return "This is an argument as it was given, unchanged."
    return None


@detector
def cut_elsewhere(c: Comparison) -> str | None:
    """Return a sentence if both are pieces of the same list of numbers, at different places."""
    for row in c.given if c.wanted.ndim == c.got.ndim == 1 and c.varied > 2 else ():
        if row.ndim == 1 and row.size > c.wanted.size:
            right, wrong = _place(c.wanted, row), _place(c.got, row)
            if len(right) == len(wrong) == 1 and len(np.unique(c.got)) > 2:
                way = "early" if wrong[0] < right[0] else "late"
                piece = f"This is the piece [{wrong[0]}:{wrong[0] + c.got.size}] of the argument"
                by = abs(int(wrong[0] - right[0]))
                if not by:
                    return f"{piece}: it begins where it should, but ends elsewhere."
                return f"{piece}: it begins {by} place{'s' * (by > 1)} too {way}."
    return None


def _place(piece: np.ndarray, row: np.ndarray) -> np.ndarray:
    """Return where a list of numbers stands in a longer one."""
    if not 0 < piece.size <= row.size:
        return np.zeros(0, dtype=int)
    windows = np.lib.stride_tricks.sliding_window_view(row, piece.size)
    return np.flatnonzero((windows == piece).all(axis=1))


@detector
def exchanged(c: Comparison) -> str | None:
    """Return a sentence if the expected value stands in another place of the answer."""
    counted = c.wanted.ndim == 0 and c.wanted == np.round(c.wanted)  # perhaps equal by chance
    for place, part in parts(c.answer) if c.telling and not counted else ():
        found = arrays(part)
        if len(found) == 1 and alike(found[0], c.wanted) and not c.same(found[0]):
            return (
                f"What belongs here is returned as {place}: are the two exchanged, or should "
                "they be equal?"
            )
    return None


@detector
def along_the_other_axis(c: Comparison) -> str | None:
    functions: dict[str, Any] = {
        "mean": np.mean, "sum": np.sum, "maximum": np.max, "minimum": np.min, "deviation": np.std
    }  # fmt: skip
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
}


@detector
def another_summary(c: Comparison) -> str | None:
    """Return a sentence if another summary was taken: the last value instead of the best."""
    if c.wanted.ndim or c.got.ndim or not c.telling:
        return None
    for values in (*arrays(c.answer), *c.given):
        if values.ndim != 1 or len(np.unique(values)) < 3:
            continue
        made = {name: function(values) for name, function in _SUMMARIES.items()}
        wanted = [name for name, value in made.items() if alike(value, c.wanted)]
        got = [name for name, value in made.items() if c.same(value)]
        if len(wanted) == 1 and got:  # of several, which one the task asks for is open
            which = " or ".join(got[:2])
            return f"This is {which} of {len(values)} values, but {wanted[0]} is asked for."
    return None


# --- order


@detector
def all_zero(c: Comparison) -> str | None:
    if not np.any(c.got) and c.wanted.size > 1:
        return "All values are 0, but they should not be."
    return None


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
            "All rows equal the last one: the same array was kept each time. Keep a copy "
            "each time (.copy())."
        )
    if which:
        return "All rows equal the first one."
    return "All rows are equal, but they should differ."


@detector
def backwards(c: Comparison) -> str | None:
    if c.got.shape == c.wanted.shape and c.got.ndim and c.same(c.wanted[::-1]) and c.varied > 1:
        return "The right values in reverse order."
    return None


@detector
def shifted_by_one(c: Comparison) -> str | None:
    if not c.in_rows or c.varied < 2:
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
    """Return a sentence if argsort stands for ranks, or ranks for argsort."""
    if c.got.ndim != 1 or c.got.shape != c.wanted.shape or len(np.unique(c.wanted)) < len(c.wanted):
        return None
    if len(c.got) < TELLING or not alike(np.sort(c.got), np.sort(c.wanted)):
        return None
    got, wanted = (np.argsort(np.argsort(each)) for each in (c.got, c.wanted))
    if np.array_equal(got[wanted], np.arange(len(got))):
        return (
            "An order and the places in it are mixed up: np.argsort(x) tells which value comes "
            "first, second, ..., and np.argsort(np.argsort(x)) tells the place of each value."
        )
    return None


@detector
def in_another_order(c: Comparison) -> str | None:
    if c.got.shape != c.wanted.shape or c.got.size < 2 or c.varied < 2:
        return None
    if alike(np.sort(c.got, axis=None), np.sort(c.wanted, axis=None)):
        return "The right values in another order."
    return None
