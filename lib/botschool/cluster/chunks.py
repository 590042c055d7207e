"""Cut a batch of episodes into chunks for workers, and join their outcomes."""

from __future__ import annotations

import threading
import time

import numpy as np

from botschool.errors import BotschoolError
from botschool.problems import Episodes, Outcome

LOSSES = 10
"""Losses of a chunk with its worker after which evaluation stops."""


class Batch:
    """Episodes to evaluate; chunks are slices of them, in any order."""

    def __init__(
        self,
        genotypes: np.ndarray,
        normalisation: np.ndarray | None,
        episodes: Episodes,
        maxsteps: int,
    ) -> None:
        self._genotypes, self._normalisation, self._maxsteps = genotypes, normalisation, maxsteps
        self._episodes = episodes
        self.untaken = len(episodes)
        """Episodes that no worker ever got."""
        self._left = len(episodes)
        self._again: list[slice] = []
        self._losses: dict[int, int] = {}
        self._late: dict[int, tuple[float, float, slice]] = {}
        """Chunks that workers have: when they are late, and after how many seconds."""
        self._found: dict[int, Outcome] = {}
        self.began = time.monotonic()
        """Time at which the first worker got a chunk."""
        self.idle: dict[str, float] = {}
        """Times at which no work was left to give to workers."""
        self.over = threading.Event()
        """Set when there is an outcome, or an error."""
        self.error: BotschoolError | None = None

    @property
    def waiting(self) -> bool:
        """Return whether there are episodes that no worker has."""
        return bool(self._again or self.untaken)

    def take(self, count: int) -> slice:
        """Return the next chunk, of about `count` episodes; lost chunks come first."""
        if self._again:
            return self._again.pop(0)
        first = len(self._episodes) - self.untaken
        if not first:
            self.began = time.monotonic()
        self.untaken -= self.untaken if count > 0.75 * self.untaken else count
        return slice(first, len(self._episodes) - self.untaken)

    def late(self) -> slice | None:
        """Return a chunk that a worker should have finished."""
        now = time.monotonic()
        return next((chunk for due, _, chunk in self._late.values() if now > due), None)

    def sent(self, chunk: slice, limit: float) -> None:
        """Note that a worker gets a chunk, which is late after so many seconds.

        A chunk that was late before gets twice the time.
        """
        _, before, _ = self._late.pop(chunk.start, (0, 0, chunk))
        limit = max(limit, 2 * before)
        self._late[chunk.start] = time.monotonic() + limit, limit, chunk

    def enter(self, chunk: slice, outcome: Outcome) -> None:
        """Enter the outcome of a chunk; the first one counts."""
        if chunk.start not in self._found:
            self._found[chunk.start] = outcome
            self._late.pop(chunk.start, None)
            self._left -= chunk.stop - chunk.start
            if not self._left:
                self.over.set()

    def give_back(self, chunk: slice) -> None:
        """Take back the chunk of a lost worker."""
        if chunk.start in self._found:
            return
        self._again.append(chunk)
        self._late.pop(chunk.start, None)
        self._losses[chunk.start] = self._losses.get(chunk.start, 0) + 1
        if self._losses[chunk.start] >= LOSSES:
            self.fail(
                BotschoolError(
                    f"Workers were lost {LOSSES} times with the same episodes: look at their "
                    "output, or run with -w 1 to see why."
                )
            )

    def fail(self, error: BotschoolError) -> None:
        """End the batch by an error."""
        self.error = self.error or error
        self.over.set()

    def outcome(self) -> Outcome:
        """Return the outcome of the whole batch, in the order of its episodes."""
        if self.error:
            raise self.error
        found = [self._found[first] for first in sorted(self._found)]
        fitness = np.concatenate([each.fitness for each in found], axis=-1)
        steps = np.concatenate([each.steps for each in found])
        if self._episodes.collect is None:
            return Outcome(fitness, steps)
        return Outcome(fitness, steps, np.concatenate([each.moments for each in found]))

    def arguments(self, chunk: slice) -> tuple[np.ndarray, np.ndarray | None, Episodes, int]:
        """Return the arguments of worker.evaluate for a chunk: only the genotypes that it needs."""
        episodes = self._episodes.select(chunk)
        used, places = np.unique(episodes.candidate, return_inverse=True)
        episodes.candidate = places.reshape(episodes.candidate.shape).astype(np.int32)
        return self._genotypes[used], self._normalisation, episodes, self._maxsteps
