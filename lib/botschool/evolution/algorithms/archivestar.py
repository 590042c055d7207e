"""archivestar, co-evolution of several lineages per side against archives: "Archive*" of Nolfi and
Pagliuca (2024), "Global progress in competitive co-evolution",
https://doi.org/10.3389/frobt.2024.1470886. See docs/specification.md, "Algorithms".

It extends archive to `popsize` centres per side that share one archive. Different lineages find
different strategies, so the archive is richer. The opponents come from all lineages in equal
shares, or are the strongest of several individuals drawn.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from botschool.evolution.algorithm import Initial, algorithm
from botschool.evolution.algorithms.archive import ArchiveConfig
from botschool.evolution.algorithms.halloffame import HallOfFame
from botschool.evolution.algorithms.sides import mean
from botschool.policies.hyperparameters import NO_YES, hyper
from botschool.seeds import Numbers, generator

UNKNOWN = 0.5
"""Strength of an individual that has met no opponent yet."""
KEPT = 0.9
"""Share of its old strength that an individual keeps when it meets others again."""


@dataclass
class ArchiveStarConfig(ArchiveConfig):
    """Section [ALGO] of archivestar."""

    popsize: int = hyper(5, "evolving centres of each side", low=1, high=10000)
    seldifferentiated: int = hyper(1, "opponents come from all lineages equally", choices=NO_YES)
    preferential: int = hyper(
        1,
        "individuals drawn; the strongest is the opponent when seldifferentiated = 0",
        low=1,
        high=10000,
    )


@algorithm("archivestar", "archive with several lineages a side", ArchiveStarConfig, True)
class ArchiveStar(HallOfFame):
    """Several centres per side. Each archived individual has a lineage and a strength.

    The strength is a running mean of the success of an individual, which is 1 minus the fitness of
    its opponents. After each turn in which it met opponents, the strength becomes 0.9 * strength +
    0.1 * mean success in that turn. If the game has no constant sum, success is minus that fitness,
    the first turn alone gives the strength, and individuals without a meeting count as the mean of
    the others.
    """

    known = ("lineages", "strengths")

    def __init__(
        self, config: ArchiveStarConfig, initial: Initial, seed: int, constant_sum: bool = True
    ) -> None:
        """Start as HallOfFame does; the first archived individuals get the lineages in turn."""
        super().__init__(config, initial, seed, constant_sum)
        first = [i % config.popsize for i in range(config.ncompetitors)]
        self.lineages = (first.copy(), first.copy())
        self.whole = 1 if constant_sum else 0
        self.unknown = UNKNOWN if constant_sum else np.nan
        self.strengths = ([self.unknown] * len(first), [self.unknown] * len(first))

    def ask(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the same as HallOfFame.ask; every pair of candidates draws its opponents."""
        numbers = generator(self.seed, self.generation)
        candidates = self._samples(numbers)
        draw = self._of_each_lineage if self.config.seldifferentiated else self._strongest
        self.opponents = draw(numbers)
        return candidates, self.opponents

    @property
    def _shape(self) -> tuple[int, int, int]:
        return self.config.popsize, self.config.samplesize, self.config.ncompetitors

    def _of_each_lineage(self, numbers: Numbers) -> np.ndarray:
        """Return the opponents: opponent c comes from lineage c mod popsize."""
        lineages = np.array(self.lineages[1 - self.side])
        members = [np.flatnonzero(lineages == k) for k in range(self.config.popsize)]
        slots = [members[c % self.config.popsize] for c in range(self.config.ncompetitors)]
        drawn = numbers.integers([len(slot) for slot in slots], size=self._shape)
        return np.stack([slot[drawn[..., c]] for c, slot in enumerate(slots)], axis=-1)

    def _strongest(self, numbers: Numbers) -> np.ndarray:
        """Return the opponents: the strongest of `preferential` drawn ones; the first wins ties."""
        strengths = np.array(self.strengths[1 - self.side])
        known = ~np.isnan(strengths)
        strengths[~known] = mean(strengths[known]) if known.any() else 0
        drawn = numbers.integers(len(strengths), size=(*self._shape, self.config.preferential))
        strongest = strengths[drawn].argmax(axis=-1, keepdims=True)
        return np.take_along_axis(drawn, strongest, axis=-1)[..., 0]

    def tell(self, fitness: np.ndarray) -> None:
        """Move the centres; the best sample of each lineage enters the archive in some turns."""
        side = self.side
        self._remember(self.strengths[1 - side], fitness)
        best = self._climb(fitness)
        if self.turn % self.config.addtoarchiveevery == 0:
            self.archives[side].extend(best.astype(np.float32))
            self.lineages[side].extend(range(len(best)))
            self.strengths[side].extend([self.unknown] * len(best))
        self.generation += 1

    def _remember(self, strengths: list[float], fitness: np.ndarray) -> None:
        """Update the strength of all individuals that met opponents."""
        met = np.repeat(self.opponents, 2, axis=1)  # both candidates of a perturbation met them
        for place in np.unique(met):
            success = self.whole - mean(fitness[met == place])
            before = success if math.isnan(strengths[place]) else strengths[place]
            strengths[place] = KEPT * before + (1 - KEPT) * success
