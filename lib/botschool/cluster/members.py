"""The workers of a cluster as the command sees them: their tasks, and the tables that they hold."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable
from dataclasses import dataclass, field

from botschool.cluster.chunks import Batch, Pace

SPACE = 256_000_000
"""Bytes of tables that a worker keeps."""
UNKNOWN = 30.0
"""The time that a chunk should take where nothing is known."""


class Shelf:
    """Names, each with a size in bytes; those used last are kept, as many as fit."""

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._sizes: OrderedDict[bytes, int] = OrderedDict()
        self._total = 0

    def __contains__(self, name: bytes) -> bool:
        return name in self._sizes

    def put(self, name: bytes, size: int) -> None:
        """A table that is there from now on."""
        self.drop(name)
        self._sizes[name] = size
        self._total += size

    def drop(self, name: bytes) -> None:
        """A table that is not there."""
        self._total -= self._sizes.pop(name, 0)

    def use(self, names: Iterable[bytes]) -> None:
        """Tables that are used now."""
        for name in names:
            self._sizes.move_to_end(name)

    def trim(self) -> list[bytes]:
        """Drops what has not been used for longest, until the rest fits; gives the names."""
        dropped = []
        while self._total > self._limit:
            dropped.append(next(iter(self._sizes)))
            self.drop(dropped[-1])
        return dropped


@dataclass
class Task:
    """A chunk that a worker has."""

    batch: Batch
    chunk: slice
    worker: Worker
    since: float
    """When it began, or will begin, as far as is known."""
    expected: float
    """Seconds that it should take."""
    message: tuple[dict, dict[bytes, bytes]]
    copies: int = 0
    """How often it was given to others too."""

    def left(self, now: float) -> float:
        """Episodes that are yet to be evaluated, as far as is known."""
        part = (self.since + self.expected - now) / self.expected
        return (self.chunk.stop - self.chunk.start) * min(1.0, max(0.0, part))


@dataclass
class Worker:
    """A worker as the command sees it."""

    address: str
    pace: Pace
    ready: bool = False
    """Whether it computes the same bits as we do."""
    left_out: str = ""
    """Why it gets nothing to do, if so."""
    tasks: dict[int, Task] = field(default_factory=dict)
    holds: Shelf = field(default_factory=lambda: Shelf(SPACE // 2))
    """Tables that it has, probably."""
    failures: int = 0
    greeting: int | None = None
    """Number of the task that asks it who it is."""

    @property
    def behind(self) -> bool:
        """Whether it has yet to answer what others have done in its place."""
        return any(task.batch.done(task.chunk) for task in self.tasks.values())

    def task(self, batch: Batch, chunk: slice, message, now: float) -> Task:
        """A chunk for it, after those that it has."""
        count = chunk.stop - chunk.start
        expected = count / self.pace.episodes if self.pace.episodes else UNKNOWN
        free = [task.since + task.expected for task in self.tasks.values()]
        return Task(batch, chunk, self, max([now, *free]), expected, message)

    def ahead(self, now: float) -> float:
        """Episodes that it has yet to evaluate."""
        return sum(task.left(now) for task in self.tasks.values())
