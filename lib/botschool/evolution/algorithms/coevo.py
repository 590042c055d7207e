"""coevo: one population whose individuals play both sides, as followers and leaders in
ErStaybehind. See docs/specification.md, "Algorithms". It follows coevo2, the algorithm with two
populations of Nolfi and Pagliuca (2024), "Global progress in competitive co-evolution",
https://doi.org/10.3389/frobt.2024.1470886.

In a meeting (i, j) individual i drives the first robot and j the second, and the reward counts for
i. Copies of some individuals improve as first robots, by steps as in OpenAI-ES, with a few members
of the population that differ from each other. Then they meet all members, and a copy enters the
population only if it does well with all of them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from botschool.evolution.algorithm import (
    Initial,
    Play,
    Stateful,
    algorithm,
    mean_absolute,
)
from botschool.evolution.algorithms.coevo2 import (
    SUB_GENERATIONS,
    AscentConfig,
    Coevo2,
    differing,
    improve,
)
from botschool.evolution.algorithms.sides import everyone, mean, ranking
from botschool.policies.hyperparameters import hyper
from botschool.seeds import Numbers, generator

POPULATION = "population"


@dataclass
class CoevoConfig(AscentConfig):
    """Section [ALGO] of coevo."""

    ngenerations: int = hyper(
        200, "length of the run, in generations", low=1, high=1000000000, free=True
    )
    popsize: int = hyper(40, "individuals of the population", low=1, high=10000)
    selsize: int = hyper(
        10, "individuals evolved, and partners met, in a generation", low=1, high=10000
    )


@algorithm("coevo", "one population that plays both sides", CoevoConfig, competitive=True)
class Coevo(Stateful):
    """advance(play): the first call lets all meet all, each later call is a generation.

    Individuals keep their places. `fitness` holds the fitness of the row's individual as first
    robot with the column's individual; nan before the first meeting.
    """

    evolves = ("generation", "parameters", "m", "v", "fitness")

    plays = SUB_GENERATIONS + 2
    sides = (POPULATION,)
    side = 0
    share = 0.0
    progress = math.nan
    """Local progress of the last generation: the growth of the mean fitness of the evolved
    individuals with the chosen partners.
    """

    def __init__(
        self, config: CoevoConfig, initial: Initial, seed: int, constant_sum: bool = True
    ) -> None:
        """Start the population; initial(index) returns two random networks, of which the first
        counts.
        """
        self.config = config
        self.seed = seed
        self.generation = 0
        pairs = np.array([initial(i) for i in range(config.popsize)])
        self.parameters = np.ascontiguousarray(np.split(pairs, 2, axis=1)[0])
        self.m = np.zeros_like(self.parameters)
        self.v = np.zeros_like(self.parameters)
        self.fitness = np.full((config.popsize, config.popsize), np.nan)

    @staticmethod
    def conflicts(config: CoevoConfig) -> Iterator[tuple[tuple[str, ...], str]]:
        """Yield hyperparameters that cannot go together."""
        yield from Coevo2.conflicts(config)

    @property
    def met(self) -> bool:
        """Return whether all individuals have met."""
        return not np.isnan(self.fitness.flat[0])

    def _numbers(self, generation: int) -> tuple[Numbers, list[int]]:
        """Return a generation's generator, and seeds: of meetings with all, of sub-generations."""
        numbers = generator(self.seed, generation)
        return numbers, numbers.integers(2**62, size=1 + SUB_GENERATIONS).tolist()

    def advance(self, play: Play) -> None:
        """Run a generation; the first call lets all meet all and is not a generation."""
        if not self.met:
            self.fitness = self._everyone(play, self.parameters, 0)
            return
        config, (numbers, seeds) = self.config, self._numbers(self.generation)

        # choose partners that differ, and individuals to evolve
        first = int(numbers.integers(config.popsize))
        partners = differing(self.fitness.T, config.selsize, first)
        chosen = numbers.permutation(config.popsize)[: config.selsize]

        # evolve copies of them as first robots, then let them meet all
        others = self.parameters[partners]

        def meet(offspring: np.ndarray, k: int) -> np.ndarray:
            return _first(everyone(play, offspring, others, seeds[1 + k]))

        copies = (array[chosen] for array in (self.parameters, self.m, self.v))
        evolved = improve(config, numbers, copies, meet)
        after = _first(everyone(play, evolved[0], self.parameters, seeds[0]))
        progress = mean(after[:, partners]) - mean(self.fitness[np.ix_(chosen, partners)])

        # copies that are good enough replace the worst individuals, and win ties
        kept = ranking(np.concatenate([after, self.fitness]))[: config.popsize]
        new = np.sort(kept[kept < len(chosen)])
        places = np.setdiff1d(np.arange(config.popsize), kept - len(chosen))
        arrays = [array.copy() for array in (self.parameters, self.m, self.v)]
        for array, improved in zip(arrays, evolved, strict=True):
            array[places] = improved[new]

        # all meet all, under the next generation's conditions
        self.fitness = self._everyone(play, arrays[0], self.generation + 1)
        self.parameters, self.m, self.v = arrays
        self.generation += 1
        self.progress = progress

    def _everyone(self, play: Play, individuals: np.ndarray, generation: int) -> np.ndarray:
        """Return the fitness of all individuals with all others under a generation's conditions."""
        seed = self._numbers(generation)[1][0]
        return _first(everyone(play, individuals, individuals, seed))

    def best(self) -> tuple[np.ndarray, float]:
        """Return the best first robot, the best second one, and the first one's mean fitness."""
        first, second = ranking(self.fitness)[0], ranking(self.fitness.T)[0]
        pair = np.concatenate([self.parameters[first], self.parameters[second]])
        return pair, mean(self.fitness[first])

    def summary(self) -> dict[str, float]:
        """Return the local progress, and the mean fitness of the population."""
        return {"local progress": self.progress, POPULATION: mean(self.fitness)}

    def individuals(self, play: Play) -> tuple[np.ndarray, np.ndarray] | None:
        """Return the population, in its order."""
        return (self.parameters, self.fitness) if self.met else None

    def remembered(self) -> tuple | None:
        """Return the meetings of the first individual with all others."""
        if not self.met:
            return None
        count = self.config.popsize
        pairs = np.stack([np.zeros(count), np.arange(count)]).astype(np.int32)
        seed = self._numbers(self.generation)[1][0]
        return self.parameters[:1], self.parameters, pairs, seed, self.fitness[0]

    def average_parameter(self) -> float:
        """Return the average absolute parameter of the population."""
        return mean_absolute(self.parameters)


def _first(fitness: np.ndarray) -> np.ndarray:
    """Return the first robot's fitness, where both have one."""
    return fitness[0] if fitness.ndim == 3 else fitness
