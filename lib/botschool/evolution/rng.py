"""The random numbers of evolution: a pure function of (seed, generation)."""

from __future__ import annotations

from numpy.random import Generator, Philox


def generator(seed: int, generation: int) -> Generator:
    """Numbers of one generation: Philox4x64-10 (Salmon et al. 2011) keyed by both."""
    return Generator(Philox(key=[seed, generation]))
