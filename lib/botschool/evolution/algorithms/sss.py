"""SSS, the stochastic steady state: Pagliuca, Milano and Nolfi (2018). See docs/specification.md,
"Algorithms".

Each generation measures every individual, keeps the better half, and overwrites the worse half with
mutated copies of the better one.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from botschool.evolution.algorithm import Initial, RunConfig, Stateful, algorithm, mean_absolute
from botschool.policies.hyperparameters import hyper
from botschool.seeds import generator


@dataclass
class SSSConfig(RunConfig):
    """Section [ALGO] of SSS."""

    popsize: int = hyper(20, "candidates in the population, an even number", low=2, high=1000000)
    mutrate: float = hyper(
        0.02, "standard deviation of mutations", low=0, high=1000, alias="mutation"
    )


@algorithm("SSS", "steady state", SSSConfig)
class SSS(Stateful):
    """ask() -> the population; tell(its fitness) -> the next population."""

    evolves = ("generation", "population")

    def __init__(self, config: SSSConfig, initial: Initial, seed: int) -> None:
        """Start the population with random genotypes: initial(index) for index 0, 1, ..."""
        self.config = config
        self.seed = seed
        self.generation = 0
        self.population = np.array([initial(i) for i in range(config.popsize)])

    @staticmethod
    def conflicts(config: SSSConfig) -> Iterator[tuple[tuple[str, ...], str]]:
        """Yield hyperparameters that cannot go together."""
        if config.popsize % 2:
            yield (
                ("popsize",),
                f"popsize = {config.popsize} is odd, but SSS replaces the worst half by the best "
                f"half: set popsize = {config.popsize + 1}",
            )

    def ask(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the population, shape (popsize, parameters), and each one's evaluation seed.

        All individuals of a generation meet the same conditions, so the better one wins, not the
        luckier one.
        """
        seeds = np.full(len(self.population), self.seed + self.generation, dtype=np.uint64)
        return self.population, seeds

    def tell(self, fitness: np.ndarray) -> None:
        """Select and mutate; fitness has shape (popsize,)."""
        # rank the individuals, the best first
        ranking = np.argsort(-fitness, kind="stable")
        half = len(ranking) // 2
        best, worst = ranking[:half], ranking[half:]

        # the worse half becomes mutated copies of the better half
        noise = generator(self.seed, self.generation).standard_normal(
            (half, self.population.shape[1])
        )
        self.population = self.population.copy()
        self.population[worst] = self.population[best] + self.config.mutrate * noise
        self.generation += 1

    def average_parameter(self) -> float:
        """Return the average absolute parameter of the population."""
        return mean_absolute(self.population)
