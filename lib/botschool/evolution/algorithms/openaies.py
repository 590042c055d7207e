"""OpenAI-ES: Salimans, Ho, Chen, Sidor and Sutskever (2017), "Evolution strategies as a scalable
alternative to reinforcement learning". See docs/specification.md, "Algorithms".

The population is a cloud around one centre. Each generation measures candidates on both sides of
the centre along random directions, estimates from their ranks the direction in which fitness rises,
and moves the centre a step that way with Adam (Kingma and Ba 2015).
"""

# Hyperparameters keep the names they have in .ini files.
# ruff: noqa: N815

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from botschool.evolution.algorithm import Initial, RunConfig, Stateful, algorithm, mean_absolute
from botschool.evolution.algorithms.drawing import draw
from botschool.linear import power
from botschool.policies.hyperparameters import WEIGHT_DECAY, hyper
from botschool.seeds import generator

BETA1, BETA2, EPSILON = 0.9, 0.999, 1e-8
DECAY = 0.005
SAME_SEED = {0: "none", 1: "both of a perturbation", 2: "all of a generation"}
"""Values of symseed."""


@cache
def ranks(count: int) -> np.ndarray:
    """Return the utilities of `count` candidates, the worst first. Do not change the array."""
    return np.linspace(-0.5, 0.5, count)


def gradient(fitness: np.ndarray, samples: np.ndarray) -> np.ndarray:
    """Return the direction in which fitness rises, estimated from ranks; shape (parameters,).

    samples: directions, shape (samplesize, parameters); fitness: of the two candidates of each
    direction, centre + s e and centre - s e, shape (2 * samplesize,).
    """
    # rank the candidates: utilities from -0.5 (worst) to 0.5 (best)
    utilities = np.empty(len(fitness))
    utilities[fitness.argsort(kind="stable")] = ranks(len(fitness))

    # weight each direction by how much its + candidate is better than its - candidate
    weights = utilities[0::2] - utilities[1::2]
    # sum row by row, so that no BLAS can change the last bits
    return np.add.reduce(weights[:, None] * samples, axis=0) / len(fitness)


def adam(
    m: np.ndarray, v: np.ndarray, gradient: np.ndarray, centre: np.ndarray, wdecay: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return Adam's next first and second moments, m and v, before any bias correction."""
    # Adam descends, so climbing takes the negative gradient
    descent = -gradient
    if wdecay == 1:
        descent += DECAY * centre
    elif wdecay == 2:
        descent += DECAY * np.sign(centre)
    return BETA1 * m + (1 - BETA1) * descent, BETA2 * v + (1 - BETA2) * (descent * descent)


def climb(
    centres: np.ndarray,
    m: np.ndarray,
    v: np.ndarray,
    samples: np.ndarray,
    fitness: np.ndarray,
    config: Any,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return one step of several centres, without bias correction: their next parameters, m and v.

    Shapes: centres, m and v (count, parameters); samples (count, samplesize, parameters); fitness
    (count, 2 * samplesize), in the order of drawing.mirrored(). config has stepsize and wdecay.
    This is the step of the algorithms with predators and prey.
    """
    rising = np.array([gradient(*pair) for pair in zip(fitness, samples, strict=True)])
    m, v = adam(m, v, rising, centres, config.wdecay)
    return centres - config.stepsize * m / (np.sqrt(v) + EPSILON), m, v


@dataclass
class OpenAIESConfig(RunConfig):
    """Section [ALGO] of OpenAI-ES."""

    stepsize: float = hyper(0.01, "step size of Adam", above=0, high=1000)
    samplesize: int = hyper(
        20, "perturbations per generation, two candidates each", low=1, high=1000000
    )
    noiseStdDev: float = hyper(0.02, "standard deviation of perturbations", above=0, high=1000)
    wdecay: int = hyper(0, "pull of the centre towards 0", choices=WEIGHT_DECAY)
    symseed: int = hyper(1, "which candidates meet the same seed", choices=SAME_SEED)


class AroundCentre(Stateful):
    """Candidates on both sides of a centre; a subclass moves the centre when it is told fitness."""

    evolves: tuple[str, ...] = ("generation", "centre")

    def __init__(self, config: Any, initial: Initial, seed: int) -> None:
        """Start the centre at initial(0), a random genotype."""
        self.config = config
        self.seed = seed
        self.generation = 0
        count = 2 * config.samplesize
        numbers = np.arange(count, dtype=np.uint64)
        self._own_seeds = numbers // np.uint64((1, 2, count)[config.symseed])
        self._seeds_used = (count, config.samplesize, 1)[config.symseed]
        self.centre = initial(0)

    def ask(self) -> tuple[np.ndarray, np.ndarray]:
        """Return candidates, shape (2 * samplesize, parameters), and each one's evaluation seed.

        Candidates 2 b and 2 b + 1 are centre + noiseStdDev * e_b and centre - noiseStdDev * e_b.
        """
        numbers, config = generator(self.seed, self.generation), self.config
        samples, candidates = draw(
            numbers, self.centre[None], config.samplesize, config.noiseStdDev
        )
        self.samples = samples[0]
        return candidates, self.seed + self.generation * self._seeds_used + self._own_seeds

    def average_parameter(self) -> float:
        """Return the average absolute parameter of the centre."""
        return mean_absolute(self.centre)


@algorithm("OpenAI-ES", "evolution strategy that follows an estimated gradient", OpenAIESConfig)
class OpenAIES(AroundCentre):
    """ask() -> candidates to evaluate; tell(their fitness) -> one step of the centre."""

    evolves = (*AroundCentre.evolves, "m", "v")

    def __init__(self, config: OpenAIESConfig, initial: Initial, seed: int) -> None:
        """Start without momentum."""
        super().__init__(config, initial, seed)
        self.m = np.zeros_like(self.centre)
        self.v = np.zeros_like(self.centre)

    def tell(self, fitness: np.ndarray) -> None:
        """Move the centre; fitness has shape (2 * samplesize,), in the order of ask()."""
        config = self.config
        rising = gradient(fitness, self.samples)
        m, v = adam(self.m, self.v, rising, self.centre, config.wdecay)
        t = self.generation + 1
        step = config.stepsize * math.sqrt(1 - power(BETA2, t)) / (1 - power(BETA1, t))
        self.centre = self.centre - step * m / (np.sqrt(v) + EPSILON)
        self.m, self.v, self.generation = m, v, t
