"""Train with the student's own rule, which says how much each step of an episode counts."""

from __future__ import annotations

import runpy
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from botschool.errors import BotschoolError


def whole_episodes(ended: np.ndarray) -> list[tuple[int, int, int]]:
    """Return the episodes that begin and end in a rollout.

    Each is (environment, first step, step after the last). ended: (n_steps, n_envs), other than 0
    where an episode ends. The first episode of each environment is left out, because it may have
    begun in an earlier rollout.
    """
    found = []
    for environment in range(ended.shape[1]):
        ends = np.flatnonzero(ended[:, environment]) + 1
        found += [(environment, int(a), int(b)) for a, b in pairwise(ends)]
    return found


LEARN = "learn.py"
"""File with the student's own functions, in the laboratory's folder."""


def own_functions(path: Path) -> Callable[..., Any] | None:
    """Return a function that calls the student's functions by name, in this process.

    Return None if the student has no such file.
    """
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
    """Replace a rollout's advantages by the weights that the student's function returns.

    learner: the function's name and its second argument. Steps of episodes that the rollout cuts
    off get the weight 0. Raises BotschoolError if the function returns anything but numbers.
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
