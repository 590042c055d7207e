"""How statements of a conclusion are judged by the student's own data."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from botschool.labs.declare import Answers, Data
from botschool.labs.measuring import permutation_test, power

Judged = tuple[Callable[[Any], bool], str]
CANNOT_TELL = "my runs cannot tell"
LEVEL, NEAR = 0.05, (0.03, 0.07)
"""p below LEVEL tells two groups apart; within NEAR either answer is right."""


def larger(
    measure: str, one: str, other: str, labels: tuple[str, str]
) -> Callable[[Data, Answers], Judged]:
    """Judge which of two conditions has the larger mean; labels: one's, then the other's."""

    def judge(data: Data, answers: Answers) -> Judged:
        a, b = data[one][measure], data[other][measure]
        p = permutation_test(a, b)
        winner = labels[0] if a.mean() > b.mean() else labels[1]
        right = {winner} if p < LEVEL else {CANNOT_TELL}
        if NEAR[0] < p < NEAR[1]:
            right = {winner, CANNOT_TELL}
        told = (
            f"means of {a.mean():.4g} and {b.mean():.4g}, p = {p:.3g} (permutation test): "
            f"your runs support '{sorted(right)[0]}'."
        )
        return lambda answer: answer in right, told

    return judge


def p_value(measure: str, one: str, other: str) -> Callable[[Data, Answers], Judged]:
    """Judge the p of a permutation test of two conditions."""

    def judge(data: Data, answers: Answers) -> Judged:
        p = permutation_test(data[one][measure], data[other][measure])
        told = f"a permutation test of your runs gives p = {p:.3g}."
        return lambda answer: abs(answer - p) <= 0.01 + 0.2 * p, told

    return judge


def powerful(measure: str, one: str, other: str, runs: int) -> Callable[[Data, Answers], Judged]:
    """Judge in how many of 100 cases so many runs a group would tell two conditions apart."""

    def judge(data: Data, answers: Answers) -> Judged:
        found = 100 * power(data[one][measure], data[other][measure], runs)
        told = f"resampling your runs, {runs} of each, gives {found:.0f} of 100."
        return lambda answer: abs(answer - found) <= 12, told

    return judge


def span(values: np.ndarray) -> tuple[float, float]:
    """Where 95 of 100 values lie."""
    low, high = np.percentile(values, [2.5, 97.5], method="nearest")
    return float(low), float(high)
