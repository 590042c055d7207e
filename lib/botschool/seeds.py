"""Random numbers of Python: every stream is a pure function of what it is keyed by."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.random import Generator, Philox
from numpy.random.bit_generator import ISeedSequence

POST_EVALUATION_SEED = 100_000
"""Post-evaluation of a run with seed S uses seed S + 100000 and episodes 0, 1, ..."""


class _Key(ISeedSequence):
    """A key as it is. `Philox(key=...)` gives the same numbers, but asks the system for entropy
    first, which takes most of its time."""

    def __init__(self, *words: int) -> None:
        self._words = words

    def generate_state(self, n_words: int, dtype: Any = np.uint64) -> np.ndarray:
        return np.array(self._words, dtype=dtype)


def generator(seed: int, generation: int) -> Generator:
    """Return numbers of one generation: Philox4x64-10 (Salmon et al. 2011) keyed by both."""
    key: Any = _Key(seed, generation)
    return Generator(Philox(key))
