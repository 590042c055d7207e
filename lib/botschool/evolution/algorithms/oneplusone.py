"""(1+1)-ES with the 1/5 success rule: Rechenberg (1973), "Evolutionsstrategie"; the rule as in Kern
and others (2004), "Learning probability distributions in continuous evolutionary algorithms",
https://doi.org/10.1023/B:NACO.0000023416.59689.4e. See docs/specification.md, "(1+1)-ES".

One parent has one child per generation, and the better of the two stays. Mutations grow after a
success and shrink after a failure, so their size settles where one child in five wins.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from botschool.evolution.algorithm import Initial, RunConfig, Stateful, algorithm, mean_absolute
from botschool.evolution.algorithms.gaussian import within_limits
from botschool.linear import exp
from botschool.policies.hyperparameters import hyper
from botschool.seeds import generator


@dataclass
class OnePlusOneConfig(RunConfig):
    """Section [ALGO] of (1+1)-ES."""

    sigma: float = hyper(0.3, "standard deviation of the first mutations", above=0, high=1000)
    growth: float = hyper(
        0.33, "a success multiplies sigma by exp of this, a failure by exp of -1/4 of it",
        low=0, high=10,
    )  # fmt: skip


@algorithm("(1+1)-ES", "one parent, one child, mutations of the right size", OnePlusOneConfig)
class OnePlusOne(Stateful):
    """ask() -> parent and child; tell(their fitness) -> the better one is the next parent."""

    evolves = ("generation", "parent", "sigma")

    def __init__(self, config: OnePlusOneConfig, initial: Initial, seed: int) -> None:
        """Start with initial(0), a random genotype, as the parent."""
        self.config = config
        self.seed = seed
        self.generation = 0
        self.parent = initial(0)
        self.sigma = config.sigma

    def ask(self) -> tuple[np.ndarray, np.ndarray]:
        """Return parent and child, shape (2, parameters), and the seed of both evaluations.

        The parent is measured again, so that a lucky one does not stay for ever.
        """
        mutation = generator(self.seed, self.generation).standard_normal(len(self.parent))
        self._both = np.stack([self.parent, self.parent + self.sigma * mutation])
        return self._both, np.full(2, self.seed + self.generation, dtype=np.uint64)

    def tell(self, fitness: np.ndarray) -> None:
        """Select the next parent; fitness has shape (2,). A child as good as its parent wins."""
        success = bool(fitness[1] >= fitness[0])
        self.parent = self._both[int(success)]
        change = self.config.growth if success else -self.config.growth / 4
        self.sigma = float(within_limits(self.sigma * exp(np.array([change]))[0]))
        self.generation += 1

    def average_parameter(self) -> float:
        """Return the average absolute parameter of the parent."""
        return mean_absolute(self.parent)
