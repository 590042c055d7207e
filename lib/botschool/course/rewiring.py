"""Robots whose parameters count with other gains: evolution masters them, known parameters do not.

A grader lets a submission train such a robot. To evolution, which begins with parameters that are
as often negative as positive, nothing has changed; parameters that were written down, or computed
without evaluating any, mean something else.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from botschool.policies.policy import Policy
from botschool.problems.native import NativeProblem


@contextmanager
def rewired(gains: np.ndarray) -> Iterator[None]:
    """While it lasts, parameter i of a network of len(gains) ones counts as gains[i] times it.

    It holds for whatever turns parameters into behaviour: Robot, controller_of, SavedRobot.
    gains: shape (parameters,), of either sign. Other problems than native ones stay as they are.
    """
    gains = np.asarray(gains, dtype=np.float64)

    def meant(genotypes: np.ndarray) -> np.ndarray:
        fits = np.shape(genotypes)[-1:] == gains.shape
        return np.ascontiguousarray(genotypes * gains) if fits else genotypes

    evaluate, play, load = NativeProblem.evaluate, NativeProblem.play, Policy.load
    NativeProblem.evaluate = lambda self, policy, genotypes, *rest, **options: evaluate(
        self, policy, meant(genotypes), *rest, **options
    )
    NativeProblem.play = lambda self, policy, genotype, *rest, **options: play(
        self, policy, meant(genotype), *rest, **options
    )
    Policy.load = lambda self, genotype, normalisation: load(self, meant(genotype), normalisation)
    try:
        yield
    finally:
        NativeProblem.evaluate, NativeProblem.play, Policy.load = evaluate, play, load


class Evaluated:
    """The candidates that were evaluated, in single precision."""

    def __init__(self) -> None:
        self._rows: list[np.ndarray] = []

    def __len__(self) -> int:
        return sum(map(len, self._rows))

    def add(self, genotypes: np.ndarray) -> None:
        """Note a batch, shape (candidates, parameters)."""
        self._rows.append(np.array(genotypes, dtype=np.float32))

    def nearest(self, parameters: np.ndarray) -> np.ndarray | None:
        """Return the candidate nearest to these parameters; None if none has their number."""
        size = np.shape(parameters)[-1:]
        rows = [each for each in self._rows if each.shape[1:] == size]
        if not rows:
            return None
        found = np.concatenate(rows)
        return found[np.abs(found - parameters).max(axis=1).argmin()]


@contextmanager
def recorded() -> Iterator[Evaluated]:
    """Note, while it lasts, all candidates that native problems evaluate, as they were given."""
    evaluated, evaluate = Evaluated(), NativeProblem.evaluate

    def noting(self, policy, genotypes, *rest, **options):
        evaluated.add(genotypes)
        return evaluate(self, policy, genotypes, *rest, **options)

    NativeProblem.evaluate = noting
    try:
        yield evaluated
    finally:
        NativeProblem.evaluate = evaluate
