"""Register environments that a grader makes up, in the confined child: no student has met them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np


def made_up(
    observed: tuple, acted: tuple, rewards: Sequence[float], maxsteps: int | None = None
) -> tuple[str, list[np.ndarray]]:
    """Register an environment of Gymnasium; return its new id and a list of all actions it gets.

    An episode gives these rewards and terminates; the seed of reset draws what is observed.
    observed, acted: limits of a Box, (lows, highs), or a number of choices and the first one.
    maxsteps: its limit of steps.
    """
    import gymnasium

    got: list[np.ndarray] = []

    class MadeUp(gymnasium.Env):
        observation_space, action_space = _space(observed), _space(acted)

        def reset(self, *, seed: int | None = None, options: Any = None) -> tuple:
            super().reset(seed=seed)
            self.observation_space.seed(seed)
            self.waiting = list(rewards)
            return self.observation_space.sample(), {}

        def step(self, action: Any) -> tuple:
            got.append(np.array(action, dtype=float))
            reward = float(self.waiting.pop(0))
            return self.observation_space.sample(), reward, not self.waiting, False, {}

    name = f"grader/MadeUp{len(gymnasium.registry)}-v0"
    gymnasium.register(
        name, entry_point=MadeUp, max_episode_steps=maxsteps, disable_env_checker=True
    )
    return name, got


def _space(given: tuple) -> Any:
    from gymnasium.spaces import Box, Discrete

    if np.ndim(given[0]) == 0:
        return Discrete(given[0], start=given[1])
    return Box(*(np.asarray(each, dtype=np.float32) for each in given))
