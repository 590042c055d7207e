"""CMA-ES, evolution strategy with covariance matrix adaptation: Hansen (2016), "The CMA evolution
strategy: a tutorial", arXiv 1604.00772; with `diagonal = 1` sep-CMA-ES of Ros and Hansen (2008).
See docs/specification.md, "CMA-ES".

Candidates are drawn from a Gaussian distribution. Its mean moves to the better ones. Its overall
size sigma grows while the mean keeps its direction. Its covariance matrix C learns the directions
of the better ones. The names and equation numbers are the tutorial's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from botschool.errors import SEED, BotschoolError
from botschool.evolution.algorithm import Initial, algorithm
from botschool.evolution.algorithms.gaussian import (
    Gaussian,
    GaussianConfig,
    best_first,
    refuse_large,
    within_limits,
)
from botschool.linear import eigen, exp, log, product, weighted
from botschool.policies.hyperparameters import NO_YES, hyper

CONDITION = 1e14
"""Largest ratio of two eigenvalues of C; smaller eigenvalues are raised to it."""


@dataclass
class CMAESConfig(GaussianConfig):
    """Section [ALGO] of CMA-ES."""

    diagonal: int = hyper(
        0, "a variance for each parameter, no covariances: for large networks", choices=NO_YES
    )
    active: int = hyper(1, "the worse candidates push the covariances away", choices=NO_YES)


@dataclass(frozen=True)
class Settings:
    """Constants of a run (table 1 of the tutorial)."""

    weights: np.ndarray
    """Weights of the candidates from the best to the worst; the positive ones add up to 1."""
    mueff: float
    csigma: float
    dsigma: float
    cc: float
    c1: float
    cmu: float
    length: float
    """Expected length of a vector of the standard normal distribution."""
    gap: int
    """Generations between decompositions of C."""

    @classmethod
    def of(cls, n: int, popsize: int, diagonal: bool, active: bool) -> Settings:
        """Return the constants for n parameters."""
        raw = log([(popsize + 1) / 2])[0] - log(np.arange(1, popsize + 1))  # (49)
        better, worse = np.maximum(raw, 0), np.maximum(-raw, 0)
        mueff, mueff_worse = effective(better), effective(worse)
        cc = (4 + mueff / n) / (n + 4 + 2 * mueff / n)  # (56)
        c1 = 2 / ((n + 1.3) * (n + 1.3) + mueff)  # (57)
        cmu = 2 * (0.25 + mueff + 1 / mueff - 2) / ((n + 2) * (n + 2) + mueff)  # (58)
        if diagonal:  # fewer numbers are learned, so learning is faster: Ros and Hansen, section 3
            c1, cmu = (n + 2) / 3 * c1, (n + 2) / 3 * cmu
        cmu = min(1 - c1, cmu)
        least = (
            1 + c1 / cmu,  # (50)
            1 + 2 * mueff_worse / (mueff + 2),  # (51)
            (1 - c1 - cmu) / (n * cmu),  # (52)
        )
        negative = min(least) if active else 0.0
        weights = better / total(better) - negative * worse / total(worse)  # (53)
        csigma = (mueff + 2) / (n + mueff + 5)  # (55)
        dsigma = 1 + 2 * max(0, math.sqrt((mueff - 1) / (n + 1)) - 1) + csigma
        length = math.sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n * n))
        gap = max(1, int(1 / (2 * n * (c1 + cmu))))
        return cls(weights, mueff, csigma, dsigma, cc, c1, cmu, length, gap)


def total(values: np.ndarray) -> float:
    """Return the sum of the values, exact but for its last rounding."""
    return math.fsum(values.tolist())


def effective(weights: np.ndarray) -> float:
    """Return how many equal weights would average as much: (sum w)^2 / sum w^2."""
    return total(weights) * total(weights) / total(weights * weights)


class FullMatrix:
    """A covariance matrix C and its symmetric root, C = root root; both (n, n)."""

    covariance: np.ndarray
    root: np.ndarray

    def __init__(self, n: int) -> None:
        self.covariance, self.root = np.eye(n), np.eye(n)

    def shaped(self, z: np.ndarray) -> np.ndarray:
        """Return root z for every row of z."""
        return product(z, self.root)

    def update(self, keep: float, weights: np.ndarray, vectors: np.ndarray) -> None:
        """Set C to keep C + sum_k weights_k v_k v_k'; vectors: rows v_k."""
        added = product((weights[:, None] * vectors).T, vectors)
        self.covariance = keep * self.covariance + added

    def decompose(self) -> None:
        """Take C into use: root = B D B', where C has eigenvectors B and eigenvalues D D."""
        try:
            values, rows = eigen(self.covariance)
        except ValueError:
            raise BotschoolError(
                "CMA-ES has broken down: its covariance matrix holds numbers that are not finite, "
                "so start anew with another seed",
                SEED,
                ".",
            ) from None
        deviations = np.sqrt(np.maximum(values, values[-1] / CONDITION))
        self.root = product(rows.T * deviations, rows)


class Diagonal(FullMatrix):
    """The same for a diagonal matrix: C and its root are diagonals of shape (n,)."""

    def __init__(self, n: int) -> None:
        self.covariance, self.root = np.ones(n), np.ones(n)

    def shaped(self, z: np.ndarray) -> np.ndarray:
        return z * self.root

    def update(self, keep: float, weights: np.ndarray, vectors: np.ndarray) -> None:
        self.covariance = keep * self.covariance + weighted(weights, vectors * vectors)

    def decompose(self) -> None:
        largest = self.covariance.max()
        self.root = np.sqrt(np.maximum(self.covariance, largest / CONDITION))


@algorithm("CMA-ES", "evolution strategy that adapts a covariance matrix", CMAESConfig)
class CMAES(Gaussian):
    """ask() -> candidates to evaluate; tell(their fitness) -> the next mean, sigma and C."""

    evolves = (
        "generation",
        "mean",
        "sigma",
        "path_sigma",
        "path_c",
        "matrix.covariance",
        "matrix.root",
    )

    def __init__(self, config: CMAESConfig, initial: Initial, seed: int) -> None:
        super().__init__(config, initial, seed)
        n = self.size
        if not config.diagonal:
            refuse_large(n, "CMA-ES", "set diagonal = 1, which adapts a variance for each")
        self.settings = Settings.of(n, self.popsize, bool(config.diagonal), bool(config.active))
        self.matrix = Diagonal(n) if config.diagonal else FullMatrix(n)
        self.path_sigma, self.path_c = np.zeros(n), np.zeros(n)

    def shaped(self, z: np.ndarray) -> np.ndarray:
        """Give z the shape of C at its last decomposition."""
        return self.matrix.shaped(z)

    def tell(self, fitness: np.ndarray) -> None:
        """Adapt mean, sigma and C; fitness has shape (popsize,), in the order of ask()."""
        s, n = self.settings, self.size
        order = best_first(fitness)
        z, y = self.z[order], self.y[order]
        recombination = np.maximum(s.weights, 0)

        # the mean moves to the weighted mean of the better half (41, 42)
        step = weighted(recombination, y)
        self.mean = self.mean + self.sigma * step

        # sigma: the path sums the mean's steps as they would be if C were 1; root^-1 y = z (43, 44)
        self.path_sigma = (1 - s.csigma) * self.path_sigma + math.sqrt(
            s.csigma * (2 - s.csigma) * s.mueff
        ) * weighted(recombination, z)
        length = math.sqrt(np.add.reduce(self.path_sigma * self.path_sigma))
        change = exp([s.csigma / s.dsigma * (length / s.length - 1)])[0]
        self.sigma = float(within_limits(self.sigma * change))

        # C: the mean's path, unless sigma is far too small, and this generation's steps (45 to 47)
        begun = 1 - exp([2 * (self.generation + 1) * log([1 - s.csigma])[0]])[0]
        moving = length / math.sqrt(begun) < (1.4 + 2 / (n + 1)) * s.length
        self.path_c = (1 - s.cc) * self.path_c
        if moving:
            self.path_c = self.path_c + math.sqrt(s.cc * (2 - s.cc) * s.mueff) * step
        lost = 0.0 if moving else s.cc * (2 - s.cc)
        lengths = np.maximum(np.add.reduce(z * z, axis=1), 1e-300)
        weights = np.where(s.weights < 0, s.weights * n / lengths, s.weights)
        self.matrix.update(
            1 + s.c1 * lost - s.c1 - s.cmu * total(s.weights),
            np.concatenate([[s.c1], s.cmu * weights]),
            np.concatenate([self.path_c[None], y]),
        )
        self.generation += 1
        if self.generation % s.gap == 0:
            self.matrix.decompose()
