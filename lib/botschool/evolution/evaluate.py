"""Compute fitness: candidates in, mean returns out; and post-evaluate."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from botschool import _core
from botschool.policies.policy import Policy
from botschool.problems import Episodes, Outcome, Problem
from botschool.seeds import NEW_EPISODES_SEED, POST_EVALUATION_SEED

COLLECTED = 0.01
"""Share of the evaluation episodes that collect normalisation data."""


@dataclass
class Measured:
    """Fitness of each candidate, and the steps of the measurement."""

    fitness: np.ndarray
    steps: int
    behaviour: np.ndarray | None = None
    """(candidates, 2, observations): mean and standard deviation of each observation in an episode,
    averaged over the episodes; None unless asked for.
    """

    def told(self) -> tuple[np.ndarray, ...]:
        """Return the arguments of the algorithm's `tell`."""
        return (self.fitness,) if self.behaviour is None else (self.fitness, self.behaviour)


def mean(values: np.ndarray) -> float:
    """Return the mean by an exact sum: the same bits on every machine and Python, in any order."""
    return math.fsum(values.tolist()) / len(values)


def means(returns: np.ndarray, episodes: int) -> np.ndarray:
    """Return the mean of every `episodes` values in a row, each as `mean` gives it."""
    if episodes == 1:
        return returns + 0.0  # a sum of one is exact; adding 0.0 turns -0 into 0, as fsum does
    rows = returns.reshape(-1, episodes).tolist()
    return np.array([math.fsum(row) / episodes for row in rows])


class Evaluator:
    """Measures candidates of one policy on one problem.

    It holds the normalisation. Only post-evaluations collect its data, and only `refresh()`, once a
    generation, makes lasting changes (docs/specification.md, "Evaluation"). A generation that is
    interrupted earlier leaves no trace.
    """

    def __init__(
        self,
        problem: Problem,
        policy: Policy,
        seed: int,
        workers: int = 1,
        stopping: Callable[[], bool] = lambda: False,
        behaviour: bool = False,
    ) -> None:
        """Make the evaluator; behaviour: whether `measure` tells how candidates behave."""
        self.problem = problem
        self._behaviour = behaviour
        self.policy = policy
        self.seed = seed
        self._workers = workers
        self._stopping = stopping
        self._moments = _core.Moments(policy.spec.inputs) if policy.spec.normalize else None
        self.normalisation = None
        if self._moments is not None:
            self.normalisation = np.repeat([0.0, 1.0], policy.spec.inputs)
        # arrays that are the same in every generation, by the number of candidates
        self._alone: dict[int, tuple[np.ndarray, np.ndarray]] = {}
        self._post_episodes = Episodes.of([seed + POST_EVALUATION_SEED], policy.config.pepisodes)
        self._owed = self._owed_next = 0.0
        self._collected: list[tuple[float, np.ndarray, np.ndarray]] = []

    def measure(self, candidates: np.ndarray, seeds: np.ndarray) -> Measured:
        """Start a generation: mean return of every candidate over `episodes` episodes."""
        return self._measured(self._run(candidates, self._of(seeds)))

    def _of(self, seeds: np.ndarray) -> Episodes:
        """Return Episodes.of(seeds, episodes); each generation computes only the seeds anew."""
        episodes = self.policy.config.episodes
        if len(seeds) not in self._alone:
            made = Episodes.of(seeds, episodes)
            self._alone[len(seeds)] = made.candidate, made.episode
        candidate, episode = self._alone[len(seeds)]
        seed = np.asarray(seeds, dtype=np.uint64).repeat(episodes)
        collect = np.ones(len(seed), np.uint8) if self._behaviour else None
        return Episodes(candidate, seed, episode, collect)

    def _measured(self, outcome: Outcome) -> Measured:
        self._owed_next = self._owed + COLLECTED * len(outcome.fitness)
        fitness = means(outcome.fitness, self.policy.config.episodes)
        behaviour = self._behaviour_of(outcome) if self._behaviour else None
        return Measured(fitness, int(outcome.steps.sum()), behaviour)

    def _behaviour_of(self, outcome: Outcome) -> np.ndarray:
        """Return the behaviour of each candidate; all its episodes collect moments."""
        assert outcome.moments is not None
        counts = self.problem.interface.robots * outcome.steps[:, None, None].astype(np.float64)
        sums = outcome.moments.reshape(len(counts), 2, -1) / counts
        mean = sums[:, 0]
        spread = np.sqrt(np.maximum(sums[:, 1] - mean**2, 0))
        episodes = self.policy.config.episodes
        each = np.stack([mean, spread], axis=1).reshape(-1, episodes, *sums.shape[1:])
        return np.add.reduce(each, axis=1) / episodes

    @property
    def collects(self) -> int:
        """Return how many episodes of the generation's post-evaluation collect normalisation data:
        the first ones, while the share collected so far is below 1 % of the evaluation episodes.
        """
        if self._moments is None:
            return 0
        return min(math.ceil(self._owed_next - 1e-9), self.policy.config.pepisodes)

    def post_evaluate(self, genotype: np.ndarray) -> Measured:
        """Return the genotype's return in each of `pepisodes` fixed episodes; shape (pepisodes,).

        The first `collects` episodes also collect normalisation data.
        """
        episodes, collecting = self._post_episodes, self.collects
        if self._moments is not None:
            self._owed_next -= collecting
            collect = (np.arange(len(episodes)) < collecting).astype(np.uint8)
            episodes = replace(episodes, collect=collect)
        longest = self.policy.config.post_steps
        outcome = self._run(genotype[None], episodes, longest)
        robots = self.problem.interface.robots
        self._collected = [
            (float(robots * outcome.steps[i]), sums, squares)
            for i in range(collecting)
            for sums, squares in [np.split(outcome.moments[i], 2)]
        ]
        return Measured(outcome.fitness, int(outcome.steps.sum()))

    def post_fitness(self, genotype: np.ndarray, normalisation: np.ndarray | None) -> float:
        """Return the post-evaluated fitness of a genotype with normalisation vectors of its own.

        It has no effect on the run: it collects no data, and its steps do not count.
        """
        return mean(self._returns(genotype, normalisation, self._post_episodes))

    def fresh_returns(
        self, genotype: np.ndarray, normalisation: np.ndarray | None, least: int
    ) -> np.ndarray:
        """Return the genotype's return in each of as many fresh episodes as a post-evaluation has,
        `least` at least; shape (episodes,). It has no effect on the run. Raises Interrupted.
        """
        count = max(least, self.policy.config.pepisodes)
        episodes = Episodes.of([self.seed + NEW_EPISODES_SEED], count)
        return self._returns(genotype, normalisation, episodes, self._stopping)

    def _returns(self, genotype, normalisation, episodes, *stopping) -> np.ndarray:
        longest = self.policy.config.post_steps
        robot = self.policy, genotype[None], normalisation
        return self.problem.evaluate(*robot, episodes, longest, self._workers, *stopping).fitness

    def refresh(self) -> None:
        """End a generation: use the data that its post-evaluation collected from now on."""
        self._owed = self._owed_next
        if self._moments is not None:
            for steps, sums, squares in self._collected:
                self._moments.add(steps, sums, squares)
            self.normalisation = self._moments.vectors()
        self._collected = []

    def _run(
        self,
        genotypes: np.ndarray,
        episodes: Episodes,
        maxsteps: int | None = None,
    ) -> Outcome:
        return self.problem.evaluate(
            self.policy,
            genotypes,
            self.normalisation,
            episodes,
            maxsteps or self.policy.config.maxsteps,
            self._workers,
            self._stopping,
        )

    def state(self) -> dict[str, np.ndarray]:
        """Return the arrays that a checkpoint needs."""
        if self._moments is None:
            return {}
        return {
            "moments": self._moments.state,
            "normalisation": self.normalisation,
            "owed": np.array(self._owed),
        }

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Restore a state that state() returned."""
        if self._moments is not None:
            self._moments.state = state["moments"]
            self.normalisation = state["normalisation"]
            self._owed = float(state["owed"])
