"""GA, a plain genetic algorithm: Such, Madhavan, Conti, Lehman, Stanley and Clune (2017), "Deep
neuroevolution: genetic algorithms are a competitive alternative for training deep neural networks
for reinforcement learning", https://arxiv.org/abs/1712.06567. The uniform crossover, off by
default, is Syswerda's (1989). See docs/specification.md, "GA".

Each generation measures the population, keeps the best individual as it is, and replaces all others
by mutated copies, or mixtures, of parents drawn from the best few.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from botschool.evolution.algorithm import Initial, RunConfig, Stateful, algorithm, mean_absolute
from botschool.evolution.algorithms.gaussian import best_first
from botschool.policies.hyperparameters import hyper
from botschool.seeds import generator


@dataclass
class GAConfig(RunConfig):
    """Section [ALGO] of GA."""

    popsize: int = hyper(40, "individuals of the population", low=2, high=1000000)
    selsize: int = hyper(10, "best individuals, which become parents", low=1, high=1000000)
    mutrate: float = hyper(
        0.1, "standard deviation of mutations", low=0, high=1000, alias="mutation"
    )
    crossrate: float = hyper(0.0, "share of children of two parents", low=0, high=1)


@algorithm("GA", "genetic algorithm", GAConfig)
class GA(Stateful):
    """ask() -> the population; tell(its fitness) -> the next population, the best one first."""

    evolves = ("generation", "population")

    def __init__(self, config: GAConfig, initial: Initial, seed: int) -> None:
        """Start the population with random genotypes: initial(index) for index 0, 1, ..."""
        self.config = config
        self.seed = seed
        self.generation = 0
        self.population = np.array([initial(i) for i in range(config.popsize)])

    @staticmethod
    def conflicts(config: GAConfig) -> Iterator[tuple[tuple[str, ...], str]]:
        """Yield hyperparameters that cannot go together."""
        if config.selsize > config.popsize:
            yield (
                ("selsize", "popsize"),
                f"selsize = {config.selsize} is more than popsize = {config.popsize}: lower "
                "selsize",
            )

    def ask(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the population, shape (popsize, parameters), and each one's evaluation seed.

        All individuals of a generation meet the same conditions.
        """
        seeds = np.full(len(self.population), self.seed + self.generation, dtype=np.uint64)
        return self.population, seeds

    def tell(self, fitness: np.ndarray) -> None:
        """Select, cross and mutate; fitness has shape (popsize,)."""
        count, size = self.population.shape
        numbers = generator(self.seed, self.generation)
        parents = self.population[best_first(fitness)[: self.config.selsize]]

        # each child has one parent, or with `crossrate` takes each parameter from one of two
        # parents
        first, second = numbers.integers(len(parents), size=(2, count - 1))
        crossed = numbers.random(count - 1) < self.config.crossrate
        other = (numbers.random((count - 1, size)) < 0.5) & crossed[:, None]
        children = np.where(other, parents[second], parents[first])

        children = children + self.config.mutrate * numbers.standard_normal((count - 1, size))
        self.population = np.concatenate([parents[:1], children])
        self.generation += 1

    def average_parameter(self) -> float:
        """Return the average absolute parameter of the population."""
        return mean_absolute(self.population)
