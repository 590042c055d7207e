"""MAP-Elites: Mouret and Clune (2015), "Illuminating search spaces by mapping elites",
https://arxiv.org/abs/1504.04909, with the variation of Vassiliades and Mouret (2018), "Discovering
the elite hypervolume by leveraging interspecies correlation",
https://arxiv.org/abs/1804.03906. See docs/specification.md, "MAP-Elites".

Two numbers describe how a robot behaves. They place it in a cell of a square map, and each cell
keeps the best robot that came there: many good ways to do it instead of one.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from botschool.errors import BotschoolError
from botschool.evolution.algorithm import Initial, RunConfig, Stateful, algorithm, mean_absolute
from botschool.inifile import shown
from botschool.policies.hyperparameters import hyper
from botschool.policies.policy import Policy
from botschool.seeds import generator

_FEATURE = r"(mean|spread) (0|[1-9][0-9]{0,5})(?: \(([^()]{1,40})\))?"


@dataclass(frozen=True)
class Feature:
    """An axis of the map: mean or spread (standard deviation) of an observation in an episode."""

    kind: str
    observation: int
    name: str


def features(text: str) -> tuple[Feature, Feature]:
    """Return the two features that a text names. Raises ValueError."""
    match = re.fullmatch(rf"\s*{_FEATURE}\s*,\s*{_FEATURE}\s*", text)
    if match is None:
        raise ValueError(
            f"{shown(text)} does not name two features: write, for example, mean 1 (lean), spread 6"
        )
    kinds, indices, names = match.groups()[::3], match.groups()[1::3], match.groups()[2::3]
    one, other = (
        Feature(kind, int(index), name or f"{kind} of observation {index}")
        for kind, index, name in zip(kinds, indices, names, strict=True)
    )
    return one, other


def limits(text: str) -> tuple[float, float]:
    """Return the two numbers that a text lists. Raises ValueError."""
    try:
        one, other = map(float, text.split(","))
    except ValueError:
        raise ValueError(f"{shown(text)} is not two numbers, as in -0.5, 0") from None
    if not np.isfinite([one, other]).all():
        raise ValueError(f"{shown(text)} is not two finite numbers")
    return one, other


@dataclass
class MapElitesConfig(RunConfig):
    """Section [ALGO] of MAP-Elites."""

    batch: int = hyper(100, "children of a generation", low=1, high=1000000)
    behaviour: str = hyper(
        "mean 0, mean 1", "the axes of the map: mean or spread of an observation in an episode",
        check=features, form="two of mean N and spread N, with a name in brackets if you like",
    )  # fmt: skip
    lowest: str = hyper(
        "-1, -1", "where the axes begin; lower values count as this", check=limits,
        form="two numbers",
    )  # fmt: skip
    highest: str = hyper("1, 1", "where the axes end", check=limits, form="two numbers")
    cells: int = hyper(20, "cells along each axis", low=1, high=1000)
    mutrate: float = hyper(
        0.02, "standard deviation of mutations", low=0, high=1000, alias="mutation"
    )
    linerate: float = hyper(
        0.2, "standard deviation of the move towards another elite, as a share of the way",
        low=0, high=1000,
    )  # fmt: skip


@algorithm("MAP-Elites", "a map of the best robot for each behaviour", MapElitesConfig)
class MapElites(Stateful):
    """ask() -> children of elites; tell(their fitness and behaviour) puts them on the map."""

    evolves = ("generation", "elites", "fitness", "place")
    behaves = True
    """Asks the run to tell the behaviour, too."""

    def __init__(self, config: MapElitesConfig, initial: Initial, seed: int) -> None:
        """Start with an empty map: elites (cells x cells, parameters), their fitness, -inf in an
        empty cell, and their features, (cells x cells, 2). The first feature counts the rows.
        """
        self.config = config
        self.seed = seed
        self.generation = 0
        self._initial = initial
        self._features = features(config.behaviour)
        self._low, self._high = np.array(limits(config.lowest)), np.array(limits(config.highest))
        count = config.cells**2
        self.elites = np.zeros((count, len(initial(0))))
        self.fitness = np.full(count, -np.inf)
        self.place = np.zeros((count, 2))

    @staticmethod
    def conflicts(config: MapElitesConfig) -> Iterator[tuple[tuple[str, ...], str]]:
        """Yield hyperparameters that cannot go together."""
        for low, high in zip(limits(config.lowest), limits(config.highest), strict=True):
            if low >= high:
                yield (
                    ("lowest", "highest"),
                    f"an axis cannot go from {low:g} to {high:g}: lowest must be below highest",
                )

    @staticmethod
    def check(config: MapElitesConfig, policy: Policy) -> None:
        """Raise BotschoolError for a policy whose robots this map cannot hold."""
        if policy.spec.normalize:
            raise BotschoolError(
                "MAP-Elites compares robots of all generations, and normalisation changes from "
                "one to the next: set normalize = 0."
            )
        for feature in features(config.behaviour):
            if feature.observation >= policy.spec.inputs:
                raise BotschoolError(
                    f"behaviour names observation {feature.observation}, but a robot here has "
                    f"{policy.spec.inputs} of them, from 0 to {policy.spec.inputs - 1}."
                )

    def ask(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the children, shape (batch, parameters), and the seed of each one's evaluation.

        All robots of the run meet the same episodes, so an elite keeps its fitness.
        """
        batch = self.config.batch
        there = np.flatnonzero(self.fitness > -np.inf)
        seeds = np.full(batch, self.seed, dtype=np.uint64)
        if not len(there):
            first = self.generation * batch
            self._children = np.array([self._initial(first + i) for i in range(batch)])
            return self._children, seeds
        numbers = generator(self.seed, self.generation)
        one, other = self.elites[there[numbers.integers(len(there), size=(2, batch))]]
        noise = numbers.standard_normal(one.shape)
        along = numbers.standard_normal(batch)[:, None]
        self._children = (
            one + self.config.mutrate * noise + self.config.linerate * along * (other - one)
        )
        return self._children, seeds

    def tell(self, fitness: np.ndarray, behaviour: np.ndarray) -> None:
        """Let each child take its cell if the cell is empty or its elite worse, in their order.

        fitness: shape (batch,). behaviour: (batch, 2, observations), mean and spread of each
        observation. A child whose fitness or features are not finite gets no cell.
        """
        kinds = [("mean", "spread").index(feature.kind) for feature in self._features]
        place = behaviour[:, kinds, [feature.observation for feature in self._features]]
        self.elites, self.fitness = self.elites.copy(), self.fitness.copy()
        self.place = self.place.copy()
        valid = np.isfinite(fitness) & np.isfinite(place).all(axis=1)
        for i in np.flatnonzero(valid):
            cell = self.cell(place[i])
            if fitness[i] > self.fitness[cell]:
                self.elites[cell], self.fitness[cell] = self._children[i], fitness[i]
                self.place[cell] = place[i]
        self.generation += 1

    def cell(self, place: np.ndarray) -> int:
        """Return the cell of two features; beyond the ends of an axis it is the last one."""
        cells = self.config.cells
        share = (place - self._low) / (self._high - self._low)
        row, column = np.clip(np.floor(share * cells), 0, cells - 1).astype(int)
        return int(row * cells + column)

    def average_parameter(self) -> float:
        """Return the average absolute parameter of the elites."""
        there = self.fitness > -np.inf
        return mean_absolute(self.elites[there]) if there.any() else 0.0
