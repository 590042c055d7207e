"""Make environments for training and evaluation from any Gymnasium id, with clear errors."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from botschool.errors import BotschoolError
from botschool.inifile import shown
from botschool.problems.making import make_env, skipping
from botschool.wrappers import parse

LONGEST_EPISODE = 10_000
"""Episodes end after this many steps if the environment sets no limit itself."""


def make(name: str, wrapped: str = "", **options: Any) -> gymnasium.Env:
    """Return the guarded environment of an id; wrapped: wrappers (botschool.wrappers).

    Raises BotschoolError.
    """
    wrappers = parse(wrapped)
    env = make_env(name, **(skipping(name, wrappers) | options))
    if env.spec is not None and env.spec.max_episode_steps is None:
        env = gymnasium.wrappers.TimeLimit(env, LONGEST_EPISODE)
    for wrapper in wrappers:
        env = wrapper.around(env, name)
    return Guard(env, name)


def described(space: spaces.Space) -> str:
    """Return a short description of a space."""
    if isinstance(space, spaces.Box):
        return f"{space.dtype} numbers of shape {space.shape}"
    return shown(space)


class Guard(gymnasium.Wrapper):
    """Report an environment's mistakes as one sentence, and number discrete actions from 0."""

    def __init__(self, env: gymnasium.Env, name: str) -> None:
        super().__init__(env)
        self.name = name
        self._start = 0
        if isinstance(env.action_space, spaces.Discrete) and env.action_space.start:
            self._start = env.action_space.start
            self.action_space = spaces.Discrete(int(env.action_space.n))

    def reset(self, **options: object):
        observation, info = self._call(self.env.reset, **options)
        self._check(observation, 0.0)
        return observation, info

    def step(self, action):
        given = self._call(self.env.step, action + self._start if self._start else action)
        if not isinstance(given, tuple) or len(given) != 5:
            raise self._broken("step does not return five values")
        observation, reward, *ends = given
        self._check(observation, reward)
        return observation, float(reward), *ends

    def render(self):
        return self._call(self.env.render)

    def _call(self, method, *arguments, **options):
        try:
            return method(*arguments, **options)
        except (Exception, SystemExit) as error:
            reason = " ".join(str(error).split()).rstrip(".")
            raise self._broken(f"it raised {type(error).__name__}: {shown(reason)}") from error

    def _check(self, observation, reward) -> None:
        try:
            finite = np.isfinite(float(reward))
        except (TypeError, ValueError):
            finite = False
        if not finite:
            raise self._broken(f"its reward was {shown(reward)}")
        space = self.observation_space
        if not isinstance(space, spaces.Box):
            return
        if np.shape(observation) != space.shape:
            raise self._broken(
                f"an observation has shape {np.shape(observation)} instead of {space.shape}"
            )
        if space.dtype.kind == "f" and not np.isfinite(observation).all():
            raise self._broken("an observation holds NaN or infinity")

    def _broken(self, what: str) -> BotschoolError:
        return BotschoolError(f"{self.name} does not work ({what}): mend the environment.")
