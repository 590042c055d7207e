"""Evaluate native problems: whole episodes in C++ (lib/arena), many at a time, on threads."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from botschool import _core
from botschool.arenas.plan import PROBLEM, Plan
from botschool.arenas.robots import RobotModel, cast
from botschool.errors import BotschoolError
from botschool.policies.policy import Interface, Policy
from botschool.problems.base import Episodes, Interrupted, Outcome, Problem, vectors_of
from botschool.problems.rewards import aim, unmeasured
from botschool.problems.space import options_of
from botschool.problems.transition import Transition

INFOS = {info["name"]: info for info in _core.native_problems()}
"""Description of each native problem from lib/arena/problems, by its name in C++."""

NATIVE = {name: (name, info["limit"]) for name, info in INFOS.items()} | {
    info["alias"]: (name, info["alias_limit"]) for name, info in INFOS.items() if info["alias"]
}
"""Name in experiment files -> (name in C++, longest episode)."""

CLASSIC = ("Acrobot", "CartPole", "MountainCar", "Pendulum")
"""Beginnings of the names of problems that Gymnasium has, too."""

IDS = {
    name: INFOS[core]["gym"] or (name if name.startswith(CLASSIC) else f"botschool/{name}")
    for name, (core, _limit) in NATIVE.items()
    if INFOS[core]["robots"] == 1
}
"""Name in experiment files of a problem with one robot -> its Gymnasium id."""

_SPELLINGS = {
    f"{prefix}{word}": name
    for name in NATIVE
    for word in (name, IDS.get(name, name).removeprefix("botschool/"))
    for prefix in ("", "botschool/")
}


def own_name(name: str) -> str:
    """Return the name in experiment files: botschool/Discrim-v0 is ErDiscrim; others are kept."""
    return _SPELLINGS.get(name.removeprefix("botschool.envs:"), name)


def gym_id(name: str) -> str:
    """Return the Gymnasium id: ErDiscrim is botschool/Discrim-v0; other names are kept."""
    return IDS.get(own_name(name), name)


# Evaluation can stop between batches of about this many steps.
BATCH_STEPS = 20_000_000


class NativeProblem(Problem):
    """A problem whose dynamics are in C++.

    robots: kinds of its wheeled robots (botschool.arenas.robots), one for all or one each; () means
    the problem's own. plan: declaration for ErArena, None for the default. instruction_set: one of
    `_core.instruction_sets()`; "" means the best (all give the same bits). Raises BotschoolError.
    """

    native = True

    def __init__(
        self,
        name: str,
        robots: Sequence[str] = (),
        instruction_set: str = "",
        plan: Plan | None = None,
        options: str = "",
        reward: str = "",
        ends: str = "",
        physics: str = "",
    ) -> None:
        """Make the problem; options: of a runner (botschool.problems.space).

        reward, ends: expressions in place of the problem's own reward and end of episodes. physics:
        numbers of a runner's world (botschool.problems.physics).
        """
        self.name = name
        chosen = options_of(name, options, physics)
        self.alive = chosen.alive
        """A runner's reward for each step that does not end its episode early, in addition to the
        problem's own."""
        self.dynamics, self.limit = NATIVE[name]
        self.plan = Plan() if plan is None and name == PROBLEM else plan
        """A declared arena; None for other problems."""
        self._instruction_set = instruction_set
        self._engine: tuple[Policy, _core.Engine] | None = None
        info = INFOS[self.dynamics]
        if self.plan:
            info = info | {"robots": len(self.plan.robots)}
            info["observations"] = self.plan.core.observations
            self.limit = self.plan.steps
        self.robots = _cast(name, info, robots, self.plan)
        """Models of its wheeled robots; () for other problems."""
        info = info | (chosen.body or {})
        self.race = chosen.race
        """Choices about a race in space, or None."""
        self.robot = chosen.robot
        self.reward, self.ends = reward, ends
        if reward and self.alive:
            raise BotschoolError(
                "reward takes the place of the option alive: remove one of them, or write "
                f"reward = reward + {self.alive:g} * not ended."
            )
        self._options = self.options()
        self.fps = 1 / info["seconds"]
        self.common, self.sides = info["common"], info["sides"]
        self.constant_sum = not self.common
        self.interface = Interface(
            info["observations"],
            info["outputs"],
            info["discrete"],
            info["low"],
            info["high"],
            morphology=info["body"],
            robots=info["robots"],
        )

    def options(self, noise: float | None = None, bare: bool = False) -> Any:
        """Return the options for C++; noise: of an arena's sensors, None for its own; bare: without
        the user's reward.
        """
        options: Any = self.race
        if self.robots:
            core = self.plan.core if self.plan else None
            models = [model.name for model in self.robots]
            options = _core.ArenaOptions(models, noise, declaration=core)
        return options if bare else aim(self.dynamics, options, self.reward, self.ends)

    def quantities(self) -> list[tuple[str, str, str]]:
        """Return name, unit and meaning of what a reward may name."""
        return _core.quantities(self.dynamics, self.options(bare=True))

    def engine(self, policy: Policy) -> _core.Engine:
        """Return the C++ engine for this problem and the policy's network."""
        if self._engine is None or self._engine[0] is not policy:
            engine = _core.Engine(
                self.dynamics, policy.spec.core(), self._instruction_set, self._options
            )
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
            chosen = episodes if whole else episodes.select(slice(first, first + batch))
            parts.append(
                self.engine(policy).evaluate(
                    genotypes,
                    normalisation,
                    chosen.candidate if chosen.candidate.ndim == 2 else chosen.candidate[None],
                    chosen.seed,
                    chosen.episode,
                    chosen.collect,
                    limit,
                    workers,
                    bool(policy.config.heterogeneous),
                    self._options,
                )
            )
        fitness, steps, moments = parts[0] if len(parts) == 1 else _concatenated(parts)
        if not (math.isfinite(fitness.sum()) or np.isfinite(fitness).all()):
            first = int(np.argmin(np.isfinite(fitness)))
            seed, episode = int(episodes.seed[first]), int(episodes.episode[first])
            candidate = episodes.candidate[..., first]
            vectors = vectors_of(normalisation, candidate)
            rows = genotypes[np.atleast_1d(candidate)]
            played = (self, policy, rows, vectors, seed, episode, limit)
            told = unmeasured(*played) if self.reward else None
            raise told or self.broken(f"a return of {fitness[first]}", seed, episode)
        if self.alive:
            fitness = fitness + self.alive * (steps - (steps < limit))
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
            self._options,
        )
        total = 0.0
        fell = len(tape["rewards"]) < self.steps(maxsteps)
        for t, reward in enumerate(tape["rewards"]):
            if self.alive and not (fell and t == len(tape["rewards"]) - 1):
                reward = reward + self.alive
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


def _cast(
    name: str, info: dict, robots: Sequence[str], plan: Plan | None
) -> tuple[RobotModel, ...]:
    if plan and (name != PROBLEM or robots):
        if name != PROBLEM:
            raise BotschoolError(f"{name} takes no plan: only {PROBLEM} does.")
        raise BotschoolError(f"{name} takes its robots from its plan: leave out `robots`.")
    if plan:
        return plan.models
    if "plan" in info:
        return cast(name, info["plan"], robots)
    if robots:
        raise BotschoolError(
            f"{name} has no wheeled robots: remove the line robots = {', '.join(robots)}."
        )
    return ()
