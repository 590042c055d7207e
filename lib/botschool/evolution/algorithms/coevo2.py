"""coevo2, competitive co-evolution: the "Generalist" of Nolfi and Pagliuca (2024), "Global progress
in competitive co-evolution", https://doi.org/10.3389/frobt.2024.1470886; earlier Simione and Nolfi
(2020), "Long-term progress and behavior complexification in competitive coevolution". As in
docs/specification.md, "Algorithms".

Two populations, predators and prey, evolve by turns. Some individuals of one are improved, by
steps like those of OpenAI-ES, against a few competitors that differ from each other; then they
meet all competitors, and only who does well against all of them has a place in the population.
That discards the opportunists, who do well against the few only.
"""

# Hyperparameters keep the names they have in .ini files.
# ruff: noqa: N815

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from botschool.evolution.algorithm import Initial, algorithm
from botschool.evolution.algorithms.openaies import EPSILON, adam, gradient
from botschool.hyperparameters import WEIGHT_DECAY, hyper
from botschool.seeds import generator

PREDATORS, PREY = 0, 1
SIDES = ("predators", "prey")
SUB_GENERATIONS = 20

Play = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""(predators, prey), parameters of shape (p, parameters) and (q, parameters) -> fitness of every
predator against every prey, shape (p, q). A prey's fitness is 1 minus the predator's."""


def seen_by(side: int, fitness: np.ndarray) -> np.ndarray:
    """Fitness of the individuals of one side (rows) against their competitors (columns).

    fitness: of predators (rows) against prey (columns).
    """
    return fitness if side == PREDATORS else 1 - fitness.T


def mean(fitness: np.ndarray) -> float:
    """Mean of all, by an exact sum: the same bits on every machine, in any order."""
    return math.fsum(fitness.ravel().tolist()) / fitness.size


def means(fitness: np.ndarray) -> np.ndarray:
    """Mean of each row."""
    return np.array([mean(row) for row in fitness])


def ranking(fitness: np.ndarray) -> np.ndarray:
    """Rows from the best mean to the worst; of equals, the earlier row first."""
    return np.argsort(-means(fitness), kind="stable")


def differing(fitness: np.ndarray, count: int, first: int) -> np.ndarray:
    """Chooses `count` rows that differ most from each other, beginning with the row `first`.

    The next one is always the row with the largest sum of absolute differences to those chosen so
    far; of equals, the earlier one.
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
class Coevo2Config:
    """Section [ALGO] of coevo2."""

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
    evolving: str = hyper(
        "random",
        "which candidates evolve in a generation",
        choices={"random": "drawn at random", "best": "the best against the chosen competitors"},
    )
    saveeach: int = hyper(100, "generations between saves", low=1, high=1000000000, free=True)


@algorithm("coevo2", "two competing populations", Coevo2Config, competitive=True)
class Coevo2:
    """meet(play) once, then advance(play) for each generation.

    Everything is in the order of the populations, which are sorted: best mean fitness against the
    whole other population first. `fitness` is seen by the predators: predators in rows, prey in
    columns; nan before meet().
    """

    def __init__(self, config: Coevo2Config, initial: Initial, seed: int) -> None:
        """initial(index) gives two random networks in a row: the index-th predator and prey."""
        self.config = config
        self.seed = seed
        self.generation = 0
        pairs = np.array([initial(i) for i in range(config.popsize)])
        self.parameters = np.stack(np.split(pairs, 2, axis=1))
        """Of predators, then prey: shape (2, popsize, parameters)."""
        self.m = np.zeros_like(self.parameters)
        self.v = np.zeros_like(self.parameters)
        self.fitness = np.full((config.popsize, config.popsize), np.nan)

    @staticmethod
    def conflicts(config: Coevo2Config) -> Iterator[tuple[tuple[str, ...], str]]:
        """Hyperparameters that cannot go together."""
        if config.selsize > config.popsize:
            yield (
                ("selsize", "popsize"),
                f"selsize = {config.selsize} is more than popsize = {config.popsize}: lower "
                "selsize",
            )

    @property
    def met(self) -> bool:
        """Whether everyone has met everyone."""
        return not np.isnan(self.fitness[0, 0])

    @property
    def side(self) -> int:
        """Who evolves in the next generation: predators, then prey, and so on by turns."""
        return self.generation % 2

    def meet(self, play: Play) -> None:
        """First of all, everyone meets everyone."""
        self.fitness = play(*self.parameters)
        self._sort()

    def advance(self, play: Play) -> float:
        """One generation. Returns the local progress: by how much the mean fitness of the evolved
        individuals against the chosen competitors has grown.

        It changes nothing before its end, so what `play` raises leaves no trace.
        """
        side, other = self.side, 1 - self.side
        numbers = generator(self.seed, self.generation)

        # choose competitors that differ, and who evolves: the best against them, or anyone
        first = int(numbers.integers(self.config.popsize))
        competitors = differing(seen_by(other, self.fitness), self.config.selsize, first)
        before = seen_by(side, self.fitness)[:, competitors]
        best_first = self.config.evolving == "best"
        order = ranking(before) if best_first else numbers.permutation(self.config.popsize)
        chosen = order[: self.config.selsize]

        # evolve copies of them, then let them meet everyone
        evolved = [array[side, chosen] for array in (self.parameters, self.m, self.v)]
        opponents = self.parameters[other, competitors]
        for _ in range(SUB_GENERATIONS):
            evolved = self._improved(*evolved, opponents, numbers, play)
        met = _play(play, side, evolved[0], self.parameters[other])
        after = seen_by(side, met)[:, competitors]

        # everyone, newcomers first so that of equals they stay; without the worst
        everyone = np.concatenate([met, self.fitness], axis=side)
        kept = ranking(seen_by(side, everyone))[: self.config.popsize]
        self.fitness = np.take(everyone, kept, axis=side)
        for array, new in zip((self.parameters, self.m, self.v), evolved, strict=True):
            array[side] = np.concatenate([new, array[side]])[kept]
        self._sort()
        self.generation += 1
        return mean(after) - mean(before[chosen])

    def _improved(
        self,
        centres: np.ndarray,
        m: np.ndarray,
        v: np.ndarray,
        opponents: np.ndarray,
        numbers: np.random.Generator,
        play: Play,
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """A sub-generation of all chosen individuals: their next parameters, m and v.

        Each is a centre of its own, whose offspring all meet all opponents.
        """
        config = self.config
        count, size = centres.shape
        samples = numbers.standard_normal((count, config.samplesize, size))
        perturbations = config.noiseStdDev * samples
        offspring = np.empty((count, 2 * config.samplesize, size))
        offspring[:, 0::2] = centres[:, None] + perturbations
        offspring[:, 1::2] = centres[:, None] - perturbations

        met = _play(play, self.side, offspring.reshape(-1, size), opponents)
        fitness = means(seen_by(self.side, met)).reshape(count, -1)

        rising = np.array([gradient(*pair) for pair in zip(fitness, samples, strict=True)])
        m, v = adam(m, v, rising, centres, config.wdecay)
        return centres - config.stepsize * m / (np.sqrt(v) + EPSILON), m, v

    def _sort(self) -> None:
        """Puts the best of both populations first."""
        for side in (PREDATORS, PREY):
            order = ranking(seen_by(side, self.fitness))
            self.fitness = np.take(self.fitness, order, axis=side)
            for array in (self.parameters, self.m, self.v):
                array[side] = array[side, order]

    def average_parameter(self) -> float:
        """Average absolute parameter of both populations."""
        return float(np.mean(np.abs(self.parameters)))

    def state(self) -> dict[str, np.ndarray]:
        """All that a checkpoint needs besides config and seed."""
        return {
            "generation": np.array(self.generation),
            "parameters": self.parameters,
            "m": self.m,
            "v": self.v,
            "fitness": self.fitness,
        }

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """The reverse of state()."""
        self.generation = int(state["generation"])
        self.parameters, self.m, self.v = state["parameters"], state["m"], state["v"]
        self.fitness = state["fitness"]


def _play(play: Play, side: int, ours: np.ndarray, theirs: np.ndarray) -> np.ndarray:
    """Individuals of one side meet competitors; the fitness is seen by the predators."""
    return play(ours, theirs) if side == PREDATORS else play(theirs, ours)
