"""Give chunks to the workers that take part: those with this machine's version, files and bits.

All but `Crew.evaluate` runs in the loop of Dask's client, where a coroutine serves each worker.
"""

from __future__ import annotations

import asyncio
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from botschool import __version__
from botschool.cluster import worker as remote
from botschool.cluster.chunks import Batch
from botschool.cluster.connection import SILENCE, Connection, Lost
from botschool.errors import BotschoolError, said
from botschool.problems import Interrupted

DEPTH = 2
"""Chunks that a worker has at a time, so that it need not wait for the next one."""
SHARE = 0.65
"""Size of a worker's next chunk, relative to its share of what is left."""
FIRST = 0.1
"""The same before the worker's speed is known."""
LANES = 16
"""Episodes that a thread computes in parallel; chunks of native problems are multiples of it."""
TICK = 0.2
"""Seconds between two checks whether the user wants to stop."""
ASKING = 0.5
"""Seconds between two checks for new, lost and late workers."""
LATE, SOONEST, UNKNOWN = 3.0, 1.0, 30.0
"""A chunk is late after this many times its expected duration, and this many seconds; or after
UNKNOWN seconds if the speed is not known.
"""
SOON = 3.0
"""Seconds without workers after which the user is told."""
MOMENT = 1.0
"""Longest time in seconds between two looks that counts: a machine that slept has not listened."""
HALF = 1.0
"""Age in seconds of evaluation at which a measured speed counts half."""


@dataclass(eq=False)
class Worker:
    """A worker as the command sees it."""

    address: str
    threads: int
    serving: Any = None
    """The coroutine that serves it."""
    ready: bool = False
    """Whether it takes part."""
    left_out: str = ""
    """Why it does not; "" if it does or has not answered."""
    ahead: int = 0
    """Episodes that it has yet to evaluate."""
    pace: float = 0.0
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
        self.pace += weight * (episodes / seconds - self.pace)
        self.steps += weight * (steps / seconds - self.steps)


class Waiting:
    """Tells the user that something is away, and ends the wait for it."""

    def __init__(self, connection: Connection, soon: float) -> None:
        """Wait for nothing yet; soon: seconds after which the user is told."""
        self._connection, self._soon, self._told = connection, soon, False
        self.seconds = 0.0

    def look(self, passed: float, there: bool, back: str, away: str, ended: str) -> None:
        """Count the seconds that passed, unless it is there, and tell the user by these sentences.

        Raises BotschoolError after `patience`.
        """
        if there:
            if self._told:
                self._connection.say(back)
            self.seconds, self._told = 0.0, False
            return
        self.seconds += passed
        if self.seconds > self._connection.patience:
            raise BotschoolError(f"For {self.seconds:.0f} seconds {ended}")
        if self.seconds > self._soon and away and not self._told:
            self._told = True
            self._connection.say(away)


class Crew:
    """The workers of a connection, for one experiment.

    asked: the question to each worker (worker.hello); bits: the bits that each must compute, None
    if unknown; least: seconds that a chunk should take.
    """

    def __init__(
        self,
        connection: Connection,
        asked: dict[str, Any],
        bits: bytes | None,
        native: bool,
        least: float,
    ) -> None:
        self._connection, self._asked, self._bits = connection, asked, bits
        self._native, self._least = native, least
        self._workers: dict[str, Worker] = {}
        self._batch: Batch | None = None
        self._work = asyncio.Event()
        self._news: deque[str] = deque()
        self._scheduler = Waiting(connection, SILENCE)
        self._others = Waiting(connection, SOON)
        self._looked = time.monotonic()
        self.busy = 0.0
        """Seconds in which workers evaluated."""
        self._loop = connection.loop
        asyncio.run_coroutine_threadsafe(self._follow(), self._loop)

    @property
    def ready(self) -> list[Worker]:
        """Return the workers that take part."""
        return [worker for worker in list(self._workers.values()) if worker.ready]

    def evaluate(self, batch: Batch, stopping: Callable[[], bool]) -> None:
        """Evaluate every episode of a batch. Raises Interrupted or BotschoolError."""
        self._loop.call_soon_threadsafe(self._begin, batch)
        try:
            while not batch.over.wait(TICK):
                if stopping():
                    raise Interrupted
                self._look()
        finally:
            self._loop.call_soon_threadsafe(self._begin, None)
        while self._news:
            self._connection.say(self._news.popleft())

    def _look(self) -> None:
        """Tell the user what happened, and wait for a while if no worker can take a chunk.

        Raises BotschoolError if that takes longer than `patience`.
        """
        connection, ready = self._connection, len(self.ready)
        place, patience = connection.place, connection.patience
        before, self._looked = self._looked, time.monotonic()
        passed = min(self._looked - before, MOMENT)
        while self._news:
            connection.say(self._news.popleft())
        heard, connection.heard = connection.heard, False
        self._scheduler.look(
            passed,
            heard,
            f"The scheduler at {place} is back.",
            f"The scheduler at {place} does not answer: waiting for it up to {patience:.0f} "
            "seconds (Ctrl-C stops and saves).",
            f"the scheduler at {place} has not answered: start it again, and add --resume to "
            "continue, with any --cluster or without one.",
        )
        if self._scheduler.seconds > SOON:
            return
        left_out = [worker.left_out for worker in list(self._workers.values())]
        if left_out and all(left_out):
            raise BotschoolError(
                f"No worker at {place} can take part: {left_out[0]} Correct that, and add --resume."
            )
        start = f"start one with 'dask worker {connection.address}'"
        away = f"No workers at {place} yet: {start} (waiting up to {patience:.0f} seconds)."
        self._others.look(
            passed,
            bool(ready),
            f"{counted(ready, 'worker')} at {place}.",
            "" if left_out else away,
            f"no worker at {place} has taken part: {start}, and add --resume to continue.",
        )

    def _begin(self, batch: Batch | None) -> None:
        self._batch = batch
        self._work.set()

    async def _follow(self) -> None:
        """Serve the workers that are there."""
        while True:
            members = await self._connection.members()
            if members is not None:
                for address in self._workers.keys() - members.keys():
                    self._workers.pop(address).serving.cancel()
                for address in members.keys() - self._workers.keys():
                    worker = self._workers[address] = Worker(address, members[address])
                    worker.serving = asyncio.ensure_future(self._serve(worker))
            self._work.set()  # a chunk may be late now
            await asyncio.sleep(ASKING)

    async def _serve(self, worker: Worker) -> None:
        """Ask a worker what it is, and give it chunks if it can take part."""
        submit = self._connection.submit
        try:
            worker.left_out = self._differs(await submit(worker.address, remote.hello, self._asked))
            worker.ready = not worker.left_out
            await asyncio.gather(*(self._lane(worker) for _ in range(DEPTH)))
        except Lost:
            pass
        except Exception as error:
            worker.left_out = f"it says: {said(error)}."
        finally:
            worker.ready = False
            if worker.left_out:
                self._news.append(f"Worker {worker.address} is left out: {worker.left_out}")
            else:  # if it is still there, it is greeted again
                self._workers.pop(worker.address, None)

    def _differs(self, answer: Any) -> str:
        """Return why a worker cannot take part; "" if it can."""
        version = answer.get("version") if isinstance(answer, dict) else "of another version"
        if version != __version__:
            return f"it has botschool {version}, and this is {__version__}: install the same."
        if files := answer["differs"]:
            others = f" (and {counted(len(files) - 1, 'other file')})" if len(files) > 1 else ""
            return (
                f"its {files[0]}{others} differs from this machine's: install the same files there "
                "and start the worker again."
            )
        if self._bits not in (None, answer["bits"]):
            return (
                "it computes other bits than this machine: install the same botschool, numpy and "
                "environments."
            )
        return ""

    async def _lane(self, worker: Worker) -> None:
        """Give a worker one chunk after another."""
        while worker.ready:
            batch = self._batch
            chunk = self._next(worker, batch) if batch else None
            if batch is None or chunk is None:
                self._work.clear()
                await self._work.wait()
                continue
            count = chunk.stop - chunk.start
            worker.ahead += count
            try:
                outcome, seconds = await self._connection.submit(
                    worker.address,
                    remote.evaluate,
                    self._asked["experiment"],
                    *batch.arguments(chunk),
                )
                if isinstance(outcome, BotschoolError):
                    batch.fail(outcome)
                    continue
                self.busy += seconds
                worker.measured(count, int(outcome.steps.sum()), seconds)
                batch.enter(chunk, outcome)
            finally:
                worker.ahead -= count
                batch.give_back(chunk)  # unless it is done
                self._work.set()

    def _next(self, worker: Worker, batch: Batch) -> slice | None:
        """Return a chunk for this worker, or one that another worker should have finished."""
        if batch.over.is_set():
            return None
        if batch.waiting:
            chunk: slice | None = batch.take(self._size(worker, batch.untaken))
        elif worker.ahead:
            return None
        else:
            batch.idle.setdefault(worker.address, time.monotonic())
            chunk = batch.late()
        if chunk is not None:
            ahead = worker.ahead + chunk.stop - chunk.start
            batch.sent(chunk, max(SOONEST, LATE * ahead / worker.pace) if worker.pace else UNKNOWN)
        return chunk

    def _size(self, worker: Worker, untaken: int) -> int:
        """Return the size of a worker's next chunk, so that all workers end together."""
        ready = self.ready
        if worker.pace:
            share = worker.pace / sum(each.pace for each in ready)
            left = (untaken + sum(each.ahead for each in ready)) * share - worker.ahead
            count = max(SHARE * left, self._least * worker.pace)
        else:
            count = FIRST * untaken / len(ready)
        lanes = LANES * worker.threads if self._native else 1
        return max(1, round(count / lanes)) * lanes


def counted(number: int, what: str) -> str:
    """Return the number and the word, in the plural unless the number is one."""
    return f"{number} {what}" if number == 1 else f"{number} {what}s"
