"""Track a cluster's workers: their tasks and the tables that they hold."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Iterable
from dataclasses import dataclass, field

from botschool.cluster.chunks import Batch, Pace

SPACE = 256_000_000
"""Bytes of tables that a worker keeps."""
UNKNOWN = 30.0
"""Expected seconds of a chunk before anything is known."""


class Shelf:
    """A set of names with sizes in bytes; it drops the names that were used longest ago."""

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._sizes: OrderedDict[bytes, int] = OrderedDict()
        self._total = 0

    def __contains__(self, name: bytes) -> bool:
        return name in self._sizes

    def put(self, name: bytes, size: int) -> None:
        """Add a table."""
        self.drop(name)
        self._sizes[name] = size
        self._total += size

    def drop(self, name: bytes) -> None:
        """Remove a table."""
        self._total -= self._sizes.pop(name, 0)

    def use(self, names: Iterable[bytes]) -> None:
        """Mark tables as used now."""
        for name in names:
            self._sizes.move_to_end(name)

    def trim(self) -> list[bytes]:
        """Drop the least recently used tables until the rest fits; return their names."""
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
    """Time at which it began, or will begin, as estimated."""
    expected: float
    """Seconds that it should take."""
    message: tuple[dict, dict[bytes, bytes]]
    copies: int = 0
    """Number of other workers that got it, too."""

    def left(self, now: float) -> float:
        """Return the estimated number of episodes that are not yet evaluated."""
        part = (self.since + self.expected - now) / self.expected
        return (self.chunk.stop - self.chunk.start) * min(1.0, max(0.0, part))


@dataclass
class Worker:
    """A worker as the command sees it."""

    address: str
    pace: Pace
    ready: bool = False
    """Whether it computes the same bits as this machine."""
    left_out: str = ""
    """Why it is left out; "" if it is not."""
    tasks: dict[int, Task] = field(default_factory=dict)
    holds: Shelf = field(default_factory=lambda: Shelf(SPACE // 2))
    """Tables that it probably has."""
    failures: int = 0
    greeting: int | None = None
    """Number of its greeting's task."""

    @property
    def behind(self) -> bool:
        """Return whether it still works on chunks that others have finished in its place."""
        return any(task.batch.done(task.chunk) for task in self.tasks.values())

    def task(self, batch: Batch, chunk: slice, message, now: float) -> Task:
        """Add a chunk after the worker's other chunks and return its task."""
        count = chunk.stop - chunk.start
        expected = count / self.pace.episodes if self.pace.episodes else UNKNOWN
        free = [task.since + task.expected for task in self.tasks.values()]
        return Task(batch, chunk, self, max([now, *free]), expected, message)

    def ahead(self, now: float) -> float:
        """Return the number of episodes that it has yet to evaluate."""
        return sum(task.left(now) for task in self.tasks.values())
