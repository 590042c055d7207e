"""Draw Python's random numbers: every stream is a pure function of its key."""

from __future__ import annotations

import random
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from threading import Lock
from typing import Any

import numpy as np
from numpy.random import Generator

from botschool import _core

POST_EVALUATION_SEED = 100_000
"""Post-evaluation of a run with seed S uses seed S + 100000 and episodes 0, 1, ..."""
NEW_EPISODES_SEED = 200_000
"""Added to a run's seed: episodes that no training and no choice of a best robot has used."""


Place = tuple[int, int, int, int]
"""Position in a stream: seed, generation, words drawn, and the half word left over, or -1."""


class _Source(_core.Numbers):
    """The source of random words that numpy's Generator asks for; `state` is its Place."""

    def __init__(self, seed: int, generation: int) -> None:
        super().__init__((seed, generation, 0, -1))
        self.lock = Lock()


class Numbers(Generator):
    """numpy's Generator(Philox(key=[seed, generation])), with the same bits on every system.

    C++ draws normal numbers, whole numbers from 0 and permutations, as in a page
    (lib/evolution/normals.hpp), because numpy takes logarithms from the system's C library. All
    other methods are numpy's own.
    """

    def standard_normal(  # type: ignore[override]
        self, size: Any = None, dtype: Any = np.float64, out: np.ndarray | None = None
    ) -> Any:
        """Return normal numbers, as numpy does."""
        found = np.empty(() if size is None else size) if out is None else out
        usual = np.dtype(dtype) == found.dtype == np.float64 and found.flags.c_contiguous
        if not usual or (out is not None and size is not None):  # numpy checks, or draws floats
            return super().standard_normal(size, dtype, out)
        self._source.normals(found.reshape(-1))
        return found if found.ndim or out is not None else float(found)

    def integers(self, low: Any, high: Any = None, size: Any = None, **options: Any) -> Any:  # type: ignore[override]
        """Return whole numbers, as numpy does."""
        if high is not None or options or np.asarray(low).dtype.kind not in "iu":
            return super().integers(low, high, size, **options)
        shape = np.shape(low) if size is None else size
        found = np.array(np.broadcast_to(low, shape), dtype=np.int64, order="C")
        self._source.below(found.reshape(-1))
        return found if found.ndim else found[()]

    def permutation(self, x: Any, axis: int = 0) -> Any:
        """Return the numbers from 0 to x - 1, or the rows of x, in random order, as numpy does."""
        if isinstance(x, (int, np.integer)) and 0 <= x < 2**32:
            return self._source.permutation(int(x))
        return super().permutation(x, axis)

    @property
    def place(self) -> Place:
        """Return the position of the next number in the stream."""
        return self._source.state

    @place.setter
    def place(self, place: Place) -> None:
        self._source.state = place

    @property
    def _source(self) -> Any:
        return self.bit_generator


def seed_libraries(seed: int, episode: int = 0) -> int:
    """Seed what environments draw from besides their own generator: `random`, `numpy.random`, and
    torch if it is loaded. Return the number that they, and `reset`, get for this episode.
    """
    number = (seed + episode) % 2**32
    random.seed(number)
    np.random.seed(number)  # noqa: NPY002
    if torch := sys.modules.get("torch"):
        torch.manual_seed(number)
    return number


@contextmanager
def libraries_kept() -> Iterator[None]:
    """Give these generators their present state back at the end: others may draw from them, too."""
    torch = sys.modules.get("torch")
    states = random.getstate(), np.random.get_state(), torch and torch.get_rng_state()  # noqa: NPY002
    try:
        yield
    finally:
        random.setstate(states[0])
        np.random.set_state(states[1])  # noqa: NPY002
        if torch:
            torch.set_rng_state(states[2])


def generator(seed: int, generation: int) -> Numbers:
    """Return the random numbers of a generation: Philox4x64-10 (Salmon et al. 2011)."""
    source: Any = _Source(int(seed), int(generation))
    return Numbers(source)
