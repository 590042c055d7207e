"""Read a run from its files."""

from __future__ import annotations

import io
from dataclasses import dataclass, field
from pathlib import Path
from tokenize import TokenError
from typing import Any

import numpy as np

from botschool.evolution.record import STAT
from botschool.labs.declare import Condition
from botschool.sandbox.inside import read_inside

MAX_BYTES = 50_000_000


@dataclass(frozen=True)
class SavedRun:
    """A run as its files describe it."""

    condition: Condition
    seed: int
    stat: np.ndarray
    """(generations, 6); STAT names the columns, for a training labs/training.py does."""
    genotype: np.ndarray
    populations: dict[int, np.ndarray] = field(default_factory=dict)
    """Co-evolution only: generation -> (2 n, parameters), predators first, then prey."""

    @property
    def key(self) -> tuple[str, int]:
        """Return the condition's name and the seed; they identify a run of a sheet."""
        return self.condition.name, self.seed

    def plain(self) -> dict[str, Any]:
        """Return the run in the form that measure.py gets."""
        told = {
            "condition": self.condition.name,
            "seed": self.seed,
            "stat": self.stat,
            "genotype": self.genotype,
            "experiment": self.condition.told(),
        }
        return told | ({"populations": self.populations} if self.populations else {})

    def same(self, other: SavedRun) -> bool:
        """Return whether two runs are equal, bit by bit."""
        return (
            self.stat.tobytes() == other.stat.tobytes()
            and self.genotype.tobytes() == other.genotype.tobytes()
            and self.populations.keys() == other.populations.keys()
            and all(
                self.populations[g].tobytes() == each.tobytes()
                for g, each in other.populations.items()
            )
        )


def plain_runs(runs: list[SavedRun], others: bool) -> list[dict[str, Any]]:
    """Return runs in the form that measure.py gets; others: add the genotypes of all other runs."""
    told = [run.plain() for run in runs]
    if others:
        for number, each in enumerate(told):
            each["others"] = [run.genotype for i, run in enumerate(runs) if i != number]
    return told


def numbers(path: Path, dimensions: int) -> np.ndarray | None:
    """Return the finite float64 numbers of a regular file; None if it does not hold any."""
    try:
        content = read_inside(path.parent, path.name, MAX_BYTES)
        if len(content) > MAX_BYTES:
            return None
        array = np.asarray(np.load(io.BytesIO(content), allow_pickle=False))
    except (OSError, ValueError, EOFError, MemoryError, TokenError):
        return None
    good = array.dtype == np.float64 and array.ndim == dimensions and array.size
    return array if good and np.isfinite(array).all() else None


def stat_of(path: Path) -> np.ndarray | None:
    """Return the rows of a stat file; None if it is missing or damaged."""
    flat = numbers(path, 1)
    return None if flat is None or flat.size % len(STAT) else flat.reshape(-1, len(STAT))
