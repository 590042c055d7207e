"""Cut a batch of episodes into chunks for workers, and join their outcomes."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

import numpy as np

from botschool.cluster import wire
from botschool.evolution.algorithms.drawing import Drawn
from botschool.problems import Episodes, Outcome

SHARE = 0.65
"""Size of a worker's next chunk, relative to its share of what is left."""
LEAST = 0.05
"""Shortest duration of a chunk in seconds, as estimated."""
FIRST = 0.1
"""Part of its share that a worker gets before its speed is known."""
HALF = 1.0
"""Age in seconds of evaluation at which a measured speed counts half."""
LANES = 16
"""Episodes that a thread computes in parallel; chunks of native problems are multiples of it."""


class Batch:
    """Episodes to evaluate; chunks are slices of them, in any order."""

    def __init__(
        self,
        parts: list[np.ndarray],
        normalisation: np.ndarray | None,
        episodes: Episodes,
        maxsteps: int,
        single: bool = False,
    ) -> None:
        """Start a batch; parts: arrays of genotypes; single: single precision suffices."""
        met = episodes.candidate.ndim == 2
        self.parts = [_Part(part, met, single) for part in parts]
        self.episodes = episodes
        self.maxsteps = maxsteps
        self.normalisation = None if normalisation is None else wire.pack(normalisation)
        n = len(episodes)
        self.fitness: np.ndarray | None = None
        self.steps = np.empty(n, dtype=np.int32)
        self.moments: np.ndarray | None = None
        self._next = 0
        self._again: deque[slice] = deque()
        self._losses: dict[int, int] = {}
        self._entered: set[int] = set()
        self.left = n
        """Episodes without an outcome."""
        self._firsts = np.cumsum([0, *(len(part) for part in parts)])

    @property
    def waiting(self) -> bool:
        """Return whether there are episodes that no worker has."""
        return bool(self._again) or self._next < len(self.episodes)

    def take(self, count: int) -> slice:
        """Return the next chunk, of about `count` episodes; lost chunks come first."""
        if self._again:
            return self._again.popleft()
        first, rest = self._next, len(self.episodes) - self._next
        self._next += rest if count > 0.75 * rest else count
        return slice(first, self._next)

    def give_back(self, chunk: slice) -> int:
        """Take back the chunk of a lost worker; return how often this chunk was lost."""
        self._again.append(chunk)
        self._losses[chunk.start] = self._losses.get(chunk.start, 0) + 1
        return self._losses[chunk.start]

    def done(self, chunk: slice) -> bool:
        """Return whether the chunk's outcome is known."""
        return chunk.start in self._entered

    def untaken(self) -> int:
        """Return the number of episodes that no worker ever got."""
        return len(self.episodes) - self._next

    def enter(self, chunk: slice, answer: dict) -> None:
        """Enter the outcome of a chunk. Raises ValueError for one of another shape."""
        count, wanted = chunk.stop - chunk.start, self.episodes.collect is not None
        fitness, steps, moments = answer["fitness"], answer["steps"], answer["moments"]
        if self.fitness is None:
            fitnesses = np.empty((*fitness.shape[:-1], len(self.episodes)))
            collected = np.zeros((len(self.episodes), moments.shape[1])) if wanted else None
        else:
            fitnesses, collected = self.fitness, self.moments
        if (
            fitness.shape != (*fitnesses.shape[:-1], count)
            or steps.shape != (count,)
            or wanted != (moments is not None)
            or (wanted and moments.shape != (count, collected.shape[1]))
        ):
            raise ValueError("the outcome does not fit its episodes")
        self.fitness, self.moments = fitnesses, collected
        fitnesses[..., chunk], self.steps[chunk] = fitness, steps
        if wanted:
            collected[chunk] = moments
        self._entered.add(chunk.start)
        self.left -= count

    def outcome(self) -> Outcome:
        """Return the outcome of the whole batch, in the order of its episodes."""
        return Outcome(self.fitness, self.steps, self.moments)

    def message(self, chunk: slice) -> tuple[dict, dict[bytes, bytes]]:
        """Return a worker's message for a chunk: the request, and the tables that it refers to."""
        chosen = self.episodes.select(chunk)
        used, places = np.unique(chosen.candidate, return_inverse=True)
        tables, parts = {}, []
        edges = np.searchsorted(used, self._firsts)
        for part, first, begin, end in zip(
            self.parts, self._firsts[:-1], edges[:-1], edges[1:], strict=True
        ):
            if begin < end:
                sent, needed = part.rows(used[begin:end] - first)
                parts.append(sent)
                tables.update(needed)
        name = None
        if self.normalisation is not None:
            name = wire.digest(self.normalisation)
            tables[name] = self.normalisation
        request = {
            "parts": parts,
            "normalisation": name,
            "candidate": places.reshape(chosen.candidate.shape).astype(np.int32),
            "seed": chosen.seed,
            "episode": chosen.episode,
            "collect": chosen.collect,
            "maxsteps": self.maxsteps,
        }
        return request, tables


class _Part:
    """Genotypes of a batch, with the way they are sent."""

    def __init__(self, genotypes: np.ndarray, met: bool, single: bool) -> None:
        """Prepare genotypes; met: each meets many others; single: single precision suffices."""
        self._genotypes = genotypes
        self._met, self._type = met, np.float32 if single else np.float64
        self._recipe = genotypes.recipe if isinstance(genotypes, Drawn) else None
        self._rows: dict[int, tuple[bytes, bytes]] = {}
        self._drawn: tuple[list[bytes], dict[bytes, bytes]] | None = None

    def __len__(self) -> int:
        return len(self._genotypes)

    def rows(self, numbers: np.ndarray) -> tuple[dict, dict[bytes, bytes]]:
        """Return a request's genotypes with these sorted numbers, and the tables that it refers to.

        Drawn candidates are sent as a recipe and drawn again. Networks that meet many others are
        tables, which each worker gets once and keeps. All others are sent as they are.
        """
        if self._recipe is not None:
            (name, *told), tables = self._drawn = self._drawn or self._tables()
            return {"table": name, "told": told, "rows": numbers.astype(np.int32)}, tables
        if not self._met:
            return {"sent": self._genotypes[numbers].astype(self._type)}, {}
        for number in set(numbers.tolist()) - self._rows.keys():
            data = wire.pack(self._genotypes[number].astype(self._type))
            self._rows[number] = wire.digest(data), data
        chosen = [self._rows[number] for number in numbers.tolist()]
        return {"each": [name for name, _ in chosen]}, dict(chosen)

    def _tables(self) -> tuple[list[bytes], dict[bytes, bytes]]:
        """Return the recipe as tables: their names in its order, and the tables."""
        first, *told = self._recipe
        tables = [wire.packed(first), *map(wire.pack, told)]
        names = [wire.digest(data) for data in tables]
        return names, dict(zip(names, tables, strict=True))


@dataclass
class Pace:
    """The speed of a worker: measured, or guessed from its threads."""

    threads: int
    episodes: float = 0.0
    """Episodes per second; 0 if not known yet."""
    steps: float = 0.0
    """Steps per second."""
    _seconds: float = 0.0
    """Seconds in which they were measured; old ones count less."""

    def measured(self, episodes: int, steps: int, seconds: float) -> None:
        """Take an answer into account."""
        seconds = max(seconds, 1e-6)
        self._seconds = self._seconds * 0.5 ** (seconds / HALF) + seconds
        weight = seconds / self._seconds
        self.episodes += weight * (episodes / seconds - self.episodes)
        self.steps += weight * (steps / seconds - self.steps)


def size(
    batch: Batch,
    number: int,
    paces: list[Pace],
    ahead: list[float],
    native: bool,
    least: float = LEAST,
) -> int:
    """Return the size of a worker's next chunk in episodes, so that all workers end together.

    number: the worker's index in paces and ahead. ahead: episodes that each worker has yet to
    evaluate. least: seconds that a chunk should take.
    """
    known = [pace for pace in paces if pace.episodes]
    thread = sum(p.episodes for p in known) / sum(p.threads for p in known) if known else 1.0
    speeds = [pace.episodes or thread * pace.threads for pace in paces]
    pace, share = paces[number], speeds[number] / sum(speeds)
    if pace.episodes:
        left = (batch.untaken() + sum(ahead)) * share - ahead[number]
        count = max(SHARE * left, least * pace.episodes)
    else:
        count = FIRST * batch.untaken() * share
    lanes = LANES * pace.threads if native else 1
    return max(1, round(count / lanes)) * lanes if count >= lanes / 2 else max(1, round(count))
