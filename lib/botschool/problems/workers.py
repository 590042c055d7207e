"""Run the episodes of Python problems in worker processes."""

from __future__ import annotations

import itertools
import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import Any

import numpy as np

from botschool.errors import BotschoolError, Option
from botschool.policies.hyperparameters import PolicyConfig
from botschool.problems.base import (
    Episodes,
    Interrupted,
    Outcome,
    say_unrepeatable,
    vectors_of,
)

# Chunks per worker in a batch: enough to even out long episodes.
CHUNKS = 10
# How often workers may die without finishing a single chunk.
PATIENCE = 3


class Workers:
    """A pool of processes, each with its own environment and network.

    The number of a chunk decides which worker gets it, so that an environment that keeps something
    in its process gives the same results in each run. If a worker dies, all are replaced and what
    is missing runs again. Episodes are pure functions of their inputs, so the outcome is the same.
    """

    def __init__(self, made: dict[str, Any], config: PolicyConfig, workers: int) -> None:
        """Prepare the pool; made: arguments of botschool.problems.make."""
        self._name = made["name"]
        self._arguments = (made, config)
        self._workers = workers
        self._pools: list[ProcessPoolExecutor] = []
        """A pool of one process for each worker."""
        self._fresh: bool | None = None
        """What the first two workers found out for all: see PythonProblem.fresh."""

    def evaluate(
        self,
        genotypes: np.ndarray,
        normalisation: np.ndarray | None,
        episodes: Episodes,
        maxsteps: int,
        stopping: Callable[[], bool],
    ) -> Outcome:
        """See Problem.evaluate."""
        count = min(len(episodes), self._workers * CHUNKS)
        edges = np.linspace(0, len(episodes), count + 1).astype(int).tolist()
        chunks = [slice(a, b) for a, b in itertools.pairwise(edges)]
        done: dict[int, Outcome] = {}
        deaths = 0
        while len(done) < len(chunks):
            before = len(done)
            try:
                self._run(chunks, done, genotypes, normalisation, episodes, maxsteps, stopping)
            except BrokenProcessPool:
                self.close()
                deaths = 0 if len(done) > before else deaths + 1
                if deaths == PATIENCE:
                    raise BotschoolError(
                        f"The worker processes of {self._name} died {PATIENCE} times in a row; ",
                        Option("run with -w 1", "use workers=1"),
                        " to see why, or fewer workers if memory is short.",
                    ) from None
        outcomes = [done[i] for i in range(len(chunks))]
        moments = None
        if episodes.collect is not None:
            moments = np.concatenate([outcome.moments for outcome in outcomes])
        return Outcome(
            np.concatenate([outcome.fitness for outcome in outcomes], axis=-1),
            np.concatenate([outcome.steps for outcome in outcomes]),
            moments,
        )

    def _run(self, chunks, done, genotypes, normalisation, episodes, maxsteps, stopping) -> None:
        if not self._pools:
            context = multiprocessing.get_context("spawn")
            self._pools = [
                ProcessPoolExecutor(1, context, _start, self._arguments)
                for _ in range(self._workers)
            ]
        if self._fresh is None:
            with _unheard(signal.SIGINT):
                settling = [pool.submit(_settle) for pool in self._pools[:2]]
            while wait(settling, timeout=0.2).not_done:
                if stopping():
                    self.close()
                    raise Interrupted
            (fresh, some), (also, others) = (each.result() for each in settling)
            self._fresh = fresh or also
            if some is None or some != others:
                say_unrepeatable(self._name)
        running = {}
        for i, chunk in enumerate(chunks):
            if i in done:
                continue
            chosen = episodes.select(chunk)
            shape = chosen.candidate.shape
            used, places = np.unique(chosen.candidate, return_inverse=True)
            chosen.candidate = places.reshape(shape)
            vectors = vectors_of(normalisation, used)
            with _unheard(signal.SIGINT):  # only the main process handles Ctrl-C
                future = self._pools[i % self._workers].submit(
                    _evaluate, self._fresh, genotypes[used], vectors, chosen, maxsteps
                )
            running[future] = i
        while running:
            finished, _ = wait(running, timeout=0.2, return_when=FIRST_COMPLETED)
            for future in finished:
                done[running.pop(future)] = future.result()
            if stopping():
                self.close()
                raise Interrupted

    def close(self) -> None:
        """End the processes without waiting for unfinished episodes."""
        for pool in self._pools:
            for process in list((pool._processes or {}).values()):
                process.terminate()
        # Wait for a pool's own thread: at the program's end, CPython would wake it through a pipe
        # that the thread may be closing at that moment.
        for pool in self._pools:
            pool.shutdown(wait=True, cancel_futures=True)
        self._pools = []


_worker: tuple | BotschoolError | None = None


def _start(made: dict[str, Any], config: PolicyConfig) -> None:
    global _worker
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()
    from botschool import problems

    try:
        problem = problems.make(**made)
        _worker = (problem, problem.policy(config))
    except BotschoolError as error:  # the first evaluation reports it
        _worker = error


def _end_with_parent() -> None:
    multiprocessing.parent_process().join()
    os._exit(1)


@contextmanager
def _unheard(number: int) -> Iterator[None]:
    """Hold back this signal within the block, in new processes, too; deliver it at the end."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {number})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _made() -> tuple[Any, Any]:
    if isinstance(_worker, BotschoolError):
        raise _worker
    assert _worker is not None
    return _worker


def _settle() -> tuple[bool, dict[int, bytes] | None]:
    """Return whether every episode gets a new environment, and what PythonProblem.settle does."""
    problem, policy = _made()
    seen = problem.settle(policy)
    return problem.fresh, seen


def _evaluate(
    fresh: bool, genotypes: np.ndarray, normalisation, episodes: Episodes, maxsteps: int
) -> Outcome:
    problem, policy = _made()
    if problem.fresh != fresh:
        problem.begin(fresh)
    return problem.evaluate(policy, genotypes, normalisation, episodes, maxsteps)
