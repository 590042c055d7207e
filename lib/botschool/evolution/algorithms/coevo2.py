"""coevo2, competitive co-evolution: the "Generalist" of Nolfi and Pagliuca (2024), "Global progress
in competitive co-evolution", https://doi.org/10.3389/frobt.2024.1470886; earlier Simione and Nolfi
(2020), "Long-term progress and behavior complexification in competitive coevolution". See
docs/specification.md, "Algorithms".

Two populations, predators and prey, evolve by turns. Copies of some individuals improve against a
few competitors that differ from each other, by steps as in OpenAI-ES. Then they meet all
competitors, and a copy enters the population only if it does well against all of them. That
discards opportunists, which do well only against the few.
"""

# Hyperparameters keep the names they have in .ini files.
# ruff: noqa: N815

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from botschool.evolution.algorithm import (
    Initial,
    Play,
    Stateful,
    algorithm,
    generations_between_saves,
)
from botschool.evolution.algorithms.drawing import draw
from botschool.evolution.algorithms.openaies import climb
from botschool.evolution.algorithms.sides import (
    PREDATORS,
    PREY,
    SIDES,
    everyone,
    mean,
    means,
    ranking,
    seen_by,
    unknown,
)
from botschool.policies.hyperparameters import WEIGHT_DECAY, hyper
from botschool.seeds import Numbers, generator

SUB_GENERATIONS = 20


def differing(fitness: np.ndarray, count: int, first: int) -> np.ndarray:
    """Choose `count` rows that differ most from each other, beginning with the row `first`.

    The next row is always the one with the largest sum of absolute differences to the rows chosen
    so far; the earlier row wins ties.
    """
    chosen = [first]
    apart = np.zeros(len(fitness))  # sum of absolute differences to the chosen rows
    while len(chosen) < count:
        differences = np.abs(fitness - fitness[chosen[-1]])
        apart += [math.fsum(row) for row in differences.tolist()]
        apart[chosen] = -1
        chosen.append(int(np.argmax(apart)))
    return np.array(chosen)


@dataclass
class AscentConfig:
    """Hyperparameters of algorithms whose populations improve by ascents."""

    ngenerations: int = hyper(
        1000, "length of the run, in generations", low=1, high=1000000000, free=True
    )
    popsize: int = hyper(80, "candidates in each of the two populations", low=1, high=10000)
    selsize: int = hyper(
        10, "candidates evolved, and competitors met, in a generation", low=1, high=10000
    )
    samplesize: int = hyper(
        20, "perturbations per sub-generation, two candidates each", low=1, high=1000000
    )
    stepsize: float = hyper(0.01, "step size of Adam", above=0, high=1000)
    noiseStdDev: float = hyper(0.02, "standard deviation of perturbations", above=0, high=1000)
    wdecay: int = hyper(0, "pull of the centre towards 0", choices=WEIGHT_DECAY)
    saveeach: int = generations_between_saves(100)


@dataclass
class Coevo2Config(AscentConfig):
    """Section [ALGO] of coevo2."""

    evolving: str = hyper(
        "best",
        "which selsize individuals a generation tries to improve",
        choices={"best": "those that do best against its competitors", "random": "any of them"},
    )


def improve(
    config: AscentConfig,
    numbers: Numbers,
    individuals: Iterable[np.ndarray],
    meet: Callable[[np.ndarray, int], np.ndarray],
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return improved copies of individuals, given and returned as (parameters, m, v).

    meet(offspring, k) returns the fitness (rows) of the offspring of sub-generation k against each
    opponent (columns).
    """
    parameters, m, v = individuals
    for k in range(SUB_GENERATIONS):
        samples, offspring = draw(numbers, parameters, config.samplesize, config.noiseStdDev)
        fitness = means(meet(offspring, k)).reshape(len(parameters), -1)
        parameters, m, v = climb(parameters, m, v, samples, fitness, config)
    return parameters, m, v


@algorithm("coevo2", "two competing populations", Coevo2Config, competitive=True)
class Coevo2(Stateful):
    """advance(play): the first call lets all meet all, each later call is a generation.

    All arrays have the order of the populations, which are sorted by mean fitness against the whole
    other population, the best first. `fitness` has predators in rows and prey in columns, as
    `seen_by` expects; nan before the first meeting.
    """

    evolves = ("generation", "parameters", "m", "v", "fitness")

    plays = SUB_GENERATIONS + 1
    sides = SIDES
    share = 0.0
    progress = math.nan
    """Local progress of the last generation: the growth of the mean fitness of the evolved
    individuals against the chosen competitors.
    """

    def __init__(
        self, config: Coevo2Config, initial: Initial, seed: int, constant_sum: bool = True
    ) -> None:
        """Start both populations; initial(index) returns a random predator and a random prey."""
        self.config = config
        self.seed = seed
        self.generation = 0
        pairs = np.array([initial(i) for i in range(config.popsize)])
        self.parameters = np.stack(np.split(pairs, 2, axis=1))
        """Parameters of predators, then prey: shape (2, popsize, parameters)."""
        self.m = np.zeros_like(self.parameters)
        self.v = np.zeros_like(self.parameters)
        self.fitness = unknown(config.popsize, constant_sum)

    @staticmethod
    def conflicts(config: Any) -> Iterator[tuple[tuple[str, ...], str]]:
        """Yield hyperparameters that cannot go together."""
        if config.selsize > config.popsize:
            yield (
                ("selsize", "popsize"),
                f"selsize = {config.selsize} is more than popsize = {config.popsize}: lower "
                "selsize",
            )

    @property
    def met(self) -> bool:
        """Return whether all predators have met all prey."""
        return not np.isnan(self.fitness.flat[0])

    @property
    def side(self) -> int:
        """Return the side that evolves in the next generation: predators and prey take turns."""
        return self.generation % 2

    def advance(self, play: Play) -> None:
        """Run a generation; the first call lets all meet all and is not a generation."""
        if not self.met:
            self.fitness = everyone(play, *self.parameters)
            self._sort()
            return
        side, other = self.side, 1 - self.side
        numbers = generator(self.seed, self.generation)

        # choose competitors that differ, and individuals to evolve: the best against them, or
        # random ones
        first = int(numbers.integers(self.config.popsize))
        competitors = differing(seen_by(other, self.fitness), self.config.selsize, first)
        before = seen_by(side, self.fitness)[:, competitors]
        best_first = self.config.evolving == "best"
        order = ranking(before) if best_first else numbers.permutation(self.config.popsize)
        chosen = order[: self.config.selsize]

        # evolve copies of them, then let them meet all
        opponents = self.parameters[other, competitors]

        def meet(offspring: np.ndarray, _: int) -> np.ndarray:
            return seen_by(side, _play(play, side, offspring, opponents))

        copies = (array[side, chosen] for array in (self.parameters, self.m, self.v))
        evolved = improve(self.config, numbers, copies, meet)
        met = _play(play, side, evolved[0], self.parameters[other])
        after = seen_by(side, met)[:, competitors]

        # rank all, newcomers first so that they win ties, and drop the worst
        fitness = np.concatenate([met, self.fitness], axis=side - 2)
        kept = ranking(seen_by(side, fitness))[: self.config.popsize]
        self.fitness = np.take(fitness, kept, axis=side - 2)
        for array, new in zip((self.parameters, self.m, self.v), evolved, strict=True):
            array[side] = np.concatenate([new, array[side]])[kept]
        self._sort()
        self.generation += 1
        self.progress = mean(after) - mean(before[chosen])

    def _sort(self) -> None:
        """Put the best of both populations first."""
        for side in (PREDATORS, PREY):
            order = ranking(seen_by(side, self.fitness))
            self.fitness = np.take(self.fitness, order, axis=side - 2)
            for array in (self.parameters, self.m, self.v):
                array[side] = array[side, order]

    def best(self) -> tuple[np.ndarray, float]:
        """Return the first of both populations, and the predator's mean fitness against all."""
        return np.concatenate(self.parameters[:, 0]), mean(seen_by(PREDATORS, self.fitness)[0])

    def summary(self) -> dict[str, float]:
        """Return the local progress, and the mean fitness of both populations."""
        sides = {name: mean(seen_by(side, self.fitness)) for side, name in enumerate(SIDES)}
        return {"local progress": self.progress, **sides}

    def individuals(self, play: Play) -> tuple[np.ndarray, np.ndarray] | None:
        """Return both populations, the best first."""
        return (self.parameters, self.fitness) if self.met else None

    def remembered(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray] | None:
        """Return the meetings of the best predator with all prey."""
        if not self.met:
            return None
        predators, prey = self.parameters
        pairs = np.stack([np.zeros(len(prey)), np.arange(len(prey))]).astype(np.int32)
        return predators[:1], prey, pairs, self.fitness[..., 0, :]

    def average_parameter(self) -> float:
        """Return the average absolute parameter of both populations."""
        return float(np.mean(np.abs(self.parameters)))


def _play(play: Play, side: int, ours: np.ndarray, theirs: np.ndarray) -> np.ndarray:
    """Let individuals of one side meet competitors; the fitness has predators in rows."""
    return everyone(play, *((ours, theirs) if side == PREDATORS else (theirs, ours)))
