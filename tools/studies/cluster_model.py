"""How long a generation takes on a cluster, from constants that were measured: evaluation, wire,
stragglers, algorithm.

Episodes are dealt out by the very rule of botschool.cluster.chunks, each worker plays them in its
lanes as the engine does, and the command and Dask's scheduler spend their time on each chunk, one
after another. What is simulated is time alone; the lengths of the episodes are measured ones.
"""

from __future__ import annotations

import heapq
import math
from collections import deque
from dataclasses import dataclass, replace

import numpy as np

from botschool.cluster.chunks import Batch, Pace, size
from botschool.cluster.dispatch import DEPTH, Worker
from botschool.problems import Episodes


@dataclass(frozen=True)
class Load:
    """A generation of an experiment, as it was measured on one core."""

    steps: np.ndarray
    """Lengths of episodes of its generations, to draw from."""
    episodes: int
    """Of a generation, or of a side's turn."""
    post: int
    """Episodes of a post-evaluation that is apart from it and follows it."""
    candidates: int
    parameters: int
    step: float
    """Seconds of a step of all lanes of a thread, of which there are `lanes`."""
    lanes: int
    algorithm: float
    """Seconds of the command for each generation, for the number of candidates that it has."""
    each: float
    """And for each more candidate."""
    drawing: float
    """Seconds in which one normal number is drawn."""

    @property
    def evaluation(self) -> float:
        """Seconds on one core."""
        whole = makespan(self.of(self.episodes, np.random.default_rng(1)), self.lanes)
        if self.post:
            whole += makespan(self.of(self.post, np.random.default_rng(2)), self.lanes)
        return whole * self.step

    def of(self, episodes: int, rng: np.random.Generator) -> np.ndarray:
        """So many lengths."""
        return rng.choice(self.steps, episodes)

    def larger(self, factor: int) -> Load:
        """With so many times the candidates."""
        more = (factor - 1) * self.candidates
        return replace(
            self,
            episodes=self.episodes * factor,
            candidates=self.candidates * factor,
            algorithm=self.algorithm + more * self.each,
        )


@dataclass(frozen=True)
class Wire:
    """What it costs to send a chunk and to get its answer."""

    chunk: float
    """Seconds that command and scheduler work for a chunk, one after another for all of them."""
    there: float
    """Seconds that a worker works for a chunk besides its evaluation."""
    latency: float
    """Seconds between a chunk's being sent and its start, and its end and its arrival, together."""
    bandwidth: float = 1.25e8
    """Bytes a second out of the command's machine."""


@dataclass
class Times:
    """Seconds of a generation, whose sum is `whole`, and the number of its chunks."""

    evaluation: float
    """All work, spread evenly over all cores."""
    stragglers: float
    """What the last chunks, lanes that run empty and waiting workers add."""
    wire: float
    algorithm: float
    chunks: int

    @property
    def whole(self) -> float:
        return self.evaluation + self.stragglers + self.wire + self.algorithm


def makespan(steps: np.ndarray, lanes: int) -> int:
    """Steps until all episodes are done, each taken by the first lane that is free."""
    if len(steps) <= lanes:
        return int(steps.max(initial=0))
    free = steps[:lanes].tolist()
    heapq.heapify(free)
    for each in steps[lanes:].tolist():
        heapq.heapreplace(free, free[0] + each)
    return max(free)


def generation(load: Load, wire: Wire, workers: int, threads: int = 1, cores=math.inf) -> Times:
    """Of one generation on so many workers of so many threads.

    cores: that all of them, the command and the scheduler share; else each has its own.
    """
    rng = np.random.default_rng(1)
    given = (load, wire, workers, threads, cores)
    times = _batch(load.of(load.episodes, rng), *given)
    if load.post:
        post = _batch(load.of(load.post, rng), *given)
        times.evaluation += post.evaluation
        times.stragglers += post.stragglers
        times.wire += post.wire
        times.chunks += post.chunks
    return times


def _batch(steps: np.ndarray, load: Load, wire: Wire, workers: int, threads, cores) -> Times:
    """Of one batch; its `algorithm` is the whole generation's."""
    n, lanes = len(steps), load.lanes * threads
    dealt = Batch([], None, Episodes.of(np.zeros(n, dtype=np.uint64), 1), 1)
    speed = lanes / (steps.mean() * load.step)
    paces = [Pace(threads, episodes=speed, steps=speed) for _ in range(workers)]
    work, dispatch = _Sharing(cores), _Dispatch(load, dealt, paces)
    chunks, latest = 0, 0.0
    arriving: list[tuple] = []  # (moment, number, worker, chunk, or None for an answer)
    while True:
        if "command" not in work.jobs and (given := dispatch.next(work.now)):
            chunks += 1
            first = 0.0 if dispatch.met(given[0]) else 8 * load.parameters / wire.bandwidth
            work.add("command", wire.chunk + first, 1)
        if not work.jobs and not arriving:
            break
        ended = work.run(arriving[0][0] if arriving else math.inf)
        latest = work.now
        if ended == "command":
            heapq.heappush(arriving, (work.now + wire.latency / 2, chunks, *given))
        elif ended is not None:  # a worker has finished a chunk
            heapq.heappush(arriving, (work.now + wire.latency / 2, chunks, ended, None))
            dispatch.queued[ended].popleft()
        else:
            _, _, worker, chunk = heapq.heappop(arriving)
            if chunk is None:
                dispatch.answered(worker, work.now)
                continue
            directions = (chunk.stop - chunk.start) * load.candidates / n / 2
            fresh = directions * load.parameters * load.drawing
            seconds = makespan(steps[chunk], lanes) * load.step + fresh + wire.there
            dispatch.queued[worker].append(seconds)
        for worker, waiting in enumerate(dispatch.queued):
            if waiting and worker not in work.jobs:
                work.add(worker, waiting[0], threads)
    evaluation = makespan(steps, load.lanes) * load.step / min(workers * threads, cores)
    rest = max(0.0, latest - evaluation)
    sending = min(rest, chunks * wire.chunk + wire.latency)
    return Times(evaluation, rest - sending, sending, load.algorithm, chunks)


class _Dispatch:
    """Who gets the next chunk: as botschool.cluster.dispatch does it, who has least."""

    def __init__(self, load: Load, batch: Batch, paces: list[Pace]) -> None:
        self._native, self._batch, self._paces = load.lanes > 1, batch, paces
        self._workers = [Worker(str(number), pace) for number, pace in enumerate(paces)]
        self.queued: list[deque[float]] = [deque() for _ in paces]
        """Seconds of the chunks that have arrived at each worker."""
        self._known: set[int] = set()

    def met(self, number: int) -> bool:
        """Whether a worker has been given something before."""
        before = number in self._known
        self._known.add(number)
        return before

    def next(self, now: float) -> tuple[int, slice] | None:
        """A worker with room, and its chunk."""
        worker = min(self._workers, key=lambda each: len(each.tasks))
        if not self._batch.waiting or len(worker.tasks) >= DEPTH:
            return None
        number, ahead = int(worker.address), [each.ahead(now) for each in self._workers]
        chunk = self._batch.take(size(self._batch, number, self._paces, ahead, self._native))
        worker.tasks[chunk.start] = worker.task(self._batch, chunk, None, now)
        return number, chunk

    def answered(self, number: int, now: float) -> None:
        """A worker has done the oldest of its chunks, and begun the next one."""
        tasks = self._workers[number].tasks
        del tasks[next(iter(tasks))]
        for following in list(tasks.values())[:1]:
            following.since = now


class _Sharing:
    """Jobs that go on at once; more of them than cores get an equal share each."""

    def __init__(self, cores: float) -> None:
        self._cores = cores
        self.now = 0.0
        self.jobs: dict = {}
        """What is left of each, in seconds, and the threads that it keeps busy."""

    def add(self, name, seconds: float, threads: int) -> None:
        self.jobs[name] = [seconds, threads]

    def run(self, until: float):
        """Goes on to the first end of a job, and gives its name; or to a moment, and gives None."""
        busy = sum(threads for _, threads in self.jobs.values())
        pace = min(1.0, self._cores / busy) if busy else 1.0
        name, left = min(
            ((name, job[0]) for name, job in self.jobs.items()),
            key=lambda pair: pair[1],
            default=(None, math.inf),
        )
        if self.now + left / pace > until:
            name, passed = None, until - self.now
        else:
            passed = left / pace
        self.now += passed
        for job in self.jobs.values():
            job[0] = max(0.0, job[0] - passed * pace)
        if name is not None:
            del self.jobs[name]
        return name
