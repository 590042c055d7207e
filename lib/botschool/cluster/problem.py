"""Evaluate a problem's episodes on a cluster, with the same outcome as here."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

import dask
import numpy as np

from botschool import problems
from botschool.cluster import files, wire
from botschool.cluster.bottleneck import Bottleneck
from botschool.cluster.chunks import LEAST, Batch
from botschool.cluster.connection import Connection
from botschool.cluster.dispatch import Crew, counted
from botschool.cluster.worker import bits
from botschool.config import Experiment, to_dict
from botschool.policies.hyperparameters import PolicyConfig
from botschool.policies.policy import Policy
from botschool.problems import Episodes, Interrupted, Outcome, Problem
from botschool.problems.transition import Transition

DECLARED = tuple(name for name in Problem.__annotations__ if not name.startswith("_"))
"""Attributes that a problem declares."""
KEPT = 0.3
"""Weight of the newest batch in the estimated duration of an episode."""


class Distributed(Problem):
    """Evaluates on the workers of a connection.

    This machine keeps batches that it evaluates in less time than a message takes, and the rest of
    the work after the user has asked to stop.
    """

    def __init__(
        self,
        experiment: Experiment,
        connection: Connection,
        patience: float,
        say: Callable[[str], None],
    ) -> None:
        with files.noticing():
            self._inner = inner = problems.of(experiment)
            same = bits(experiment)
        for name in DECLARED:
            setattr(self, name, getattr(inner, name))
        if not self.native and same != bits(experiment):
            same = None  # it never gives the same result twice: there is nothing to compare
        self._shortest = float(dask.config.get("botschool.shortest", LEAST))
        """Shortest batch for the workers, and shortest chunk, in seconds."""
        self._single = inner.native and not inner.interface.morphology
        """Whether evaluation rounds genotypes to single precision anyway."""
        self._stopped = False
        self._seconds: float | None = None
        """Seconds of an episode on one core."""
        self.watch = Bottleneck()
        self._connection = connection
        setup = wire.pack(to_dict(experiment))
        self._crew = Crew(
            connection,
            setup,
            files.manifest(inner),
            same,
            self.native,
            self._shortest,
            patience,
            say,
            self.watch,
        )

    def policy(self, config: PolicyConfig) -> Policy:
        """See Problem.policy."""
        return self._inner.policy(config)

    def rows(self, *parts: np.ndarray) -> Any:
        """Return the parts unchanged: each is sent in its own way."""
        return parts

    def evaluate(
        self,
        policy: Policy,
        genotypes: np.ndarray | tuple[np.ndarray, ...],
        normalisation: np.ndarray | None,
        episodes: Episodes,
        maxsteps: int,
        workers: int = 1,
        stopping: Callable[[], bool] = lambda: False,
    ) -> Outcome:
        """See Problem.evaluate; genotypes may come from `rows`, and `workers` has no effect."""
        parts = list(genotypes) if isinstance(genotypes, tuple) else [genotypes]
        if self._short(len(episodes)):
            return self._here(policy, parts, normalisation, episodes, maxsteps, stopping)
        batch = Batch(parts, normalisation, episodes, maxsteps, self._single)
        before = self.watch.busy
        try:
            self._crew.evaluate(batch, stopping)
        except Interrupted:
            self._stopped = True
            raise
        self.watch.candidates += sum(map(len, parts))
        threads = max((worker.pace.threads for worker in self._crew.ready), default=1)
        self._learn((self.watch.busy - before) * (threads if self.native else 1), len(episodes))
        return batch.outcome()

    def _short(self, count: int) -> bool:
        if self._connection.lost:
            self._connection.refresh()  # raises a failure of the connection
        return self._stopped or (
            self._seconds is not None and self._seconds * count < self._shortest
        )

    def _here(self, policy, parts, normalisation, episodes, maxsteps, stopping) -> Outcome:
        began = time.monotonic()
        rows = parts[0] if len(parts) == 1 else np.concatenate(parts)
        outcome = self._inner.evaluate(policy, rows, normalisation, episodes, maxsteps, 1, stopping)
        seconds = time.monotonic() - began
        self.watch.here += seconds
        self._learn(seconds, len(episodes))
        return outcome

    def _learn(self, seconds: float, episodes: int) -> None:
        now = seconds / max(1, episodes)
        before = now if self._seconds is None else self._seconds
        self._seconds = (1 - KEPT) * before + KEPT * now

    def play(
        self,
        policy: Policy,
        genotype: np.ndarray,
        normalisation: np.ndarray | None,
        seed: int,
        episode: int,
        maxsteps: int,
        render: bool = False,
    ) -> Iterator[Transition]:
        """Play on this machine."""
        return self._inner.play(policy, genotype, normalisation, seed, episode, maxsteps, render)

    def status(self) -> str:
        """Return the workers and their speed, for a progress bar."""
        ready = self._crew.ready
        speed = sum(worker.pace.steps for worker in ready)
        return f"{counted(len(ready), 'worker')} {_speed(speed)}" if speed else ""

    def report(self) -> list[str]:
        """Return sentences for the end: each worker's speed, and how the time was spent."""
        lines = [
            f"worker {worker.address}: {_speed(worker.pace.steps)}"
            for worker in self._crew.ready
            if worker.pace.steps
        ]
        if line := self.watch.line():
            lines.append(line)
        if self.watch.here > self.watch.busy:
            lines.append(
                f"batches of episodes shorter than {1000 * self._shortest:.0f} ms were evaluated "
                f"on this machine alone ({self.watch.here:.1f} s): they gain nothing by a cluster"
            )
        return lines

    def close(self) -> None:
        """End what evaluation has started on this machine."""
        self._inner.close()


def _speed(steps: float) -> str:
    size, letter = (1e6, "M") if steps >= 1e6 else (1e3, "k")
    return f"{steps / size:.3g} {letter} steps/s"
