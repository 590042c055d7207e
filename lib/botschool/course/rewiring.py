"""Robots whose parameters count with other signs: what was evolved can do them, what was known not.

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
def rewired(signs: np.ndarray) -> Iterator[None]:
    """While it lasts, parameter i of a network of len(signs) ones counts as signs[i] times it.

    It holds for whatever turns parameters into behaviour: Robot, controller_of, SavedRobot.
    signs: shape (parameters,), each -1 or 1. Other problems than native ones stay as they are.
    """
    signs = np.asarray(signs, dtype=np.float64)

    def meant(genotypes: np.ndarray) -> np.ndarray:
        fits = np.shape(genotypes)[-1:] == signs.shape
        return np.ascontiguousarray(genotypes * signs) if fits else genotypes

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
