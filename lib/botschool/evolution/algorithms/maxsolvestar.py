"""maxsolvestar, co-evolution against an archive without redundant members: "MaxSolve*" of Nolfi and
Pagliuca (2024), "Global progress in competitive co-evolution",
https://doi.org/10.3389/frobt.2024.1470886, after De Jong (2005), "The MaxSolve algorithm for
coevolution". See docs/specification.md, "Algorithms".

It differs from archive in two points. The centre enters the archive after every turn. A full
archive drops redundant members: in every phase of evolution, another member is at least as hard a
test.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from botschool.evolution.algorithm import Initial, algorithm, million_steps
from botschool.evolution.algorithms.halloffame import HallOfFame, HallOfFameConfig
from botschool.policies.hyperparameters import hyper
from botschool.seeds import generator

LOOKED_AT = 10
"""Members of a full archive that a turn examines."""


@dataclass
class MaxSolveStarConfig(HallOfFameConfig):
    """Section [ALGO] of maxsolvestar. Phases divide the run, so its length may not change."""

    maxmsteps: float = million_steps(75000.0, free=False)
    ngenerations: int = hyper(
        0,
        "length of the run, in generations (0 = maxmsteps alone counts)",
        low=0,
        high=1000000000,
    )
    nphases: int = hyper(
        10, "phases of evolution in which opponents are compared", low=1, high=10000
    )
    archivelen: int = hyper(
        25000, "archived individuals from which on easy ones are dropped", low=1, high=1000000000
    )


@algorithm("maxsolvestar", "archive of hard opponents", MaxSolveStarConfig, competitive=True)
class MaxSolveStar(HallOfFame):
    """One centre per side. For each archived individual it records how others did against it.

    `solved`, of predators and prey: for each archived individual an array (2, nphases) with the sum
    of its opponents' fitness in each phase of evolution, and the number of opponents.
    """

    known = ("solved",)

    def __init__(
        self, config: MaxSolveStarConfig, initial: Initial, seed: int, constant_sum: bool = True
    ) -> None:
        """Start as HallOfFame does."""
        super().__init__(config, initial, seed, constant_sum)
        self.solved: tuple[list, list] = ([], [])
        for solved, archive in zip(self.solved, self.archives, strict=True):
            solved.extend(np.zeros((2, config.nphases)) for _ in archive)

    @property
    def phase(self) -> int:
        """Return the present phase, from 0; `nphases` equal phases divide the evolution."""
        return min(int(self.share * self.config.nphases), self.config.nphases - 1)

    def ask(self) -> tuple[np.ndarray, np.ndarray]:
        """Return candidates (1, 2 * samplesize, parameters), opponents (1, samplesize,
        ncompetitors).
        """
        self.numbers = generator(self.seed, self.generation)
        candidates = self._samples(self.numbers)
        archived = len(self.archives[1 - self.side])
        shape = (1, self.config.samplesize, self.config.ncompetitors)
        self.opponents = self.numbers.integers(archived, size=shape)
        return candidates, self.opponents

    def tell(self, fitness: np.ndarray) -> None:
        """Move the centre, which enters the archive; one member of a full archive may leave it."""
        side = self.side
        met = np.repeat(self.opponents, 2, axis=1)  # both candidates of a perturbation met them
        for place, value in zip(met.ravel().tolist(), fitness.ravel().tolist(), strict=True):
            self.solved[1 - side][place][:, self.phase] += value, 1

        self._climb(fitness)
        if len(self.archives[side]) >= self.config.archivelen:
            self._drop(side)
        self.archives[side].extend(self.centres[side].astype(np.float32))
        self.solved[side].append(np.zeros((2, self.config.nphases)))
        self.generation += 1

    def _drop(self, side: int) -> None:
        """Examine some random members and drop the first dominated one."""
        solved = np.array(self.solved[side])
        looked_at = self.numbers.permutation(len(solved))[:LOOKED_AT].tolist()
        for place in looked_at:
            if dominated(solved[:, 0], solved[:, 1], place):
                del self.archives[side][place], self.solved[side][place]
                return


def dominated(sums: np.ndarray, counts: np.ndarray, place: int) -> bool:
    """Return whether another member is at least as hard to beat as `place` in every phase.

    sums, counts: shape (archived, phases), the fitness sum and number of each member's opponents.
    Only phases in which `place` met opponents count: the other member must have met some in each of
    them, with a mean no higher. No member dominates one that has met no opponent.
    """
    known = counts[place] > 0
    if not known.any():
        return False
    mine = sums[place, known] / counts[place, known]
    met = counts[:, known]
    others = np.where(met > 0, sums[:, known] / np.maximum(met, 1), np.inf)
    others[place] = np.inf
    return bool((others <= mine).all(axis=1).any())
