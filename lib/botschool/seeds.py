"""Random numbers of Python: every stream is a pure function of what it is keyed by."""

from __future__ import annotations

from numpy.random import Generator, Philox

POST_EVALUATION_SEED = 100_000
"""Post-evaluation of a run with seed S uses seed S + 100000 and episodes 0, 1, ..."""


def generator(seed: int, generation: int) -> Generator:
    """Numbers of one generation: Philox4x64-10 (Salmon et al. 2011) keyed by both."""
    return Generator(Philox(key=[seed, generation]))
