"""A run of coevo2: who plays against whom, and the files that are left."""

from __future__ import annotations

import time
from datetime import timedelta
from functools import partial

import numpy as np

from botschool.errors import BotschoolError
from botschool.evolution.algorithms.coevo2 import (
    PREDATORS,
    PREY,
    SIDES,
    SUB_GENERATIONS,
    Coevo2,
    mean,
    means,
    seen_by,
)
from botschool.evolution.record import STAT, Record, RunFiles
from botschool.evolution.run import Limit, Run
from botschool.output import save_npy
from botschool.problems import Episodes

CHECKPOINT_SECONDS = 60
PLAYS = SUB_GENERATIONS + 1
"""Calls of play() in a generation."""


class CoevolutionRecord(Record):
    """What a run of coevo2 has achieved.

    The stat file is the predators': their best mean fitness so far (twice: meeting all competitors
    is measurement and post-evaluation in one), their best and their average fitness after this
    generation, each against all prey. The preys' average is 1 minus the predators'. The parameter
    is that of both. bestg is the best predator and the best prey of the newest generation.
    """

    columns = (*STAT, "local progress", *SIDES)

    def add(self, algorithm: Coevo2, progress: float) -> None:
        """Ends a generation; progress: the local one of those who have evolved."""
        rows = {side: seen_by(side, algorithm.fitness) for side in (PREDATORS, PREY)}
        best = mean(rows[PREDATORS][0])
        average = {side: mean(row) for side, row in rows.items()}
        self.best_fitness = self.bestg_fitness = max(self.best_fitness, best)
        self._rows.append(
            (
                *(self.steps, self.best_fitness, self.bestg_fitness, best, average[PREDATORS]),
                *(algorithm.average_parameter(), progress, average[PREDATORS], average[PREY]),
            )
        )


class Coevolution(Run):
    """A run of coevo2 with a seed; what `Run` says holds for it too.

    Every meeting of two is the same `episodes` episodes: those of the run's seed with numbers
    0, 1, ... So an entry of the fitness matrix is a pure function of the two who met.
    """

    parts = ("algorithm", "record")

    def begin(self) -> None:
        """Makes the two populations, the record and the budget."""
        config = self.experiment.algo
        self.algorithm = Coevo2(config, partial(self.policy.initial, self.seed), self.seed)
        self.record = CoevolutionRecord()
        self.budget = self.limit = Limit(generations=config.ngenerations)
        self._steps = self._plays = 0  # of the present generation
        self._started: tuple[float, int, float] | None = None

    def check(self) -> None:
        """Raises BotschoolError for experiments that coevo2 cannot run."""
        config, problem = self.experiment.policy, self.problem
        if not problem.native or problem.interface.robots != 2:
            raise BotschoolError(
                f"{problem.name} is not a native problem of two robots, which coevo2 needs: "
                "set environment = ErPredprey, or algo = OpenAI-ES or SSS."
            )
        if not config.heterogeneous:
            raise BotschoolError(
                "coevo2 evolves a network of its own for each robot: set heterogeneous = 1."
            )
        if config.normalize:
            raise BotschoolError(
                "coevo2 does not scale observations, as populations of all generations are to "
                "meet: set normalize = 0."
            )

    def advance(self, goes_on: bool = False) -> None:
        """One generation; the very first call lets everyone meet everyone, which is none yet.

        Raises Interrupted on request; a generation that fails is dropped.
        """
        algorithm = self.algorithm
        if algorithm.met and self._started is None:
            now = time.monotonic()
            self._started = (now, self.record.generation, self.limit.share(self))
        self._steps = self._plays = 0
        try:
            if algorithm.met:
                progress = algorithm.advance(self._play)
                self.record.steps += self._steps
                self.record.add(algorithm, progress)
            else:
                algorithm.meet(self._play)
                self.record.steps += self._steps
        finally:
            self.part = 0.0
        self.record.bestg = np.concatenate(algorithm.parameters[:, 0])
        self.report(self)

    def _play(self, predators: np.ndarray, prey: np.ndarray) -> np.ndarray:
        """Fitness of every predator against every prey, by one native call.

        The fewer ones are the outer loop, so that long rows of episodes share a network.
        """
        count = self.policy.config.episodes
        shape = (len(predators), len(prey))
        order = "C" if len(predators) <= len(prey) else "F"
        rows, columns = (index.ravel(order) for index in np.indices(shape, dtype=np.int32))
        pairs = np.stack([rows, len(predators) + columns])
        meetings = pairs.shape[1]
        outcome = self.problem.evaluate(
            self.policy,
            np.concatenate([predators, prey]),
            None,
            Episodes(
                np.ascontiguousarray(np.repeat(pairs, count, axis=1)),
                np.full(meetings * count, self.seed, dtype=np.uint64),
                np.tile(np.arange(count, dtype=np.uint32), meetings),
            ),
            self.policy.config.maxsteps,
            self.workers,
            self.stopping,
        )
        self._steps += int(outcome.steps.sum())
        if self.algorithm.met:
            self._plays += 1
            self.part = self._plays / PLAYS
            self.report(self)
        fitness = means(outcome.fitness.reshape(-1, count))
        return np.ascontiguousarray(fitness.reshape(shape, order=order))

    @property
    def _milestone(self) -> bool:
        """Whether the populations are to be kept, as every `saveeach` generations."""
        return self.record.generation % self.experiment.algo.saveeach == 0

    def due(self, seconds: float) -> bool:
        """Whether to save, so many seconds after the last time."""
        return self._milestone or seconds >= CHECKPOINT_SECONDS

    def write(self, files: RunFiles, ended: bool) -> None:
        """Writes the run files; the populations only if they are to be kept, or at the end.

        SSGg.npy: float64, (2 * popsize, parameters), predators then prey after generation g, each
        best first (mean fitness against the whole other population). SSFitGg.npy: float64,
        (2 * popsize, popsize), their own fitness against each competitor, in the same order.
        """
        self.record.write(files)
        algorithm = self.algorithm
        if algorithm.met and (ended or self._milestone):
            generation = self.record.generation
            save_npy(files.populations(generation), np.concatenate(algorithm.parameters))
            fitness = [seen_by(side, algorithm.fitness) for side in (PREDATORS, PREY)]
            save_npy(files.fitness(generation), np.concatenate(fitness))

    @property
    def _who(self) -> str:
        """Who evolved in the last generation."""
        return SIDES[1 - self.algorithm.side]

    def numbers(self) -> str:
        """What it has reached, in short: local progress, then the mean of predators and prey."""
        last = self.record.last
        return (
            f"gen. {self.record.generation}  {self._who} {last['local progress']:+.2f}  "
            f"mean {last['predators']:.2f} : {last['prey']:.2f}"
        )

    def line(self) -> str:
        """A line about the last generation."""
        generation, last = self.record.generation, self.record.last
        percent = 100 * generation / self.experiment.algo.ngenerations
        return (
            f"seed {self.seed}  generation {generation} ({percent:.1f}%)  {self._who} evolved  "
            f"steps {self.record.steps}  local progress {last['local progress']:+.3f}  "
            f"predators {last['predators']:.3f}  prey {last['prey']:.3f}  "
            f"parameter {last['average parameter']:.3f}{self._left()}"
        )

    def _left(self) -> str:
        """The time left, at the pace of this process; both sides must have had a turn, as one
        may take a hundred times as long as the other.
        """
        if self._started is None or self.record.generation < self._started[1] + 2:
            return ""
        start, _, first = self._started
        share = self.limit.share(self)
        left = (time.monotonic() - start) / (share - first) * (1 - share)
        return f"  time left {timedelta(seconds=round(left))}"

    def result(self, files: RunFiles) -> str:
        """A sentence about the whole run."""
        last = self.record.last
        return (
            f"seed {self.seed}: predators {last['predators']:.3f}, prey {last['prey']:.3f} on "
            f"average in generation {self.record.generation}, after {self.record.steps} steps; "
            f"best of both: {files.bestg}"
        )
