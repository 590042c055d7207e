"""xNES, exponential natural evolution strategy: Glasmachers, Schaul, Sun, Wierstra and Schmidhuber
(2010), as in Wierstra, Schaul, Glasmachers, Sun, Peters and Schmidhuber (2014), algorithm 5. See
docs/specification.md, "xNES".

Candidates are x = mean + sigma B z, where z is standard normal and det B = 1. Mean, sigma and B
follow the natural gradient of the expected utility. B is multiplied by a matrix exponential, so it
stays invertible.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from botschool.evolution.algorithm import Initial, algorithm
from botschool.evolution.algorithms.gaussian import (
    Gaussian,
    GaussianConfig,
    best_first,
    refuse_large,
    utilities,
    within_limits,
)
from botschool.linear import exp, log, product, weighted
from botschool.policies.hyperparameters import hyper

TERMS = 18
"""Terms in the series of an exponential whose argument is at most 1; the next is below rounding."""


@dataclass
class XNESConfig(GaussianConfig):
    """Section [ALGO] of xNES."""

    etamu: float = hyper(1.0, "learning rate of the mean", above=0, high=10)
    etasigma: float = hyper(
        0.0, "learning rate of the candidates' shape, 0 for the paper's", low=0, high=10
    )


def exponential(z: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return M such that exp(Z' W Z) = 1 + Z' M Z, where W has the weights on its diagonal.

    z: (popsize, parameters); M: (popsize, popsize). Exponentiating a matrix of the parameters would
    take popsize times as long, or more. The series sum_k (Z' W Z)^k / k! has Z' at the left and Z
    at the right of every term but the first. It is summed for the matrix divided by 2^h, and exp(2
    A) = exp(A)^2 then gives M <- 2 M + M (Z Z') M.
    """
    gram = product(z, z.T)
    inner = gram * weights
    largest = float(np.abs(inner).sum(axis=1).max())  # no eigenvalue is larger
    halvings = max(0, math.frexp(largest)[1])
    inner = inner * math.ldexp(1, -halvings)
    term = np.eye(len(z))
    total = term.copy()
    for k in range(2, TERMS + 1):
        term = product(term, inner) / k
        total += term
    m = math.ldexp(1, -halvings) * weights[:, None] * total
    for _ in range(halvings):
        m = 2 * m + product(product(m, gram), m)
    return m


@algorithm("xNES", "natural evolution strategy with a full matrix of shape", XNESConfig)
class XNES(Gaussian):
    """ask() -> candidates to evaluate; tell(their fitness) -> the next mean, sigma and B."""

    evolves = ("generation", "mean", "sigma", "shape")

    config: XNESConfig

    def __init__(self, config: XNESConfig, initial: Initial, seed: int) -> None:
        super().__init__(config, initial, seed)
        n = self.size
        refuse_large(n, "xNES", "set algo = sNES, which adapts a deviation for each parameter")
        self.shape = np.eye(n)
        self.etasigma = config.etasigma or 3 * (3 + log([n])[0]) / (5 * n * math.sqrt(n))
        self.utilities = utilities(self.popsize)

    def shaped(self, z: np.ndarray) -> np.ndarray:
        """Return B z for every row of z."""
        return product(z, self.shape.T)

    def tell(self, fitness: np.ndarray) -> None:
        """Adapt mean, sigma and B; fitness has shape (popsize,), in the order of ask()."""
        order, u, eta = best_first(fitness), self.utilities, self.etasigma
        z, y = self.z[order], self.y[order]

        # B times the gradient of the mean, sum_k u_k z_k
        self.mean = self.mean + self.config.etamu * self.sigma * weighted(u, y)

        # the gradient of the shape, G = sum_k u_k (z_k z_k' - 1), is the sum of its trace part,
        # which moves sigma, and a rest without trace, which moves B
        trace = math.fsum(u * (np.add.reduce(z * z, axis=1) - self.size)) / self.size
        self.sigma = float(within_limits(self.sigma * exp([eta / 2 * trace])[0]))
        m = exponential(z, eta / 2 * u)
        factor = exp([-eta / 2 * (trace + math.fsum(u))])[0]
        self.shape = factor * (self.shape + product(y.T, product(m, z)))
        self.generation += 1
