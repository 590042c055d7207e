"""What a robot is evaluated on. `make(name)` knows every name.

A problem has a `name`, an `interface` (what it asks of a policy), a `limit` (longest episode in
steps, or None), `fps` (of its pictures), and two methods: `evaluate` runs a batch of episodes,
`play` runs one and yields every step. Native problems run whole episodes in C++ (native.py);
every other name is a Gymnasium id (gym.py).
"""

from __future__ import annotations

from collections.abc import Sequence

from botschool.errors import BotschoolError
from botschool.plan import PROBLEM, Plan
from botschool.problems.base import Episodes, Interrupted, Outcome, Problem
from botschool.problems.native import NATIVE, NativeProblem

__all__ = ["Episodes", "Interrupted", "Outcome", "Problem", "make", "names", "of"]


def make(
    name: str, robots: Sequence[str] = (), wrappers: str = "", plan: Plan | None = None
) -> Problem:
    """The problem of that name; robots: kinds of its wheeled robots, () for its own; plan: a
    declared arena, for ErArena.

    wrappers: those around its environment (botschool.wrappers); a native problem is then played as
    a Gymnasium environment. Raises BotschoolError when there is no such problem, or it has no such
    robots or wrappers.
    """
    if name in NATIVE and not wrappers:
        return NativeProblem(name, robots, plan=plan)
    if plan is not None and name == PROBLEM:
        raise BotschoolError(f"A declared arena takes no wrappers: remove wrappers = {wrappers}.")
    if name in NATIVE and NativeProblem(name).interface.robots > 1:
        raise BotschoolError(
            f"{name} has several robots, which no wrapper fits: remove the line wrappers = "
            f"{wrappers}."
        )
    from botschool.problems.gym import GymProblem

    if robots and name in NATIVE:
        raise BotschoolError(
            f"{name} has either other robots or wrappers: remove one of the lines."
        )
    if robots:
        raise BotschoolError(
            f"{name} is no arena of wheeled robots: remove the line robots = {', '.join(robots)}."
        )
    return GymProblem(name, wrappers)


def of(experiment) -> Problem:
    """The problem of a botschool.config.Experiment. Raises BotschoolError."""
    exp = experiment.exp
    robots = [name.strip() for name in exp.robots.split(",") if name.strip()]
    return make(exp.environment, robots, exp.wrappers, experiment.plan)


def names() -> list[str]:
    """The names of the native problems."""
    return list(NATIVE)
