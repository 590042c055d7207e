"""Show co-evolved robots: each predator meets each prey, one pair after another."""

from __future__ import annotations

import numpy as np

from botschool.config import Experiment
from botschool.render.watch import PostEvaluation


class PairEpisodes(PostEvaluation):
    """Episodes of pairs: the first predator with every prey, then the second, and so on.

    predators, prey: networks, each (individuals, nparameters). Every pair has `pepisodes`
    episodes, the same that a tournament counts; an episode's fitness is the predator's.
    """

    def __init__(
        self, experiment: Experiment, seed: int, predators: np.ndarray, prey: np.ndarray, name: str
    ) -> None:
        super().__init__(experiment, seed)
        self.name = f"{name} (fitness is the {self.problem.sides[0]}'s)"
        self._predators, self._prey = predators, prey
        self._repeats = experiment.policy.pepisodes

    @property
    def available(self) -> int:
        """Return the number of episodes of all pairs."""
        return len(self._predators) * len(self._prey) * self._repeats

    def cast(self, episode: int) -> tuple[np.ndarray, np.ndarray | None, int]:
        """Return the pair's networks as rows, and the number of the pair's episode."""
        predator, prey, number = self._pair(episode)
        networks = np.stack([self._predators[predator], self._prey[prey]])
        return networks, None, number

    def label(self, episode: int) -> str:
        """Return which individuals meet."""
        predator, prey, _ = self._pair(episode)
        numbers = zip(self.problem.sides, (predator, prey), strict=True)
        return ", ".join(f"{side} {number + 1}" for side, number in numbers)

    def _pair(self, episode: int) -> tuple[int, int, int]:
        again, place = divmod(episode, self.available)
        pair, number = divmod(place, self._repeats)
        return *divmod(pair, len(self._prey)), again * self._repeats + number
