"""Judge statements of a conclusion by the student's own data."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from botschool.labs.declare import Answers, Column, Data
from botschool.labs.measuring import interval, paired_test, permutation_test, power

Judged = tuple[Callable[[Any], bool], str]
CANNOT_TELL = "my runs cannot tell"
LEVEL, NEAR = 0.05, (0.03, 0.07)
"""Two groups differ if p is below LEVEL; if p lies within NEAR, either answer is right."""
FRESH = (
    Column(
        "median fitness in new episodes",
        lambda values: (float(np.median(values["fresh"])),),
        lambda true: 0.6 + 0.002 * abs(true[0]),
    ),
    Column(
        "95 % interval",
        lambda values: interval(values["fresh"]),
        lambda true: 1 + 0.3 * (true[1] - true[0]),
    ),
)
"""Columns for the measure "fresh": fitness in new episodes."""


def larger(
    measure: str, one: str, other: str, labels: tuple[str, str]
) -> Callable[[Data, Answers], Judged]:
    """Judge which of two conditions has the larger mean; labels: of `one` and of `other`."""

    def judge(data: Data, answers: Answers) -> Judged:
        a, b = data[one][measure], data[other][measure]
        return decided(a, b, permutation_test(a, b), labels, "permutation test")

    return judge


def larger_of_pairs(
    condition: str, one: str, other: str, labels: tuple[str, str]
) -> Callable[[Data, Answers], Judged]:
    """Judge which of two measures of the same runs has the larger mean."""

    def judge(data: Data, answers: Answers) -> Judged:
        a, b = data[condition][one], data[condition][other]
        return decided(a, b, paired_test(a, b), labels, "paired test")

    return judge


def decided(a: np.ndarray, b: np.ndarray, p: float, labels: tuple[str, str], test: str) -> Judged:
    """Return which label is right for this p, and a sentence; near LEVEL, two are right."""
    winner = labels[0] if a.mean() > b.mean() else labels[1]
    right = {winner} if p < LEVEL else {CANNOT_TELL}
    if NEAR[0] < p < NEAR[1]:
        right = {winner, CANNOT_TELL}
    told = (
        f"the {test} of your runs does not support this answer: compare the two means, and its p "
        f"with {LEVEL}."
    )
    return lambda answer: answer in right, told


def p_value(measure: str, one: str, other: str) -> Callable[[Data, Answers], Judged]:
    """Judge the p of a permutation test of two conditions."""
    return p_of(lambda data: permutation_test(data[one][measure], data[other][measure]))


def p_of(test: Callable[[Data], float]) -> Callable[[Data, Answers], Judged]:
    """Judge the p of a test of the data."""

    def judge(data: Data, answers: Answers) -> Judged:
        p = test(data)
        return (
            lambda answer: abs(answer - p) <= 0.01 + 0.2 * p,
            "your runs give another p: compute it again.",
        )

    return judge


def powerful(measure: str, one: str, other: str, runs: int) -> Callable[[Data, Answers], Judged]:
    """Judge in how many of 100 cases groups of so many runs would differ significantly."""

    def judge(data: Data, answers: Answers) -> Judged:
        found = 100 * power(data[one][measure], data[other][measure], runs)
        told = f"resampling your runs, {runs} of each, gives another share: use power."
        return lambda answer: abs(answer - found) <= 12, told

    return judge


def span(values: np.ndarray) -> tuple[float, float]:
    """Return the interval that holds 95 of 100 values."""
    low, high = np.percentile(values, [2.5, 97.5], method="nearest")
    return float(low), float(high)
