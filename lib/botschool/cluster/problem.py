"""Evaluate a problem's episodes on a cluster, with the same outcome as here."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from typing import Any

import dask
import numpy as np

from botschool import problems
from botschool.cluster import files
from botschool.cluster import worker as remote
from botschool.cluster.chunks import Batch
from botschool.cluster.connection import Connection
from botschool.cluster.crew import Crew, counted
from botschool.config import Experiment, to_dict
from botschool.policies.hyperparameters import PolicyConfig
from botschool.policies.policy import Policy
from botschool.problems import Episodes, Interrupted, Outcome, Problem
from botschool.problems.transition import Transition

DECLARED = tuple(name for name in Problem.__annotations__ if not name.startswith("_"))
"""Attributes that a problem declares."""
KEPT = 0.3
"""Weight of the newest batch in the estimated duration of an episode."""
LEAST = 0.05
"""Shortest duration of a batch for the workers, and of a chunk, in seconds, as estimated."""


class Distributed(Problem):
    """Evaluates on the workers of a connection.

    This machine keeps batches that it evaluates in less time than a message takes, and the rest of
    the work after the user has asked to stop.
    """

    def __init__(self, experiment: Experiment, connection: Connection) -> None:
        with files.noticing():
            self._inner = inner = problems.of(experiment)
            same = remote.bits(experiment)
        for name in DECLARED:
            setattr(self, name, getattr(inner, name))
        if not self.native and same != remote.bits(experiment):
            same = None  # it never gives the same result twice: there is nothing to compare
        self._shortest = float(dask.config.get("botschool.shortest", LEAST))
        # evaluation rounds native genotypes to single precision anyway
        single = inner.native and not inner.interface.morphology
        self._type = np.float32 if single else np.float64
        self._stopped = False
        self._seconds: float | None = None
        """Seconds of an episode on one core."""
        sent = to_dict(experiment)
        if inner.robot is not None:  # its file is here
            sent["exp"]["options"] = inner.robot.carried(experiment.exp.options)
        asked = {"experiment": json.dumps(sent), "files": files.manifest(inner)}
        self._crew = Crew(connection, asked, same, self.native, self._shortest)
        self._here = self._inside = self._outside = self._idle = 0.0
        """Seconds: of batches evaluated here; of workers in, between and at the end of batches."""
        self._ended = time.monotonic()

    def policy(self, config: PolicyConfig) -> Policy:
        """See Problem.policy."""
        return self._inner.policy(config)

    def evaluate(
        self,
        policy: Policy,
        genotypes: np.ndarray,
        normalisation: np.ndarray | None,
        episodes: Episodes,
        maxsteps: int,
        workers: int = 1,
        stopping: Callable[[], bool] = lambda: False,
    ) -> Outcome:
        """See Problem.evaluate; `workers` has no effect."""
        began, count = time.monotonic(), len(episodes)
        if self._stopped or (self._seconds and self._seconds * count < self._shortest):
            outcome = self._inner.evaluate(
                policy, genotypes, normalisation, episodes, maxsteps, 1, stopping
            )
            self._here += time.monotonic() - began
            self._learn(time.monotonic() - began, count)
            return outcome
        batch = Batch(genotypes.astype(self._type), normalisation, episodes, maxsteps)
        before, ready = self._crew.busy, len(self._crew.ready)
        try:
            self._crew.evaluate(batch, stopping)
        except Interrupted:
            self._stopped = True
            raise
        self._outside += (began - self._ended) * ready
        self._ended = time.monotonic()
        self._inside += (self._ended - batch.began) * len(self._crew.ready)
        self._idle += sum(self._ended - since for since in batch.idle.values())
        threads = max((worker.threads for worker in self._crew.ready), default=1)
        self._learn((self._crew.busy - before) * (threads if self.native else 1), count)
        return batch.outcome()

    def _learn(self, seconds: float, episodes: int) -> None:
        now = seconds / max(1, episodes)
        before = now if self._seconds is None else self._seconds
        self._seconds = (1 - KEPT) * before + KEPT * now

    def play(self, *arguments: Any, **options: Any) -> Iterator[Transition]:
        """Play on this machine."""
        return self._inner.play(*arguments, **options)

    def status(self) -> str:
        """Return the workers and their speed, for a progress bar."""
        ready = self._crew.ready
        speed = sum(worker.steps for worker in ready)
        return f"{counted(len(ready), 'worker')} {_speed(speed)}" if speed else ""

    def report(self) -> list[str]:
        """Return sentences for the end: each worker's speed, and how the time was spent."""
        lines = [
            f"worker {worker.address}: {_speed(worker.steps)}"
            for worker in self._crew.ready
            if worker.steps
        ]
        if busy := self._crew.busy:
            parts = {
                "evaluation": busy,
                "waiting for the slowest chunk": self._idle,
                "wire": max(0.0, self._inside - busy - self._idle),
                "algorithm and files": self._outside,
            }
            total = sum(parts.values())
            said = ", ".join(f"{name} {100 * part / total:.0f} %" for name, part in parts.items())
            lines.append(f"time of the workers: {said}")
        if self._here > busy:
            lines.append(
                f"batches of episodes shorter than {1000 * self._shortest:.0f} ms were evaluated "
                f"on this machine alone ({self._here:.1f} s): they gain nothing by a cluster"
            )
        return lines

    def close(self) -> None:
        """End what evaluation has started on this machine."""
        self._inner.close()


def _speed(steps: float) -> str:
    size, letter = (1e6, "M") if steps >= 1e6 else (1e3, "k")
    return f"{steps / size:.3g} {letter} steps/s"
