"""archive, competitive co-evolution against a hall of fame: Rosin and Belew (1997), "New methods
for competitive coevolution"; in this form Nolfi and Pagliuca (2024), "Global progress in
competitive co-evolution", https://doi.org/10.3389/frobt.2024.1470886. See docs/specification.md,
"Algorithms".

Each side has one centre. In its turn, the centre makes a step of OpenAI-ES against opponents drawn
from the other side's archive. The best sample of some turns enters the archive.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from botschool.evolution.algorithm import algorithm
from botschool.evolution.algorithms.halloffame import HallOfFame, HallOfFameConfig
from botschool.policies.hyperparameters import NO_YES, hyper
from botschool.seeds import generator


@dataclass
class ArchiveConfig(HallOfFameConfig):
    """Section [ALGO] of archive."""

    addtoarchiveevery: int = hyper(
        10, "turns of a side between additions to its archive", low=1, high=1000000000
    )
    seldifferentiated: int = hyper(0, "no effect with one centre a side", choices=NO_YES)
    preferential: int = hyper(
        1, "individuals drawn for an opponent (archivestar can draw more)", low=1, high=10000
    )


@algorithm(
    "archive", "two sides, each against an archive of the other", ArchiveConfig, competitive=True
)
class Archive(HallOfFame):
    """One centre per side; all archived opponents are equally likely."""

    @staticmethod
    def conflicts(config: ArchiveConfig) -> Iterator[tuple[tuple[str, ...], str]]:
        """Yield hyperparameters that cannot go together."""
        if config.preferential > 1 and not config.seldifferentiated:
            yield (
                ("preferential",),
                f"preferential = {config.preferential} prefers strong opponents, but archive draws "
                "all equally: set algo = archivestar and popsize = 1, or remove the line",
            )

    def ask(self) -> tuple[np.ndarray, np.ndarray]:
        """Return candidates (1, 2 * samplesize, parameters), opponents (1, samplesize,
        ncompetitors).
        """
        numbers = generator(self.seed, self.generation)
        candidates = self._samples(numbers)

        # each pair of candidates draws its own opponents, with replacement
        archived = len(self.archives[1 - self.side])
        shape = (1, self.config.samplesize, self.config.ncompetitors)
        return candidates, numbers.integers(archived, size=shape)

    def tell(self, fitness: np.ndarray) -> None:
        """Move the centre; the best sample of some turns enters the archive."""
        best = self._climb(fitness)
        if self.turn % self.config.addtoarchiveevery == 0:
            self.archives[self.side].extend(best.astype(np.float32))
        self.generation += 1
