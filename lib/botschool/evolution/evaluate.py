"""Who computes fitness: candidates in, mean returns out; and post-evaluation."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from botschool import _core
from botschool.policy import Policy
from botschool.problems import Episodes, Outcome, Problem
from botschool.seeds import POST_EVALUATION_SEED

COLLECTED = 0.01
"""Share of the evaluation episodes in which normalisation data are collected."""


@dataclass
class Measured:
    """Fitness of each candidate, and the steps that measuring took."""

    fitness: np.ndarray
    steps: int


def mean(values: np.ndarray) -> float:
    """Mean by an exact sum: the same bits on every machine and Python, in any order."""
    return math.fsum(values.tolist()) / len(values)


class Evaluator:
    """Measures candidates of one policy on one problem.

    Holds the normalisation: its data are collected in post-evaluations only, and everything that
    lasts changes only in `refresh()`, once a generation (docs/specification.md, "Evaluation").
    A generation that breaks off before leaves no trace.
    """

    def __init__(
        self,
        problem: Problem,
        policy: Policy,
        seed: int,
        workers: int = 1,
        stopping: Callable[[], bool] = lambda: False,
    ) -> None:
        self.problem = problem
        self.policy = policy
        self.seed = seed
        self._workers = workers
        self._stopping = stopping
        self._moments = _core.Moments(policy.spec.inputs) if policy.spec.normalize else None
        self.normalisation = None
        if self._moments is not None:
            self.normalisation = np.repeat([0.0, 1.0], policy.spec.inputs)
        self._owed = self._owed_next = 0.0
        self._collected: list[tuple[float, np.ndarray, np.ndarray]] = []

    def measure(self, candidates: np.ndarray, seeds: np.ndarray) -> Measured:
        """Starts a generation: mean return of every candidate over `episodes` episodes."""
        episodes = self.policy.config.episodes
        outcome = self._run(candidates, Episodes.of(seeds, episodes))
        self._owed_next = self._owed + COLLECTED * len(outcome.fitness)
        fitness = [mean(returns) for returns in outcome.fitness.reshape(-1, episodes)]
        return Measured(np.array(fitness), int(outcome.steps.sum()))

    def post_evaluate(self, genotype: np.ndarray) -> Measured:
        """Return of one genotype in each of `pepisodes` fixed episodes; shape (pepisodes,).

        The first of them also collect normalisation data while the share collected so far is
        below 1 % of the evaluation episodes.
        """
        episodes = Episodes.of([self.seed + POST_EVALUATION_SEED], self.policy.config.pepisodes)
        collecting = 0
        if self._moments is not None:
            collecting = min(int(np.ceil(self._owed_next - 1e-9)), len(episodes))
            self._owed_next -= collecting
            episodes.collect = (np.arange(len(episodes)) < collecting).astype(np.uint8)
        outcome = self._run(genotype[None], episodes)
        robots = self.problem.interface.robots
        self._collected = [
            (float(robots * outcome.steps[i]), *np.split(outcome.moments[i], 2))
            for i in range(collecting)
        ]
        return Measured(outcome.fitness, int(outcome.steps.sum()))

    def refresh(self) -> None:
        """Ends a generation: takes the data that its post-evaluation collected into use."""
        self._owed = self._owed_next
        if self._moments is not None:
            for steps, sums, squares in self._collected:
                self._moments.add(steps, sums, squares)
            self.normalisation = self._moments.vectors()
        self._collected = []

    def _run(self, genotypes: np.ndarray, episodes: Episodes) -> Outcome:
        return self.problem.evaluate(
            self.policy,
            genotypes,
            self.normalisation,
            episodes,
            self.policy.config.maxsteps,
            self._workers,
            self._stopping,
        )

    def state(self) -> dict[str, np.ndarray]:
        """What a checkpoint needs."""
        if self._moments is None:
            return {}
        return {
            "moments": self._moments.state,
            "normalisation": self.normalisation,
            "owed": np.array(self._owed),
        }

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """The reverse of state()."""
        if self._moments is not None:
            self._moments.state = state["moments"]
            self.normalisation = state["normalisation"]
            self._owed = float(state["owed"])
