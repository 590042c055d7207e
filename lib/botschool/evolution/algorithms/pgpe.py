"""PGPE, parameter-exploring policy gradients: Sehnke, Osendorfer, Rueckstiess, Graves, Peters and
Schmidhuber (2010), https://doi.org/10.1016/j.neunet.2009.12.004, with symmetric samples. See
docs/specification.md, "PGPE".

A policy's parameters are drawn from a Gaussian distribution with a mean and a standard deviation
for each. Both climb the gradient of the expected fitness: the mean by the difference between two
candidates on both sides of it, the deviations by how good the two are on average.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from botschool.evolution.algorithm import Initial, RunConfig, Stateful, algorithm, mean_absolute
from botschool.evolution.algorithms.drawing import draw
from botschool.evolution.algorithms.gaussian import within_limits
from botschool.linear import weighted
from botschool.policies.hyperparameters import hyper
from botschool.seeds import generator

MOST = 0.2
"""Largest relative change of a deviation in a generation."""


@dataclass
class PGPEConfig(RunConfig):
    """Section [ALGO] of PGPE."""

    samplesize: int = hyper(
        20, "perturbations per generation, two candidates each", low=1, high=1000000
    )
    sigma: float = hyper(0.3, "standard deviation of the first candidates", above=0, high=1000)
    etamu: float = hyper(4.0, "learning rate of the mean", above=0, high=1000)
    etasigma: float = hyper(0.1, "learning rate of the deviations", low=0, high=1000)


@algorithm("PGPE", "policy gradient with parameter-based exploration", PGPEConfig)
class PGPE(Stateful):
    """ask() -> candidates to evaluate; tell(their fitness) -> the next mean and deviations."""

    evolves = ("generation", "mean", "sigma")

    def __init__(self, config: PGPEConfig, initial: Initial, seed: int) -> None:
        """Start the mean at initial(0), a random genotype."""
        self.config = config
        self.seed = seed
        self.generation = 0
        self.mean = initial(0)
        self.sigma = np.full(len(self.mean), config.sigma)

    def ask(self) -> tuple[np.ndarray, np.ndarray]:
        """Return candidates, shape (2 * samplesize, parameters), and each one's evaluation seed.

        Candidates 2 b and 2 b + 1 are mean + sigma z_b and mean - sigma z_b. All of a generation
        meet the same conditions.
        """
        numbers, count = generator(self.seed, self.generation), self.config.samplesize
        z, candidates = draw(numbers, self.mean[None], count, self.sigma)
        self.z = z[0]
        return candidates, np.full(2 * count, self.seed + self.generation, dtype=np.uint64)

    def tell(self, fitness: np.ndarray) -> None:
        """Move mean and deviations; fitness has shape (2 * samplesize,), in the order of ask()."""
        # rewards: ranks from -1 (worst) to 1 (best), so that the scale of fitness does not count
        rewards = np.empty(len(fitness))
        rewards[fitness.argsort(kind="stable")] = np.linspace(-1, 1, len(fitness))
        plus, minus = rewards[0::2], rewards[1::2]

        # the paper's T r_T and S r_S, whose baseline is 0 with these rewards, in units of sigma
        count = len(plus)
        towards = weighted((plus - minus) / (2 * count), self.z)
        wider = weighted((plus + minus) / (2 * count), self.z * self.z - 1)
        change = np.clip(self.config.etasigma * wider, -MOST, MOST)
        self.mean = self.mean + self.config.etamu * self.sigma * towards
        self.sigma = np.asarray(within_limits(self.sigma * (1 + change)))
        self.generation += 1

    def average_parameter(self) -> float:
        """Return the average absolute parameter of the mean."""
        return mean_absolute(self.mean)
