"""Read a run from its files, and arrays from bytes that nobody has to trust."""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Callable
from dataclasses import dataclass, field
from math import prod
from pathlib import Path
from typing import Any

import numpy as np

from botschool.evolution.record import STAT
from botschool.labs.declare import Condition
from botschool.sandbox.inside import read_inside

MAX_BYTES = 50_000_000
MAX_MEMBERS = 1000
"""Arrays in a file."""
_MAGIC = b"\x93NUMPY\x01\x00"
_HEADER = re.compile(
    rb"\{'descr': '(<f8|<U[1-9]\d{0,6})', 'fortran_order': (False|True), "
    rb"'shape': \(([\d, ]{0,60})\), \} *\n"
)
"""The header that numpy.save writes for numbers and texts."""


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


def numbers(
    path: Path, dimensions: int, of: Callable[[bytes], np.ndarray] | None = None
) -> np.ndarray | None:
    """Return the finite float64 numbers of a regular file; None if it does not hold any.

    of: reads them from the file's content; `array_of` by default.
    """
    try:
        content = read_inside(path.parent, path.name, MAX_BYTES)
        array = (of or array_of)(content) if len(content) <= MAX_BYTES else np.zeros(0)
    except (OSError, ValueError, KeyError):
        return None
    good = array.dtype == np.float64 and array.ndim == dimensions and array.size
    return array if good and np.isfinite(array).all() else None


def array_of(content: bytes) -> np.ndarray:
    """Return the array of an .npy file of float64 numbers or texts. Raises ValueError.

    numpy.load evaluates the header and allocates the shape that it states; this function does not.
    """
    start = 10 + int.from_bytes(content[8:10], "little")
    found = _HEADER.fullmatch(content[10:start]) if content.startswith(_MAGIC) else None
    if not found:
        raise ValueError("no header of numpy.save")
    dtype, shape = (
        np.dtype(found[1].decode()),
        tuple(map(int, found[3].replace(b",", b" ").split())),
    )
    if dtype.itemsize * prod(shape) != len(content) - start:
        raise ValueError("another size than its header states")
    order: Any = "F" if found[2] == b"True" else "C"
    return np.ndarray(shape, dtype, content, start, order=order).copy()


def member(content: bytes, name: str, most: int) -> np.ndarray:
    """Return an array of an .npz file, of at most `most` bytes. Raises ValueError, or KeyError."""
    if content.count(b"PK\x01\x02") > MAX_MEMBERS:  # a million entries would take a gigabyte
        raise ValueError("too many arrays")
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            about = archive.getinfo(f"{name}.npy")
            if about.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
                raise ValueError("another compression than numpy's")
            with archive.open(about) as stream:
                inner = stream.read(most + 1)  # never read(): it unpacks all before it cuts
    except KeyError:
        raise KeyError(name) from None
    except Exception as error:  # a damaged file can fail in any way
        raise ValueError(str(error)) from None
    if len(inner) > most:
        raise ValueError(f"unpacks to more than {most // 2**20} MB")
    return array_of(inner)


def stat_of(path: Path) -> np.ndarray | None:
    """Return the rows of a stat file; None if it is missing or damaged."""
    flat = numbers(path, 1)
    return None if flat is None or flat.size % len(STAT) else flat.reshape(-1, len(STAT))
