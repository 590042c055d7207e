"""Make environments for training and evaluation from any Gymnasium id, with clear errors."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from botschool.errors import BotschoolError, said
from botschool.inifile import shown
from botschool.problems.making import make_env, skipping
from botschool.problems.spaces import PlainObservations, Unsupported, fitted, plain_actions
from botschool.wrappers import parse

LONGEST_EPISODE = 1000
"""Episodes are cut after this many steps, as evolution cuts them, if neither the environment nor a
wrapper TimeLimit sets a limit."""

LARGEST_REWARD = 1e15
"""Squares of the returns of the longest episodes must be numbers of single precision."""


def make(name: str, wrapped: str = "", /, **options: Any) -> gymnasium.Env:
    """Return the guarded environment of an id; wrapped: wrappers (botschool.wrappers).

    Raises BotschoolError.
    """
    wrappers = parse(wrapped)
    env = make_env(name, **(skipping(name, wrappers) | options))
    if endless(env) and not any(wrapper.name == "TimeLimit" for wrapper in wrappers):
        env = gymnasium.wrappers.TimeLimit(env, LONGEST_EPISODE)
    for wrapper in wrappers:
        env = wrapper.around(env, name)
    return Guard(env, name)


def endless(env: gymnasium.Env) -> bool:
    """Return whether an environment sets no limit to its episodes; a wrapper may set one."""
    spec = env.unwrapped.spec
    return spec is not None and spec.max_episode_steps is None


def described(space: spaces.Space) -> str:
    """Return a short description of a space."""
    if isinstance(space, spaces.Box):
        return f"{space.dtype} numbers of shape {space.shape}"
    return shown(space)


class Guard(gymnasium.Wrapper):
    """Give learners plain spaces, and report an environment's mistakes as one sentence."""

    def __init__(self, env: gymnasium.Env, name: str) -> None:
        """Translate the spaces. Raises BotschoolError."""
        super().__init__(env)
        self.name = name
        self._acted = getattr(env, "action_space", None)
        try:
            self._observed = PlainObservations(getattr(env, "observation_space", None), name)
            self.action_space = plain_actions(self._acted)
        except Unsupported as error:
            raise BotschoolError(f"{name} cannot be trained: its {error}.") from None
        self.observation_space = self._observed.space

    def reset(self, **options: object):
        given = self._call(self.env.reset, **options)
        if not isinstance(given, tuple) or len(given) != 2 or not _is_info(given[1]):
            raise self._broken("reset does not return (observation, info)")
        return self._plain(given[0]), given[1] or {}

    def step(self, action):
        if not np.isfinite(action).all():
            raise BotschoolError(
                f"The agent's action in {self.name} is not a finite number: its training diverged, "
                "so lower learning_rate, or take the other model of its folder."
            )
        given = self._call(self.env.step, fitted(action, self._acted))
        if not isinstance(given, tuple) or len(given) != 5 or not _is_info(given[4]):
            raise self._broken(
                "step does not return (observation, reward, terminated, truncated, info)"
            )
        observation, reward, terminated, truncated, info = given
        observation, reward = self._plain(observation), self._number(reward)
        return observation, reward, terminated, truncated, info or {}

    def compute_reward(self, achieved: np.ndarray, desired: np.ndarray, infos: Any) -> np.ndarray:
        """Return the rewards of a batch of goals, for hindsight experience replay."""
        own = self.env.get_wrapper_attr("compute_reward")
        pair = (
            self._observed.back("achieved_goal", achieved),
            self._observed.back("desired_goal", desired),
        )
        rewards = np.asarray(self._call(own, *pair, infos))
        if rewards.size != len(achieved):
            raise self._broken(
                f"compute_reward gives {rewards.size} numbers for {len(achieved)} goals, which are "
                "the rows of what it gets"
            )
        return rewards

    def render(self):
        return self._call(self.env.render)

    def _call(self, method, *arguments, **options):
        try:
            return method(*arguments, **options)
        except (Exception, SystemExit) as error:
            remedy = ""
            if isinstance(error, TypeError) and options and "keyword argument" in str(error):
                remedy = "; reset must take seed and options"
            raise self._broken(
                f"it raised {type(error).__name__}: {said(error)}{remedy}"
            ) from error

    def _plain(self, observation):
        try:
            return self._observed(observation)
        except (TypeError, ValueError, LookupError) as error:
            raise self._broken(
                f"the observation {shown(observation)} is not in its observation_space: "
                f"{said(error)}"
            ) from None

    def _number(self, reward) -> float:
        try:
            number = float(reward)
        except (TypeError, ValueError, OverflowError):
            number = np.nan
        if not np.isfinite(number):
            raise self._broken(f"its reward was {shown(reward)}")
        if abs(number) > LARGEST_REWARD:
            raise self._broken(
                f"its reward was {number:g}, but beyond {LARGEST_REWARD:g} sums of rewards "
                "overflow in single precision"
            )
        return number

    def _broken(self, what: str) -> BotschoolError:
        return BotschoolError(f"{self.name} does not work ({what}): mend the environment.")


class Brief(gymnasium.Wrapper):
    """Keep of each info what a training reads: Stable-Baselines3 copies infos at every step."""

    def reset(self, **options: object):
        return self.env.reset(**options)[0], {}

    def step(self, action):
        *rest, info = self.env.step(action)
        return *rest, {key: info[key] for key in ("is_success",) if key in info}


def _is_info(info: object) -> bool:
    return info is None or isinstance(info, dict)
