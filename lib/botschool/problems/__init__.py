"""Define the problems on which robots are evaluated. `make(name)` finds all of them.

A problem has a `name`, an `interface` (its requirements of a policy), a `limit` (longest episode in
steps, or None), `fps` (of its pictures), and two methods: `evaluate` runs a batch of episodes,
`play` runs one and yields every step. Native problems run whole episodes in C++ (native.py). Every
other name is a Gymnasium id (gym.py) or, if two sides compete, a PettingZoo environment
(parallel.py).
"""

from __future__ import annotations

from collections.abc import Sequence

from botschool import sisters
from botschool.arenas.plan import PROBLEM, Plan
from botschool.errors import BotschoolError
from botschool.problems.base import Episodes, Interrupted, Outcome, Problem
from botschool.problems.native import NATIVE, NativeProblem, own_name

__all__ = ["Episodes", "Interrupted", "Outcome", "Problem", "make", "names", "of"]


def make(
    name: str,
    robots: Sequence[str] = (),
    wrappers: str = "",
    options: str = "",
    competitive: bool = False,
    plan: Plan | None = None,
    reward: str = "",
    ends: str = "",
    physics: str = "",
) -> Problem:
    """Return the problem with that name; robots: kinds of its wheeled robots, () for its own; plan:
    a declared arena, for ErArena.

    wrappers: around its environment (botschool.wrappers); a native problem is then played as a
    Gymnasium environment. options: keywords of the environment's constructor; a native
    runner has its own (botschool.problems.space). competitive: two sides evolve
    against each other in it. reward, ends: expressions in place of a native problem's own reward
    and end of episodes (botschool.problems.rewards); physics: numbers of its world. Raises
    BotschoolError if there is no such problem, or if it has no such robots, wrappers, options
    or quantities.
    """
    name = own_name(name)
    if name in NATIVE and not wrappers:
        return NativeProblem(
            name, robots, plan=plan, options=options, reward=reward, ends=ends, physics=physics
        )
    if plan is not None and name == PROBLEM:
        raise BotschoolError(f"A declared arena takes no wrappers: remove wrappers = {wrappers}.")
    if name in NATIVE and NativeProblem(name).interface.robots > 1:
        raise BotschoolError(
            f"{name} has several robots, which no wrapper fits: remove the line wrappers = "
            f"{wrappers}."
        )
    chosen = {"reward": reward, "ends": ends, "physics": physics}
    own = {key: text for key, text in chosen.items() if text}
    if own and name not in NATIVE:
        raise BotschoolError(
            f"{next(iter(own))} is for native problems, which `botschool problems` lists; {name} "
            "runs in Python: change it by a wrapper."
        )
    if own:
        options = ", ".join(
            filter(None, [options, *(f"{key}={text!r}" for key, text in own.items())])
        )
    if robots and name in NATIVE:
        raise BotschoolError(
            f"{name} has either other robots or wrappers: remove one of the lines."
        )
    if robots:
        raise BotschoolError(
            f"{name} is not an arena of wheeled robots: remove the line robots = "
            f"{', '.join(robots)}."
        )
    if competitive:
        from botschool.problems.parallel import ParallelProblem

        return ParallelProblem(name, wrappers, options)
    from botschool.problems.gym import GymProblem

    try:
        return GymProblem(name, wrappers, options)
    except BotschoolError:
        from botschool.problems.zoo import is_parallel

        if is_parallel(name):
            raise BotschoolError(
                f"{name} is an environment of PettingZoo, in which two sides evolve against each "
                "other: set algo = coevo2, archive, archivestar or maxsolvestar."
            ) from None
        raise


def of(experiment) -> Problem:
    """Return the problem of a botschool.config.Experiment. Raises BotschoolError."""
    exp = experiment.exp
    robots = [name.strip() for name in exp.robots.split(",") if name.strip()]
    chosen: dict = {"options": exp.options, "competitive": experiment.competitive}
    chosen |= {"reward": exp.reward, "ends": exp.ends, "physics": exp.physics}
    try:
        return make(exp.environment, robots, exp.wrappers, **chosen, plan=experiment.plan)
    except BotschoolError:
        if sentence := sisters.missing(exp.environment):
            raise BotschoolError(sentence) from None
        raise


def names() -> list[str]:
    """Return the names of the native problems."""
    return list(NATIVE)
