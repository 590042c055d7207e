"""ARS, augmented random search: Mania, Guy and Recht (2018), "Simple random search of static linear
policies is competitive for reinforcement learning". See docs/specification.md, "Algorithms".

Like OpenAI-ES, it measures candidates on both sides of a centre. But only the directions with the
best candidates count, and their weights are fitness values instead of ranks. The centre moves by
their mean divided by the spread of fitness, so steps get smaller where fitness varies more.
"""

# Hyperparameters keep the names they have in .ini files.
# ruff: noqa: N815

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from botschool.evolution.algorithm import RunConfig, algorithm
from botschool.evolution.algorithms.openaies import SAME_SEED, AroundCentre
from botschool.policies.hyperparameters import hyper


@dataclass
class ARSConfig(RunConfig):
    """Section [ALGO] of ARS."""

    stepsize: float = hyper(0.02, "step size", above=0, high=1000)
    samplesize: int = hyper(
        16, "directions per generation, two candidates each", low=1, high=1000000
    )
    ntop: int = hyper(0, "number of best directions that count (0 = all)", low=0, high=1000000)
    noiseStdDev: float = hyper(0.05, "standard deviation of perturbations", above=0, high=1000)
    symseed: int = hyper(1, "which candidates meet the same seed", choices=SAME_SEED)


def shift(fitness: np.ndarray, samples: np.ndarray, ntop: int) -> np.ndarray:
    """Return how far the centre moves at a step size of 1, shape (parameters,).

    samples: directions, shape (samplesize, parameters); fitness: of the two candidates of each
    direction, centre + s e and centre - s e, shape (2 * samplesize,).
    """
    pairs = fitness.reshape(-1, 2)
    # the directions with the best candidates; the first wins ties
    best = np.argsort(-pairs.max(axis=1), kind="stable")[:ntop]
    counted = pairs[best].ravel().tolist()
    mean = math.fsum(counted) / len(counted)
    spread = math.sqrt(math.fsum(d * d for d in [one - mean for one in counted]) / len(counted))
    if not spread > 0:  # all are equal: there is no direction
        return np.zeros(samples.shape[1])
    weights = (pairs[best, 0] - pairs[best, 1]) / (len(best) * spread)
    # sum row by row, so that no BLAS can change the last bits
    return np.add.reduce(weights[:, None] * samples[best], axis=0)


@algorithm("ARS", "augmented random search", ARSConfig)
class ARS(AroundCentre):
    """ask() -> candidates to evaluate; tell(their fitness) -> one step of the centre."""

    @staticmethod
    def conflicts(config: ARSConfig) -> Iterator[tuple[tuple[str, ...], str]]:
        """Yield hyperparameters that cannot go together."""
        if config.ntop > config.samplesize:
            yield (
                ("ntop", "samplesize"),
                f"ntop = {config.ntop} is above samplesize = {config.samplesize}: "
                f"set ntop = {config.samplesize}, or 0 for all directions",
            )

    def tell(self, fitness: np.ndarray) -> None:
        """Move the centre; fitness has shape (2 * samplesize,), in the order of ask()."""
        config = self.config
        rising = shift(fitness, self.samples, config.ntop or config.samplesize)
        self.centre = self.centre + config.stepsize * rising
        self.generation += 1
