"""Compare two answers, and tell whether their difference proves anything."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from botschool.grading.declare.checks import cuts_fractions

MAX_LEAVES = 20_000
"""Largest number of arrays, numbers and texts to compare in an answer."""
TIE, TINY, SINGLE = 1e-6, 1e-9, 1e-5
"""Relative differences: TIE covers rounding in single precision, TINY in double precision, SINGLE
what `expect_close` allows in single precision."""
SHARE = 1e-2
"""Equal answers differ by less than this share of their difference from ours."""


def distance(one: Any, other: Any) -> float:
    """Return the largest relative difference of two answers; infinity if their structure differs.

    A list of numbers counts as an array, a whole number as a number.
    """
    first, second = _leaves(one), _leaves(other)
    if first is None or second is None or len(first) != len(second):
        return math.inf
    return max((_apart(a, b) for a, b in zip(first, second, strict=True)), default=0.0)


def equal(answers: list[Any]) -> bool:
    """Return whether all answers are the same."""
    return all(distance(each, answers[0]) <= TIE for each in answers)


def fits(got: Any, made: Any, ours: Any) -> bool:
    """Return whether `made` equals `got` to rounding, unless both are nearly `ours`.

    An array that cannot hold the fractions of ours equals only another one that cannot. In single
    precision, differences of large numbers have larger rounding errors.
    """
    if cuts_fractions(got, ours) != cuts_fractions(made, ours):
        return False
    error, effect = distance(got, made), distance(got, ours)
    tie = SINGLE if _in_single(got) else TIE
    return error <= tie and (effect <= tie or error <= SHARE * effect)


def _in_single(answer: Any) -> bool:
    """Return whether all numbers of an answer fit into single precision, and some have fractions.

    A correct answer in it may be this far from ours.
    """
    leaves = [leaf for _, leaf in _leaves(answer) or [] if isinstance(leaf, np.ndarray)]
    with np.errstate(over="ignore", invalid="ignore"):
        single = all((leaf.astype(np.float32) == leaf).all() for leaf in leaves)
        return single and any((leaf % 1).any() for leaf in leaves)


def weight(got: Any, made: Any, ours: Any) -> float:
    """Return how much proof a fit of `made` to `got` is: 1, 1/2 for a yes or no, or 0."""
    effect = distance(got, ours)
    if effect <= TINY or distance(got, made) > SHARE * effect:
        return 0.0
    parts = [*(_leaves(got) or []), *(_leaves(ours) or [])]
    leaves = [leaf for _, leaf in parts if isinstance(leaf, np.ndarray)]
    many = sum(leaf.size for leaf in leaves)
    choices = many < 16 and all(np.isin(leaf, (0, 1)).all() for leaf in leaves)
    return 0.5 if choices else 1.0


def counts(answer: Any, most: float = 15) -> bool:
    """Return whether an answer holds nothing but a few small whole numbers, `most` at most."""
    leaves = [leaf for _, leaf in _leaves(answer) or [] if isinstance(leaf, np.ndarray)]
    many = sum(leaf.size for leaf in leaves)
    with np.errstate(invalid="ignore"):
        return many <= most and all(
            bool(((leaf == np.round(leaf)) & (np.abs(leaf) < 100)).all()) for leaf in leaves
        )


def _leaves(value: Any) -> list[tuple[str, Any]] | None:
    """Return (place, an array or another value) of all parts; None if there are many."""
    found: list[tuple[str, Any]] = []
    waiting = [("", value)]
    while waiting:
        if len(found) + len(waiting) > MAX_LEAVES:
            return None
        place, part = waiting.pop()
        if isinstance(part, dict):
            waiting += [(f"{place}.{key}", part[key]) for key in sorted(part)]
        elif isinstance(part, (bool, int, float, np.ndarray)):
            found.append((place, _numbers(part)))
        elif isinstance(part, (list, tuple)):
            if part and all(isinstance(each, (bool, int, float)) for each in part):
                found.append((place, _numbers(part)))
            elif (table := _table(part)) is not None:
                found.append((place, table))
            else:
                waiting += [(f"{place}[{i}]", each) for i, each in enumerate(part)]
        else:
            found.append((place, part))
    return found


def _numbers(value: Any) -> np.ndarray | str:
    try:
        return np.asarray(value).astype(np.float64)
    except (OverflowError, ValueError, TypeError):
        return repr(type(value))


def _table(value: Any) -> np.ndarray | None:
    """Return a list of equally long lists or arrays as an array; None for anything else."""
    if not value or not all(isinstance(each, (list, tuple, np.ndarray)) for each in value):
        return None
    try:
        array = np.asarray(value)
    except (ValueError, TypeError, OverflowError):
        return None
    return array.astype(np.float64) if array.dtype.kind in "biuf" else None


def _apart(one: tuple[str, Any], other: tuple[str, Any]) -> float:
    """Return the relative difference of two leaves."""
    (place, a), (where, b) = one, other
    if place != where or isinstance(a, np.ndarray) != isinstance(b, np.ndarray):
        return math.inf
    if not isinstance(a, np.ndarray):
        return 0.0 if type(a) is type(b) and a == b else math.inf
    if a.shape != b.shape:
        return math.inf
    finite = np.isfinite(a)
    odd = ~finite
    if not np.array_equal(finite, np.isfinite(b)) or not np.array_equal(
        a[odd], b[odd], equal_nan=True
    ):
        return math.inf
    if not finite.any():
        return 0.0
    with np.errstate(over="ignore", invalid="ignore"):
        largest = float(np.abs(a[finite] - b[finite]).max())
        scale = float(max(np.abs(a[finite]).max(), np.abs(b[finite]).max()))
    return largest / scale if scale else 0.0
