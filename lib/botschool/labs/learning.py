"""Training with the student's own rule: how much each step of an episode counts."""

from __future__ import annotations

import runpy
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from botschool.errors import BotschoolError


def whole_episodes(ended: np.ndarray) -> list[tuple[int, int, int]]:
    """Episodes that begin and end in a rollout: (environment, first step, step after the last).

    ended: (n_steps, n_envs), not 0 where an episode ends. The first one of each environment is
    left out: it may have begun before.
    """
    found = []
    for environment in range(ended.shape[1]):
        ends = np.flatnonzero(ended[:, environment]) + 1
        found += [(environment, int(a), int(b)) for a, b in pairwise(ends)]
    return found


LEARN = "learn.py"
"""The student's own functions, in the laboratory's folder."""


def own_functions(path: Path) -> Callable[..., Any] | None:
    """Call the student's functions by name, at home; None if he has no such file."""
    if not path.is_file():
        return None
    space = runpy.run_path(str(path))

    def call(name: str, *arguments: Any) -> Any:
        if name not in space:
            raise BotschoolError(f"{path} has no function {name}.")
        try:
            return space[name](*arguments)
        except NotImplementedError:
            raise BotschoolError(f"Write {name} in {path} first.") from None

    return call


def weigh(rollout: Any, learner: Any, student: Any) -> None:
    """Let the student's function say how much each step counts, in place of advantages.

    learner: the function's name and its second argument. Steps of episodes that are cut off by the
    rollout count 0. Raises BotschoolError when the function gives something else than numbers.
    """
    name, argument = learner
    places = whole_episodes(rollout.ended)
    rollout.advantages[:] = 0
    rollout.returns[:] = rollout.values
    if not places:
        return
    rewards = [np.array(rollout.rewards[a:b, e], dtype=np.float64) for e, a, b in places]
    given = student(name, rewards, argument)
    if not isinstance(given, (list, tuple)) or len(given) != len(places):
        raise BotschoolError(f"{name} must return a list with an array for each episode.")
    for (e, a, b), weights in zip(places, given, strict=True):
        try:
            array = np.asarray(weights, dtype=np.float64)
        except (TypeError, ValueError):
            array = np.zeros(0)
        if array.shape != (b - a,) or not np.isfinite(array).all():
            raise BotschoolError(f"{name} must return a finite number for each step of an episode.")
        rollout.advantages[a:b, e] = array
