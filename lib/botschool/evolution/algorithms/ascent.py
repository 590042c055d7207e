"""Several centres that climb side by side, each by steps of OpenAI-ES without bias correction.

Where they are follows from where they began and the fitness they were told: a cluster's workers
follow them by that alone (docs/specification.md, "On a cluster").
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.random import Generator, Philox

from botschool.evolution.algorithms.drawing import Cloud, Drawn, draw
from botschool.evolution.algorithms.openaies import climb


@dataclass(frozen=True, eq=False)
class Start:
    """Where an ascent begins, and its hyperparameters."""

    centres: np.ndarray
    """float64 (count, parameters), as are m and v."""
    m: np.ndarray
    v: np.ndarray
    stream: Mapping[str, Any]
    """State of the Philox generator that gives the directions."""
    samplesize: int
    deviation: float
    stepsize: float
    wdecay: int


class Ascent:
    """offspring() -> candidates around the centres; climb(their fitness) -> a step of each."""

    def __init__(self, start: Start) -> None:
        self.start = start
        self.centres, self.m, self.v = start.centres, start.m, start.v
        self.told: tuple[np.ndarray, ...] = ()
        """The fitness of each step so far."""
        self._numbers = Generator(Philox(0))
        self._numbers.bit_generator.state = start.stream

    def cloud(self) -> Cloud:
        """Return what the next offspring are drawn from."""
        start, stream = self.start, self._numbers.bit_generator.state
        return Cloud(self.centres, start.samplesize, start.deviation, True, stream)

    def offspring(self) -> Drawn:
        """Return candidates on both sides of each centre, float64 (count * 2 * samplesize,
        parameters).
        """
        start = self.start
        self._samples, candidates = draw(
            self._numbers, self.centres, start.samplesize, start.deviation
        )
        candidates.recipe = (self.start, *self.told)
        return candidates

    def climb(self, fitness: np.ndarray) -> None:
        """A step of each centre; fitness: of the offspring, (count, 2 * samplesize)."""
        self.centres, self.m, self.v = climb(
            self.centres, self.m, self.v, self._samples, fitness, self.start
        )
        self.told = (*self.told, fitness)
