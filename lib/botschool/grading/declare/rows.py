"""Find individuals of a population, the rows of an array, in another one."""

from __future__ import annotations

import numpy as np


def same_rows(some: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Return whether row i of some is row j of others in single precision, (some, others)."""
    found = np.ones((len(some), len(others)), dtype=bool)
    for a, b in ((some[:, :9], others[:, :9]), (some, others)):  # few pairs have nine in common
        i, j = np.nonzero(found)
        found[i, j] = np.all(np.abs(a[i] - b[j]) <= 1e-6 * (1 + np.abs(b[j])), axis=1)
    return found


def in_common(some: np.ndarray, others: np.ndarray) -> int:
    """Return how many rows of some are rows of others, too."""
    return int(same_rows(some, others).any(axis=1).sum())


def noise_of(after: np.ndarray, better: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the rows that are not of the better half, minus their nearest parents, and these."""
    new = after[~same_rows(after, better).any(axis=1)]
    apart = new[:, None] - better[None]
    parents = np.abs(apart).mean(axis=2).argmin(axis=1)
    return apart[np.arange(len(new)), parents], parents
