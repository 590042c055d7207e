"""Move several centres in parallel, each by steps of OpenAI-ES without bias correction.

Their positions follow from the start and the fitness values that they were told. A cluster's
workers compute the positions from these alone (docs/specification.md, "On a cluster").
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from botschool.evolution.algorithms.drawing import Cloud, Drawn, draw
from botschool.evolution.algorithms.openaies import climb
from botschool.seeds import Place, generator


@dataclass(frozen=True, eq=False)
class Start:
    """Start of an ascent, and its hyperparameters."""

    centres: np.ndarray
    """float64 (count, parameters); m and v have the same shape."""
    m: np.ndarray
    v: np.ndarray
    stream: Place
    """Where in a stream the directions begin."""
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
        self._numbers = generator(0, 0)
        self._numbers.place = start.stream

    def cloud(self) -> Cloud:
        """Return the cloud from which the next offspring are drawn."""
        start, stream = self.start, self._numbers.place
        return Cloud(self.centres, start.samplesize, start.deviation, True, stream)

    def offspring(self) -> Drawn:
        """Return candidates around each centre, float64 (count * 2 * samplesize, parameters)."""
        start = self.start
        self._samples, candidates = draw(
            self._numbers, self.centres, start.samplesize, start.deviation
        )
        candidates.recipe = (self.start, *self.told)
        return candidates

    def climb(self, fitness: np.ndarray) -> None:
        """Make one step of each centre; fitness: of the offspring, (count, 2 * samplesize)."""
        self.centres, self.m, self.v = climb(
            self.centres, self.m, self.v, self._samples, fitness, self.start
        )
        self.told = (*self.told, fitness)
