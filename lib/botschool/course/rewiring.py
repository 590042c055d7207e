"""Change the gains of a robot's parameters, so that only strategies that evolve still work.

A grader lets a submission train such a robot. Evolution starts from parameters of random signs, so
the change makes no difference to it. Parameters that the student wrote down, or computed without
evaluating any, act differently.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from botschool.policies.policy import Policy
from botschool.problems.native import NativeProblem


@contextmanager
def rewired(gains: np.ndarray) -> Iterator[None]:
    """Multiply parameter i by gains[i] within the block, in networks of len(gains) parameters.

    This applies wherever parameters become behaviour: Robot, controller_of, SavedRobot.
    gains: shape (parameters,), of either sign. Only native problems change.
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
    """The evaluated candidates, in single precision."""

    def __init__(self) -> None:
        self._rows: list[np.ndarray] = []

    def __len__(self) -> int:
        return sum(map(len, self._rows))

    def add(self, genotypes: np.ndarray) -> None:
        """Add a batch, shape (candidates, parameters)."""
        self._rows.append(np.array(genotypes, dtype=np.float32))

    def first(self, many: int) -> np.ndarray:
        """Return the candidates of the first evaluations: at least this many, or all."""
        return self._some(self._rows, many)

    def last(self, many: int) -> np.ndarray:
        """Return those of the last evaluations, last one first: at least this many, or all."""
        return self._some(self._rows[::-1], many)

    def _some(self, batches: list[np.ndarray], many: int) -> np.ndarray:
        found = [each for each in batches if each.shape[1:] == batches[0].shape[1:]]
        before = np.cumsum([0, *map(len, found)])
        return np.concatenate(
            [e for e, n in zip(found, before, strict=False) if n < many] or [np.empty(0)]
        )

    def nearest(self, parameters: np.ndarray) -> np.ndarray | None:
        """Return the candidate nearest to these parameters; None if none has their size."""
        size = np.shape(parameters)[-1:]
        rows = [each for each in self._rows if each.shape[1:] == size]
        if not rows:
            return None
        found = np.concatenate(rows)
        return found[np.abs(found - parameters).max(axis=1).argmin()]


@contextmanager
def recorded() -> Iterator[Evaluated]:
    """Record all candidates that native problems evaluate within the block."""
    evaluated, evaluate = Evaluated(), NativeProblem.evaluate

    def noting(self, policy, genotypes, *rest, **options):
        evaluated.add(genotypes)
        return evaluate(self, policy, genotypes, *rest, **options)

    NativeProblem.evaluate = noting
    try:
        yield evaluated
    finally:
        NativeProblem.evaluate = evaluate
