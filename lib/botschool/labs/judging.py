"""Ask for conclusions: statements that the student's own data judge."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from botschool.labs.declare import Answers, Column, Data, Judged, Statement, measured
from botschool.labs.measuring import interval, permutation_test, power

CANNOT_TELL = "my runs cannot tell"
LEVEL, NEAR = 0.05, (0.03, 0.07)
"""Two groups differ if p is below LEVEL; if p lies within NEAR, either answer is right."""
FRESH = (Column(np.median, "fresh", 0.6, 0.002), Column(interval, "fresh", 1))
"""Columns for the measure "fresh", fitness in new episodes: the median, its interval."""
RETURN = ("return", "fitness", "reward")
"""Words for the unit of returns."""
Test = Callable[[np.ndarray, np.ndarray], float]
"""permutation_test or paired_test: returns the p of two groups."""


def one_of(right: Iterable[Any], told: str) -> Judged:
    """Judge an answer that must be one of these."""
    found = set(right)
    return lambda answer: answer in found, told


def near(right: float, within: float, share: float, told: str) -> Judged:
    """Judge a number that may differ by this, and by this share of it."""
    return lambda answer: abs(answer - right) <= within + share * abs(right), told


def groups(
    data: Data, measure: str | tuple[str, str], conditions: tuple[str, ...]
) -> tuple[np.ndarray, np.ndarray]:
    """Return two groups: a measure of two conditions, or two measures of one condition."""
    measures = (measure,) if isinstance(measure, str) else measure
    one, other = (measured(each, data[name]) for name in conditions for each in measures)
    return one, other


def larger(
    points: int,
    measure: str | tuple[str, str],
    conditions: tuple[str, ...],
    labels: tuple[str, ...] = (),
    test: Test = permutation_test,
) -> Statement:
    """Ask which of two groups has the larger mean.

    labels: the answers if the first one has, and if the second one has; () for their names.
    """

    def judge(data: Data, answers: Answers) -> Judged:
        told = (
            f"the {test.__name__.replace('_', ' ')} of your runs does not support this answer: "
            f"compare the two means, and its p with {LEVEL}."
        )
        return one_of(winners(*groups(data, measure, conditions), labels or conditions, test), told)

    return Statement(points, conditions, judge)


def winners(
    a: np.ndarray, b: np.ndarray, labels: tuple[str, ...], test: Test = permutation_test
) -> set[str]:
    """Return the labels that are right on which group has the larger mean."""
    p = test(a, b)
    winner = labels[0] if a.mean() > b.mean() else labels[1]
    if NEAR[0] < p < NEAR[1]:
        return {winner, CANNOT_TELL}
    return {winner} if p < LEVEL else {CANNOT_TELL}


def p_value(
    points: int,
    measure: str | tuple[str, str],
    conditions: tuple[str, ...],
    test: Test = permutation_test,
) -> Statement:
    """Ask for the p of a test of two groups."""

    def judge(data: Data, answers: Answers) -> Judged:
        p = test(*groups(data, measure, conditions))
        return near(p, 0.01, 0.2, "your runs give another p: compute it again.")

    return Statement(points, conditions, judge)


def powerful(points: int, measure: str, conditions: tuple[str, ...], runs: int) -> Statement:
    """Ask in how many of 100 cases groups of so many runs would differ significantly."""

    def judge(data: Data, answers: Answers) -> Judged:
        found = 100 * power(*groups(data, measure, conditions), runs)
        told = f"resampling your runs, {runs} of each, gives another share: use power."
        return near(found, 12, 0, told)

    return Statement(points, conditions, judge)


def mean_over(
    points: int, conditions: tuple[str, ...], measure: str, within: float, over: str
) -> Statement:
    """Ask for the mean of a measure over all runs of these conditions; over: words for them."""

    def judge(data: Data, answers: Answers) -> Judged:
        found = np.concatenate([measured(measure, data[name]) for name in conditions]).mean()
        return near(float(found), within, 0.02, f"compute the mean of {measure} over {over} again.")

    return Statement(points, conditions, judge)


def side(
    ends: tuple[float, float], bound: float, labels: tuple[str, str], slack: float = 0
) -> set[str]:
    """Return the right answers on whether an interval lies above or below a bound.

    labels: for above and for below. slack: by how much the bound may differ.
    """
    low, high = ends
    return {
        labels[0] if low > bound + off else labels[1] if high < bound - off else CANNOT_TELL
        for off in (-slack, 0.0, slack)
    }


def mean_interval(values: np.ndarray) -> tuple[float, float]:
    """Return the bootstrap interval of the mean."""
    return interval(values, np.mean)


def span(values: np.ndarray) -> tuple[float, float]:
    """Return the interval that holds 95 of 100 values."""
    low, high = np.percentile(values, [2.5, 97.5], method="nearest")
    return float(low), float(high)
