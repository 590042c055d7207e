"""Run an algorithm in which two sides evolve against each other, and write its files.

The sides are always called predators and prey. In an environment of PettingZoo the predators are
the first agent.
"""

from __future__ import annotations

import math
import time
from datetime import timedelta
from functools import partial

import numpy as np

from botschool.errors import BotschoolError
from botschool.evolution.algorithm import ALGORITHMS, Competition
from botschool.evolution.algorithms.sides import PREDATORS, PREY, means, seen_by
from botschool.evolution.limit import Limit
from botschool.evolution.record import STAT, Record, RunFiles
from botschool.evolution.run import Run
from botschool.output import save_npy
from botschool.problems import Episodes

CHECKPOINT_SECONDS = 60
SAVING_SHARE = 0.05
"""Largest share of the time for checkpoints; if large archives take more, saves become rarer."""


class CoevolutionRecord(Record):
    """The results of a run with two sides.

    The stat file is the predators': their best mean fitness so far (twice, because meeting
    competitors is both measurement and post-evaluation), then their best and their average fitness
    in the newest generation. coevo2 measures it against all prey. Algorithms with archives measure
    it in the predators' newest turn, against opponents drawn from the prey's archive. For a single
    population it is the fitness as first robots. The average parameter covers both sides. bestg is
    the best predator and the best prey of the newest generation.
    """

    def __init__(self, columns: tuple[str, ...]) -> None:
        """Start the record; columns: the keys of the algorithm's summary()."""
        super().__init__()
        self.columns = (*STAT, *columns)

    def end(self, algorithm: Competition) -> None:
        """End a generation."""
        summary, (_, best) = algorithm.summary(), algorithm.best()
        self.best_fitness = self.bestg_fitness = max(self.best_fitness, best)
        self._rows.append(
            (
                *(self.steps, self.best_fitness, self.bestg_fitness, best),
                *(summary[algorithm.sides[0]], algorithm.average_parameter(), *summary.values()),
            )
        )


class Coevolution(Run):
    """A run of an algorithm with two sides and a seed; the rules of `Run` hold for it, too.

    `Play` defines the episodes of a meeting: they follow from the run's seed, or from the seed that
    the algorithm gives. So the fitness of a meeting is a pure function of the seed and the two
    individuals.
    """

    checkpointed = ("algorithm", "record")
    growing = ("record.", "algorithm.archive_")

    def begin(self) -> None:
        """Make both sides, the record and the budget."""
        config = self.experiment.algo
        self.algorithm = ALGORITHMS[self.experiment.exp.algo].make(
            config,
            partial(self.policy.initial, self.seed),
            self.seed,
            self.problem.constant_sum,
        )
        self.record = CoevolutionRecord(tuple(self.algorithm.summary()))
        steps = self.max_steps if hasattr(config, "maxmsteps") else math.inf
        self.budget = self.limit = Limit(steps, config.ngenerations or math.inf)
        self._steps = self._plays = 0  # in the present generation
        self._started: tuple[float, int, float] | None = None

    def check(self) -> None:
        """Raise BotschoolError for experiments that have no two sides."""
        config, problem, name = self.experiment.policy, self.problem, self.experiment.exp.algo
        if problem.interface.robots != 2:
            raise BotschoolError(
                f"{name} needs two robots, but {problem.name} has {problem.interface.robots}: set "
                "environment = ErPredprey or one of PettingZoo with two agents, or algo = "
                "OpenAI-ES or SSS."
            )
        if not config.heterogeneous:
            raise BotschoolError(
                f"{name} evolves a network of its own for each robot: set heterogeneous = 1."
            )
        if config.normalize:
            raise BotschoolError(
                f"{name} does not scale observations, because individuals of all generations "
                "meet: set normalize = 0."
            )

    def advance(self) -> None:
        """Run one generation, or what the algorithm does before the first one.

        Raises Interrupted on request; a generation that fails is dropped.
        """
        algorithm, generation = self.algorithm, self.record.generation
        algorithm.share = self.budget.share(self)
        began, share = time.monotonic(), self.limit.share(self)
        self._steps = self._plays = 0
        try:
            algorithm.advance(self._play)
        finally:
            self.progress = 0.0
        self.record.steps += self._steps
        self.record.bestg, _ = algorithm.best()
        if algorithm.generation > generation:
            self.record.end(algorithm)
            self._started = self._started or (began, generation, share)
        self.report(self)

    def _play(self, *meetings) -> np.ndarray:
        """Return the fitness in each meeting: the algorithm's `Play`."""
        fitness, steps = self._meet(self.stopping, *meetings)
        self._steps += steps
        if self.record.steps and self.algorithm.plays > 1:
            self._plays += 1
            self.progress = self._plays / self.algorithm.plays
            self.report(self)
        return fitness

    def _meet(self, stopping, predators, prey, pairs, seed=None) -> tuple[np.ndarray, int]:
        """Return the fitness in each meeting, as `Play` defines it, and the steps, by one call."""
        count, meetings = self.policy.config.episodes, pairs.shape[1]
        first = (pairs[1] * (seed is not None)).astype(np.uint32) * count
        places = pairs + np.array([[0], [len(predators)]], dtype=np.int32)
        outcome = self.problem.evaluate(
            self.policy,
            self.problem.rows(predators, prey),
            None,
            Episodes(
                np.ascontiguousarray(np.repeat(places, count, axis=1)),
                np.full(meetings * count, self.seed if seed is None else seed, dtype=np.uint64),
                (first[:, None] + np.arange(count, dtype=np.uint32)).ravel(),
            ),
            self.policy.config.maxsteps,
            self.workers,
            stopping,
        )
        met = means(self.problem.sided(outcome.fitness).reshape(-1, count))
        if not self.problem.constant_sum:
            met = met.reshape(2, meetings)
        return met, int(outcome.steps.sum())

    def measure(self, files: RunFiles) -> None:
        """Measure nothing: fitness is the mean against the other population."""

    def reproduces(self) -> bool:
        """Return whether meetings that the algorithm remembers end as they did, to the bit."""
        remembered = self.algorithm.remembered()
        if remembered is None:
            return True
        *meetings, fitness = remembered
        again, _ = self._meet(lambda: False, *meetings)
        return bool((again == fitness).all())

    @property
    def _milestone(self) -> bool:
        """Return whether to keep the individuals now, every `saveeach` generations."""
        return self.record.generation % self.experiment.algo.saveeach == 0

    def due(self, seconds: float) -> bool:
        """Return whether to save, this many seconds after the last save."""
        return self._milestone or seconds >= max(CHECKPOINT_SECONDS, self.saving / SAVING_SHARE)

    def write(self, files: RunFiles, ended: bool) -> None:
        """Write the run files; individuals only if they are to be kept, or at the end.

        SSGg.npy: float64, (2 n, parameters), n predators, then n prey after generation g.
        SSFitGg.npy: float64, (2 n, n), their own fitness against each competitor, in that order.
        For a single population: (n, parameters) and (n, n). The algorithm's `individuals` defines
        which individuals these are.
        """
        self.record.write(files)
        if not (ended or self._milestone):
            return
        kept = self.algorithm.individuals(lambda *meeting: self._meet(lambda: False, *meeting)[0])
        if kept is not None:
            generation, (networks, fitness) = self.record.generation, kept
            if len(self.algorithm.sides) == 2:
                networks = np.concatenate(networks)
                fitness = np.concatenate([seen_by(side, fitness) for side in (PREDATORS, PREY)])
            save_npy(files.populations(generation), networks)
            save_npy(files.fitness(generation), fitness)

    @property
    def _who(self) -> str:
        """Return the name of the side that evolved in the last generation."""
        return self.algorithm.sides[self.algorithm.side - 1]

    def numbers(self) -> str:
        """Return its results in short: local progress if known, then each side's mean."""
        last = self.record.last
        progress = f" {last['local progress']:+.2f}" if "local progress" in last else ""
        reached = " : ".join(_shown(last[side], ".2f") for side in self.algorithm.sides)
        return f"gen. {self.record.generation}  {self._who}{progress}  mean {reached}"

    def line(self) -> str:
        """Return a line about the last generation."""
        last = self.record.last
        summary = "  ".join(
            f"{name} {_shown(last[name], '+.3f' if name == 'local progress' else '.3f')}"
            for name in self.record.columns[len(STAT) :]
        )
        return (
            f"seed {self.seed}  generation {self.record.generation} "
            f"({100 * self.budget.share(self):.1f}%)  {self._who} evolved  "
            f"steps {self.record.steps}  {summary}  "
            f"parameter {last['average parameter']:.3f}{self._left()}"
        )

    def _left(self) -> str:
        """Return the time left, at the pace of this process; both sides must have had a turn, as
        one may take a hundred times as long as the other.
        """
        if self._started is None or self.record.generation < self._started[1] + 2:
            return ""
        start, _, first = self._started
        share = self.limit.share(self)
        left = (time.monotonic() - start) / (share - first) * (1 - share)
        return f"  time left {timedelta(seconds=round(left))}"

    def result(self, files: RunFiles) -> str:
        """Return a sentence about the whole run."""
        last, sides = self.record.last, self.algorithm.sides
        reached = ", ".join(f"{side} {_shown(last[side], '.3f')}" for side in sides)
        roles = self.problem.roles if len(sides) == 2 else ", then ".join(self.problem.sides)
        return (
            f"seed {self.seed}: {reached} on average in generation {self.record.generation}, "
            f"after {self.record.steps} steps; "
            f"best of both: {files.bestg}{f' ({roles})' if roles else ''}"
        )


def _shown(value: float, form: str) -> str:
    """Return the number, or - if it is not known yet."""
    return "-" if math.isnan(value) else f"{value:{form}}"
