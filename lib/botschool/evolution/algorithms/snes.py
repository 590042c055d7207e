"""sNES, separable natural evolution strategy: Schaul, Glasmachers and Schmidhuber (2011), "High
dimensions and heavy tails for natural evolution strategies", as in Wierstra, Schaul, Glasmachers,
Sun, Peters and Schmidhuber (2014), algorithm 6. See docs/specification.md, "sNES".

Each parameter has its own standard deviation. Mean and deviations follow the natural gradient of
the expected utility.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from botschool.evolution.algorithm import Initial, algorithm
from botschool.evolution.algorithms.drawing import draw
from botschool.evolution.algorithms.gaussian import (
    Gaussian,
    GaussianConfig,
    best_first,
    utilities,
    within_limits,
)
from botschool.linear import exp, log, weighted
from botschool.policies.hyperparameters import hyper
from botschool.seeds import generator


@dataclass
class SNESConfig(GaussianConfig):
    """Section [ALGO] of sNES."""

    etamu: float = hyper(1.0, "learning rate of the mean", above=0, high=10)
    etasigma: float = hyper(
        0.0, "learning rate of the candidates' shape, 0 for the paper's", low=0, high=10
    )


@algorithm("sNES", "natural evolution strategy with a deviation for each parameter", SNESConfig)
class SNES(Gaussian):
    """ask() -> candidates to evaluate; tell(their fitness) -> the next mean and deviations."""

    evolves = ("generation", "mean", "sigma")

    config: SNESConfig

    def __init__(self, config: SNESConfig, initial: Initial, seed: int) -> None:
        super().__init__(config, initial, seed)
        n = self.size
        self.sigma = np.full(n, config.sigma)
        self.etasigma = config.etasigma or (3 + log([n])[0]) / (5 * math.sqrt(n))
        self.utilities = utilities(self.popsize)

    def ask(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the same as Gaussian.ask, and keep the drawn numbers."""
        numbers = generator(self.seed, self.generation)
        z, candidates = draw(numbers, self.mean[None], self.popsize, self.sigma, both=False)
        self.z = z[0]
        return candidates, self.evaluation_seeds()

    def tell(self, fitness: np.ndarray) -> None:
        """Adapt mean and deviations; fitness has shape (popsize,), in the order of ask()."""
        z = self.z[best_first(fitness)]
        gradient_mean = weighted(self.utilities, z)
        gradient_sigma = weighted(self.utilities, z * z - 1)
        self.mean = self.mean + self.config.etamu * self.sigma * gradient_mean
        self.sigma = within_limits(self.sigma * exp(self.etasigma / 2 * gradient_sigma))
        self.generation += 1
