"""Assign work to workers: send chunks, receive answers, replace lost and late workers."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from botschool import __version__
from botschool.cluster import answers, wire
from botschool.cluster import worker as remote
from botschool.cluster.bottleneck import Bottleneck
from botschool.cluster.chunks import Batch, Pace, size
from botschool.cluster.connection import Connection
from botschool.cluster.files import Manifest
from botschool.cluster.members import Task, Worker
from botschool.errors import BotschoolError
from botschool.problems import Interrupted

DEPTH = 2
"""Chunks that a worker has at a time, so that it need not wait for the next one."""
TICK = 0.2
"""Seconds between two checks for new, lost and late workers."""
LATE = 3.0
"""A chunk is late after this many times its expected duration ..."""
SOONEST = 1.0
"""... and this many seconds; then an idle worker gets it, too."""
FAILURES = 5
"""Failures in a row after which a worker is left out."""
UNREADABLE = "its answer cannot be read"
HELLO = ("sentence", "failure", "version")
OUTCOME = ("sentence", "failure", "lacks", "fitness")
"""Kinds of answers to a greeting, and to a chunk."""
LOSSES = 10
"""Losses of a chunk with its worker after which evaluation stops."""


class Crew:
    """The workers of a connection, for one experiment."""

    def __init__(
        self,
        connection: Connection,
        setup: bytes,
        files: Manifest,
        bits: bytes | None,
        native: bool,
        least: float,
        patience: float,
        say: Callable[[str], None],
        watch: Bottleneck,
    ) -> None:
        """Prepare workers; setup: the experiment as a table; files: the files that each worker must
        have; bits: the bits that each must compute, None if unknown; least: seconds that a chunk
        should take.
        """
        self._connection = connection
        self._setup, self._name = setup, wire.digest(setup)
        self._files, self._bits, self._native, self._least = files, bits, native, least
        self._patience, self._say, self._watch = patience, say, watch
        self.workers: dict[str, Worker] = {}
        self._tasks: dict[int, Task | Worker] = {}
        self._alone_since: float | None = None
        self._told = False

    @property
    def ready(self) -> list[Worker]:
        """Return the workers that take part."""
        return [worker for worker in self.workers.values() if worker.ready]

    def evaluate(self, batch: Batch, stopping: Callable[[], bool]) -> None:
        """Evaluate every episode of a batch. Raises Interrupted or BotschoolError."""
        self._alone_since = None
        self._watch.begin()
        try:
            looked = 0.0
            while batch.left:
                now = time.monotonic()
                if now - looked >= TICK:
                    if stopping():
                        raise Interrupted
                    self._look(batch)
                    looked = now
                self._give(batch)
                self._hear()
        except BaseException:
            self.forget()
            raise
        finally:
            self._watch.end(len(self.ready))

    def forget(self) -> None:
        """Take back all chunks.

        Workers that have not answered their greeting will be greeted again.
        """
        for number in self._tasks:
            self._connection.forget(number)
        self._tasks.clear()
        self.workers = {a: w for a, w in self.workers.items() if w.ready or w.left_out}
        for worker in self.workers.values():
            worker.tasks.clear()

    def _look(self, batch: Batch) -> None:
        """Update the workers: new ones, lost ones, and whether any is left."""
        self._connection.refresh()
        members = self._connection.members
        for address, threads in members.items():
            if address not in self.workers:
                self.workers[address] = worker = Worker(address, Pace(threads))
                self._greet(worker)
        for address in self.workers.keys() - members.keys():
            self._gone(self.workers.pop(address))
        if not self._connection.answering:
            self._alone_since = None
            return
        if self.ready:
            self._alone_since = None
            if self._told:
                self._told = False
                self._say(f"{counted(len(self.ready), 'worker')} at {self._connection.place}.")
            self._help(batch)
            return
        self._alone()

    def _alone(self) -> None:
        """Wait for a while, because no worker can take a chunk."""
        self._watch.nobody()
        place, left_out = self._connection.place, [w.left_out for w in self.workers.values()]
        if left_out and all(left_out):
            raise BotschoolError(
                f"No worker at {place} can take part: {left_out[0]} Correct that, and add --resume."
            )
        now = time.monotonic()
        self._alone_since = self._alone_since or now
        away = now - self._alone_since
        if away > self._patience:
            raise BotschoolError(
                f"For {away:.0f} seconds no worker at {place} has taken part: start one with "
                f"'dask worker {self._connection.address}', and add --resume to continue."
            )
        if away > 3 and not self._told and not self.workers:
            self._told = True
            self._say(
                f"No workers at {place} yet: start one with 'dask worker "
                f"{self._connection.address}' (waiting up to {self._patience:.0f} seconds)."
            )

    def _greet(self, worker: Worker) -> None:
        """Send a greeting: a worker must say what it is."""
        request = {"experiment": self._name, "needs": [self._name], "files": self._files}
        message = wire.pack({**request, "tables": {self._name: self._setup}})
        worker.greeting = self._send(remote.hello, worker, message)
        self._tasks[worker.greeting] = worker

    def _send(self, function: Callable, worker: Worker, message: bytes) -> int:
        self._watch.sent += len(message)
        return self._connection.submit(function, worker.address, message)

    def _gone(self, worker: Worker) -> None:
        """Give a lost worker's chunks to others and expect no more answers from it."""
        tasks, worker.tasks = worker.tasks, {}
        for number in (*tasks, worker.greeting):
            self._tasks.pop(number, None)
            self._connection.forget(number)
        for task in tasks.values():
            self._lost(task)

    def _lost(self, task: Task) -> None:
        """Take back a chunk that will get no outcome from this task."""
        if self._elsewhere(task) or task.batch.done(task.chunk):
            return
        if task.batch.give_back(task.chunk) >= LOSSES:
            raise BotschoolError(
                f"Workers at {self._connection.place} were lost {LOSSES} times with the same "
                "episodes: look at their output, or run with -w 1 to see why."
            )

    def _elsewhere(self, task: Task) -> bool:
        """Return whether another worker has the same chunk."""
        return any(
            isinstance(other, Task)
            and other is not task
            and other.batch is task.batch
            and other.chunk == task.chunk
            for other in self._tasks.values()
        )

    def _give(self, batch: Batch) -> None:
        """Give chunks to all workers that have room, first to the workers with the fewest."""
        if not batch.waiting:
            return
        now, ready = time.monotonic(), self.ready
        paces, ahead = [worker.pace for worker in ready], [worker.ahead(now) for worker in ready]
        for room in range(DEPTH):
            for number, worker in enumerate(ready):
                if batch.waiting and len(worker.tasks) <= room and not worker.behind:
                    count = size(batch, number, paces, ahead, self._native, self._least)
                    chunk = batch.take(count)
                    ahead[number] += chunk.stop - chunk.start
                    self._assign(worker, batch, chunk, batch.message(chunk))

    def _assign(self, worker: Worker, batch: Batch, chunk: slice, message) -> Task:
        task = worker.task(batch, chunk, message, time.monotonic())
        self._submit(task)
        return task

    def _submit(self, task: Task) -> None:
        """Send a chunk, with the tables that its worker lacks."""
        worker, (request, tables) = task.worker, task.message
        tables = {self._name: self._setup, **tables}
        lacking = {name: data for name, data in tables.items() if name not in worker.holds}
        for name, data in lacking.items():
            worker.holds.put(name, len(data))
        worker.holds.use(tables)
        worker.holds.trim()
        message = wire.pack(
            {**request, "experiment": self._name, "needs": list(tables), "tables": lacking}
        )
        number = self._send(remote.evaluate, worker, message)
        worker.tasks[number] = self._tasks[number] = task

    def _help(self, batch: Batch) -> None:
        """Give late chunks to idle workers, too; the first answer counts."""
        if batch.waiting:
            return
        now = time.monotonic()
        idle = [worker for worker in self.ready if not worker.tasks]
        late = [
            task
            for task in self._tasks.values()
            if isinstance(task, Task)
            and task.batch is batch
            and not batch.done(task.chunk)
            and now > task.since + max(SOONEST, LATE * task.expected) * 2**task.copies
        ]
        for worker, task in zip(idle, sorted(late, key=lambda task: task.since), strict=False):
            copy = self._assign(worker, batch, task.chunk, task.message)
            task.copies += 1
            copy.copies = task.copies

    def _hear(self) -> None:
        """Take the answers that arrive within a moment."""
        heard = self._connection.answer(TICK)
        while heard:
            self._take(*heard)
            heard = self._connection.answer(0)

    def _take(self, number: int, answer: bytes | BaseException) -> None:
        task = self._tasks.pop(number, None)
        if task is None:  # its worker is lost
            return
        worker = task if isinstance(task, Worker) else task.worker
        worker.tasks.pop(number, None)
        if isinstance(answer, BaseException):
            content: dict[str, Any] = {
                "failure": f"{type(answer).__name__}: {' '.join(str(answer).split())}"
            }
        else:
            self._watch.received += len(answer)
            content = _read(answer, HELLO if isinstance(task, Worker) else OUTCOME)
        if isinstance(task, Worker):
            self._met(worker, content)
        elif "lacks" in content:
            for name in content["lacks"]:
                worker.holds.drop(name)
            self._submit(task)
        elif "sentence" in content:
            if task.batch.left and not task.batch.done(task.chunk):
                raise BotschoolError(content["sentence"])
        elif "failure" in content:
            self._failed(task, content["failure"])
        else:
            self._done(task, content)

    def _met(self, worker: Worker, answer: dict) -> None:
        """Take a worker's answer to its greeting."""
        worker.greeting = None
        said = answer.get("sentence") or answer.get("failure")
        # the worker or connection is lost: it will be greeted again
        if said and "Cancelled" in said:
            self.workers.pop(worker.address, None)
            return
        if "failure" in answer and worker.failures + 1 < FAILURES:
            worker.failures += 1
            self._greet(worker)
            return
        if said:
            worker.left_out = f"it says: {said.rstrip('.')}."
        elif answer["version"] != __version__:
            worker.left_out = (
                f"it has botschool {answer['version']}, and this is {__version__}: install the "
                "same."
            )
        elif answer["differs"]:
            worker.left_out = _differing(answer["differs"])
        elif self._bits not in (None, answer["bits"]):
            worker.left_out = (
                "it computes other bits than this machine: install the same botschool, numpy and "
                "environments."
            )
        else:
            worker.ready, worker.failures = True, 0
            worker.pace.threads = answer["threads"]
            worker.holds.put(self._name, len(self._setup))
            return
        self._say(f"Worker {worker.address} is left out: {worker.left_out}")

    def _failed(self, task: Task, said: str) -> None:
        """Take back a chunk whose task failed, although the environment did not."""
        worker = task.worker
        self._lost(task)
        if "Cancelled" in said or "KilledWorker" in said:  # the worker or connection is lost
            return
        worker.failures += 1
        if worker.failures >= FAILURES:
            worker.ready, worker.left_out = False, f"it says: {said.rstrip('.')}."
            self._say(f"Worker {worker.address} is left out: {worker.left_out}")

    def _done(self, task: Task, answer: dict) -> None:
        worker, batch, chunk = task.worker, task.batch, task.chunk
        if not batch.done(chunk):
            try:
                batch.enter(chunk, answer)
            except ValueError:
                self._failed(task, UNREADABLE)
                return
        worker.failures = 0
        steps = int(answer["steps"].sum())
        worker.pace.measured(chunk.stop - chunk.start, steps, answer["seconds"])
        self._watch.evaluated(answer["seconds"])
        now = time.monotonic()
        for following in list(worker.tasks.values())[:1]:
            following.since = now
        if not worker.tasks and not batch.waiting:
            self._watch.idle(worker.address, now)


def _read(answer: bytes, kinds: tuple[str, ...]) -> dict:
    """Return an answer of one of these kinds; a failure for anything else."""
    try:
        return answers.read(answer, kinds)
    except ValueError:
        return {"failure": UNREADABLE}


def _differing(names: list[str]) -> str:
    """Return the sentence about a worker with other files."""
    others = f" (and {counted(len(names) - 1, 'other file')})" if len(names) > 1 else ""
    return (
        f"its {names[0]}{others} differs from this machine's: install the same files there and "
        "start the worker again."
    )


def counted(number: int, what: str) -> str:
    """Return the number and the word, in the plural unless the number is one."""
    return f"{number} {what}" if number == 1 else f"{number} {what}s"
