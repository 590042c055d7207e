"""What a robot is evaluated on. `make(name)` knows every name.

A problem has a `name`, an `interface` (what it asks of a policy), a `limit` (longest episode in
steps, or None), `fps` (of its pictures), and two methods: `evaluate` runs a batch of episodes,
`play` runs one and yields every step. Native problems run whole episodes in C++ (native.py);
every other name is a Gymnasium id (gym.py).
"""

from __future__ import annotations

from botschool.problems.base import Episodes, Interrupted, Outcome, Problem
from botschool.problems.native import NATIVE, NativeProblem

__all__ = ["Episodes", "Interrupted", "Outcome", "Problem", "make", "names"]


def make(name: str) -> Problem:
    """The problem of that name; raises BotschoolError (errors.py) when there is none."""
    if name in NATIVE:
        return NativeProblem(name)
    from botschool.problems.gym import GymProblem

    return GymProblem(name)


def names() -> list[str]:
    """The names of the native problems."""
    return list(NATIVE)
