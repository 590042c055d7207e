"""Predators and prey: what all algorithms with two sides share."""

from __future__ import annotations

import math

import numpy as np

from botschool.evolution.algorithm import Play

PREDATORS, PREY = 0, 1
SIDES = ("predators", "prey")


def seen_by(side: int, fitness: np.ndarray) -> np.ndarray:
    """Fitness of the individuals of one side (rows) against their competitors (columns).

    fitness: of predators (rows) against prey (columns). A prey's fitness is 1 - the predator's.
    """
    return fitness if side == PREDATORS else 1 - fitness.T


BAND = 4
"""Side by side an evaluation has 16 episodes: those of four predators against four prey, where each
network's weights are read once for four of them (lib/evonet/rows.hpp)."""


def everyone(play: Play, predators: np.ndarray, prey: np.ndarray) -> np.ndarray:
    """Fitness of every predator (rows) against every prey (columns).

    They meet in bands of a few predators: all of a band the first prey, then the next.
    """
    fitness = np.empty((len(predators), len(prey)))
    row, column = np.indices(fitness.shape, dtype=np.int32).reshape(2, -1)
    pairs = np.stack([row, column])[:, np.lexsort((row, column, row // BAND))]
    fitness[tuple(pairs)] = play(predators, prey, pairs)
    return fitness


def mean(fitness: np.ndarray) -> float:
    """Mean of all, by an exact sum: the same bits on every machine, in any order."""
    return math.fsum(fitness.ravel().tolist()) / fitness.size


def means(fitness: np.ndarray) -> np.ndarray:
    """Mean of each row."""
    return np.array([mean(row) for row in fitness])


def ranking(fitness: np.ndarray) -> np.ndarray:
    """Rows from the best mean to the worst; of equals, the earlier row first."""
    return np.argsort(-means(fitness), kind="stable")
