"""A run as its files tell it."""

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
    """A run as its files tell it."""

    condition: Condition
    seed: int
    stat: np.ndarray
    """(generations, 6), as STAT names the columns; of a training see labs/training.py."""
    genotype: np.ndarray
    populations: dict[int, np.ndarray] = field(default_factory=dict)
    """Co-evolution: generation -> (2 n, parameters), the predators, then the prey."""

    @property
    def key(self) -> tuple[str, int]:
        """The condition's name and the seed, which no other run of a sheet has."""
        return self.condition.name, self.seed

    def plain(self) -> dict[str, Any]:
        """What measure.py is given."""
        told = {
            "condition": self.condition.name,
            "seed": self.seed,
            "stat": self.stat,
            "genotype": self.genotype,
            "experiment": self.condition.told(),
        }
        return told | ({"populations": self.populations} if self.populations else {})

    def same(self, other: SavedRun) -> bool:
        """Whether two runs are equal, bit by bit."""
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
    """What measure.py is given of several runs; others: with the genotypes of all others."""
    told = [run.plain() for run in runs]
    if others:
        for number, each in enumerate(told):
            each["others"] = [run.genotype for i, run in enumerate(runs) if i != number]
    return told


def numbers(path: Path, dimensions: int) -> np.ndarray | None:
    """The finite float64 numbers of a regular file, None if there are none."""
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
    """The rows of a stat file; None if it is not there or is damaged."""
    flat = numbers(path, 1)
    return None if flat is None or flat.size % len(STAT) else flat.reshape(-1, len(STAT))
