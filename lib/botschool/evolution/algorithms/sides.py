"""Define the common part of all algorithms with two sides, predators and prey."""

from __future__ import annotations

import math

import numpy as np

from botschool.evolution.algorithm import Play

PREDATORS, PREY = 0, 1
SIDES = ("predators", "prey")


def seen_by(side: int, fitness: np.ndarray) -> np.ndarray:
    """Return the fitness of one side's individuals (rows) against their competitors (columns).

    fitness: of predators (rows) against prey (columns), where the prey's fitness is 1 minus it; or
    the fitness of both sides, with a first axis of two.
    """
    if fitness.ndim == 3:
        return fitness[PREDATORS] if side == PREDATORS else fitness[PREY].T
    return fitness if side == PREDATORS else 1 - fitness.T


def unknown(count: int, constant_sum: bool) -> np.ndarray:
    """Return the result of `everyone` before any meeting: nan."""
    return np.full((count, count) if constant_sum else (2, count, count), np.nan)


BAND = 4
"""Predators in a band. An evaluation runs 16 episodes in parallel: four predators against four
prey, so that each network's weights are read once for four episodes (lib/evonet/rows.hpp).
"""


def everyone(
    play: Play, predators: np.ndarray, prey: np.ndarray, seed: int | None = None
) -> np.ndarray:
    """Return the fitness of every predator (rows) against every prey (columns), as for `seen_by`.

    They meet in bands of a few predators: all of a band meet the first prey, then the next.
    """
    shape = len(predators), len(prey)
    row, column = np.indices(shape, dtype=np.int32).reshape(2, -1)
    pairs = np.stack([row, column])[:, np.lexsort((row, column, row // BAND))]
    met = play(predators, prey, pairs) if seed is None else play(predators, prey, pairs, seed)
    fitness = np.empty((*met.shape[:-1], *shape))
    fitness[..., pairs[0], pairs[1]] = met
    return fitness


def mean(fitness: np.ndarray) -> float:
    """Return the mean of all, by an exact sum: the same bits on every machine, in any order."""
    return math.fsum(fitness.ravel().tolist()) / fitness.size


def means(fitness: np.ndarray) -> np.ndarray:
    """Return the mean of each row."""
    return np.array([mean(row) for row in fitness])


def ranking(fitness: np.ndarray) -> np.ndarray:
    """Return rows from the best mean to the worst; the earlier row wins ties."""
    return np.argsort(-means(fitness), kind="stable")
