"""Native problems: whole episodes in C++ (lib/arena), many at a time, on threads."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from botschool import _core
from botschool.policy import Interface, Policy
from botschool.problems.base import Episodes, Interrupted, Outcome, Problem
from botschool.problems.transition import Transition

_CORE = {info["name"]: info for info in _core.native_problems()}

NATIVE = {
    **{name: (name, info["limit"]) for name, info in _CORE.items()},
    "CartPole-v0": ("CartPole-v1", 200),
    "Pendulum-v0": ("Pendulum-v1", 200),
}
"""Name in experiment files -> (name in C++, longest episode)."""

# Stopping is possible between batches of about this many steps.
BATCH_STEPS = 20_000_000


class NativeProblem(Problem):
    """A problem whose dynamics are in C++.

    instruction_set: one of `_core.instruction_sets()`; "" is the best (all give the same bits).
    """

    native = True

    def __init__(self, name: str, instruction_set: str = "") -> None:
        self.name = name
        self.dynamics, self.limit = NATIVE[name]
        self._instruction_set = instruction_set
        self._engine: tuple[Policy, _core.Engine] | None = None
        info = _CORE[self.dynamics]
        self.fps = 1 / info["seconds"]
        self.interface = Interface(
            info["observations"],
            info["outputs"],
            info["discrete"],
            info["low"],
            info["high"],
            robots=info["robots"],
        )

    def engine(self, policy: Policy) -> _core.Engine:
        """The C++ engine for this problem and the policy's network."""
        if self._engine is None or self._engine[0] is not policy:
            engine = _core.Engine(self.dynamics, policy.spec.core(), self._instruction_set)
            self._engine = (policy, engine)
        return self._engine[1]

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
        limit = self.steps(maxsteps)
        batch = max(workers, BATCH_STEPS // limit)
        parts = []
        for first in range(0, len(episodes), batch):
            if stopping():
                raise Interrupted
            whole = len(episodes) <= batch
            part = episodes if whole else episodes.part(slice(first, first + batch))
            parts.append(
                self.engine(policy).evaluate(
                    genotypes,
                    normalisation,
                    np.atleast_2d(part.candidate),
                    part.seed,
                    part.episode,
                    part.collect,
                    limit,
                    workers,
                    bool(policy.config.heterogeneous),
                )
            )
        fitness, steps, moments = parts[0] if len(parts) == 1 else _concatenated(parts)
        if not np.isfinite(fitness).all():
            first = int(np.argmin(np.isfinite(fitness)))
            raise self.broken(
                f"a return of {fitness[first]}", episodes.seed[first], episodes.episode[first]
            )
        return Outcome(fitness, steps, moments)

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
        tape = self.engine(policy).record(
            np.atleast_2d(genotype),
            normalisation,
            seed,
            episode,
            self.steps(maxsteps),
            bool(policy.config.heterogeneous),
        )
        total = 0.0
        for t, reward in enumerate(tape["rewards"]):
            total += reward
            yield Transition(
                step=t + 1,
                reward=float(reward),
                total=total,
                observation=tape["observations"][t],
                action=tape["actions"][t],
                activations=tape["activations"][t],
                state=tape["states"][t + 1],
            )


def _concatenated(parts: list[tuple]) -> tuple:
    fitness, steps, moments = zip(*parts, strict=True)
    joined = None if moments[0] is None else np.concatenate(moments)
    return np.concatenate(fitness), np.concatenate(steps), joined
