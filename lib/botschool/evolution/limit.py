"""Decide when a run ends."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

from botschool.evolution.record import Record


class Advancing(Protocol):
    """The attributes of a run that a limit reads."""

    record: Record
    progress: float
    """Share of the present generation that is done, from 0 to 1."""


@dataclass(frozen=True)
class Limit:
    """The end of a run: a number of steps or of generations, whichever comes first."""

    steps: float = math.inf
    generations: float = math.inf

    def and_also(self, steps: int | None, generations: int | None) -> Limit:
        """Return a limit that is no later; None adds no limit."""
        return Limit(
            min(self.steps, math.inf if steps is None else steps),
            min(self.generations, math.inf if generations is None else generations),
        )

    def reached(self, run: Advancing) -> bool:
        """Return whether the run is at its end."""
        record = run.record
        return record.steps >= self.steps or record.generation >= self.generations

    def share(self, run: Advancing) -> float:
        """Return how much is done, from 0 to 1."""
        generations = run.record.generation + run.progress
        return min(1.0, max(run.record.steps / self.steps, generations / self.generations))
