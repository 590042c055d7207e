"""The common part of CMA-ES, xNES and sNES: they draw candidates from a Gaussian distribution that
moves and changes its shape, x = mean + sigma * y, and use only the ranks of fitness.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from botschool.errors import BotschoolError
from botschool.evolution.algorithm import Initial, RunConfig, Stateful, mean_absolute
from botschool.linear import log
from botschool.policies.hyperparameters import hyper
from botschool.seeds import generator

LARGEST = 5000
"""Largest number of parameters with a full matrix; more would take gigabytes and minutes."""
SIGMAS = (1e-30, 1e6)
"""Limits of every sigma, even if fitness gives no direction for long."""


@dataclass
class GaussianConfig(RunConfig):
    """The hyperparameters that all three have in section [ALGO]."""

    popsize: int = hyper(
        0,
        "candidates in a generation, 0 for 4 + 3 ln(parameters)",
        low=0,
        high=1000000,
        alias="batchsize",
    )
    sigma: float = hyper(0.3, "standard deviation of the first candidates", above=0, high=1000)


class Gaussian(Stateful):
    """ask() -> candidates around the mean; tell(their fitness) of a subclass adapts the rest."""

    sigma: float | np.ndarray
    """Standard deviation of the candidates: one number, or one for each axis, (parameters,)."""

    def __init__(self, config: GaussianConfig, initial: Initial, seed: int) -> None:
        """Start the mean at initial(0), a random genotype."""
        self.config = config
        self.seed = seed
        self.generation = 0
        self.mean = initial(0)
        self.size = len(self.mean)
        self.popsize = config.popsize or 4 + math.floor(3 * log([self.size])[0])
        self.sigma = config.sigma

    @staticmethod
    def conflicts(config: GaussianConfig) -> Iterator[tuple[tuple[str, ...], str]]:
        """Yield hyperparameters that cannot go together."""
        if config.popsize == 1:
            yield (
                ("popsize",),
                "popsize = 1 leaves nothing to rank: set popsize = 2 or more, or 0 for 4 + 3 "
                "ln(parameters)",
            )

    def shaped(self, z: np.ndarray) -> np.ndarray:
        """Return numbers of the standard normal distribution in the distribution's shape, without
        sigma; both (popsize, parameters)."""
        return z

    def ask(self) -> tuple[np.ndarray, np.ndarray]:
        """Return candidates, shape (popsize, parameters), and the seed of each one's evaluation."""
        numbers = generator(self.seed, self.generation)
        self.z = numbers.standard_normal((self.popsize, self.size))
        self.y = self.shaped(self.z)
        return self.mean + self.sigma * self.y, self.evaluation_seeds()

    def evaluation_seeds(self) -> np.ndarray:
        """Return the same seed for all candidates of a generation: all meet the same conditions, so
        the better one wins, not the luckier one.
        """
        return np.full(self.popsize, self.seed + self.generation, dtype=np.uint64)

    def average_parameter(self) -> float:
        """Return the average absolute parameter of the mean."""
        return mean_absolute(self.mean)


def best_first(fitness: np.ndarray) -> np.ndarray:
    """Return indices from the best to the worst; the earlier wins ties."""
    return np.argsort(-fitness, kind="stable")


def utilities(count: int) -> np.ndarray:
    """Return the utilities of natural evolution strategies, from the best candidate to the worst.

    Their sum is 0 (Wierstra and others 2014, section 3.1).
    """
    numbers = np.arange(1, count + 1)
    raised = np.maximum(0, log([count / 2 + 1])[0] - log(numbers))
    return raised / math.fsum(raised.tolist()) - 1 / count


def within_limits(sigma: float | np.ndarray) -> float | np.ndarray:
    """Return sigma, limited to SIGMAS."""
    return np.clip(sigma, *SIGMAS)


def refuse_large(size: int, algorithm: str, remedy: str) -> None:
    """Raise BotschoolError for a network that is too large for a full matrix."""
    if size > LARGEST:
        raise BotschoolError(
            f"{algorithm} adapts a matrix of {size} x {size} numbers for this network's "
            f"{size} parameters, but can handle at most {LARGEST} parameters: {remedy}."
        )
