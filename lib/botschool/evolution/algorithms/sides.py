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


def everyone(play: Play, predators: np.ndarray, prey: np.ndarray) -> np.ndarray:
    """Fitness of every predator (rows) against every prey (columns).

    The fewer ones are the outer loop, so that long rows of meetings share a network.
    """
    shape = (len(predators), len(prey))
    order = "C" if len(predators) <= len(prey) else "F"
    pairs = np.stack([index.ravel(order) for index in np.indices(shape, dtype=np.int32)])
    return np.ascontiguousarray(play(predators, prey, pairs).reshape(shape, order=order))


def mean(fitness: np.ndarray) -> float:
    """Mean of all, by an exact sum: the same bits on every machine, in any order."""
    return math.fsum(fitness.ravel().tolist()) / fitness.size


def means(fitness: np.ndarray) -> np.ndarray:
    """Mean of each row."""
    return np.array([mean(row) for row in fitness])


def ranking(fitness: np.ndarray) -> np.ndarray:
    """Rows from the best mean to the worst; of equals, the earlier row first."""
    return np.argsort(-means(fitness), kind="stable")
