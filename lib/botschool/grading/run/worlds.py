"""Environments of the grader, in the confined child: made up, or with parts turned round.

A submission can forge what they record. So only sentences for an honest student depend on it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from typing import Any

import gymnasium
import numpy as np
from gymnasium.envs import registration


def made_up(
    observed: tuple, acted: tuple, rewards: Sequence[float], maxsteps: int | None = None
) -> tuple[str, list[np.ndarray]]:
    """Register an environment of Gymnasium; return its new id and a list of all actions it gets.

    An episode gives these rewards and terminates; the seed of reset draws what is observed.
    observed, acted: limits of a Box, (lows, highs), or a number of choices and the first one.
    maxsteps: its limit of steps.
    """
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


@dataclass
class Record:
    """What a training did, an entry for each episode."""

    seeds: list[int | None] = field(default_factory=list)
    returns: list[float] = field(default_factory=list)
    actions: list[list[float]] = field(default_factory=list)
    """The first action."""


class Enough(BaseException):
    """The grader has seen enough of a training."""


class Turned(gymnasium.Wrapper):
    """An environment with parts that are turned round.

    signs: of what is observed. side: -1 exchanges left and right of the actions. most: the number
    of episodes after which it raises Enough.
    """

    def __init__(
        self, env: gymnasium.Env, signs: Any, side: int, record: Record, most: float = np.inf
    ) -> None:
        super().__init__(env)
        self.signs, self.side, self.record, self.most = np.asarray(signs), side, record, most
        self._episode = -1

    def reset(self, *, seed: int | None = None, options: dict | None = None) -> tuple:
        if len(self.record.seeds) >= self.most:
            raise Enough
        self._episode = len(self.record.seeds)
        self.record.seeds.append(seed)
        self.record.returns.append(0.0)
        self.record.actions.append([])
        observation, info = self.env.reset(seed=seed, options=options)
        return self._seen(observation), info

    def step(self, action: Any) -> tuple:
        if not self.record.actions[self._episode]:
            self.record.actions[self._episode] = np.ravel(action).astype(float).tolist()
        if self.side < 0:
            space = self.action_space
            action = space.n - 1 - action if hasattr(space, "n") else -np.asarray(action)
        observation, reward, *ends = self.env.step(action)
        self.record.returns[self._episode] += float(reward)
        return self._seen(observation), reward, *ends

    def _seen(self, observation: np.ndarray) -> np.ndarray:
        return (self.signs * observation).astype(observation.dtype)


@contextmanager
def turned(
    environment: str,
    signs: Any,
    side: int,
    most: float = np.inf,
    other: Callable[..., gymnasium.Env] | None = None,
) -> Iterator[Record]:
    """Turn parts of an environment of Gymnasium round within the block, and record its episodes.

    other: makes an environment that stands for it, if its name is not registered.
    The block ends after `most` episodes.
    """
    record, spec = Record(), gymnasium.registry.pop(environment, None)
    made = other or registration.load_env_creator(spec.entry_point)
    steps, options = (500, {}) if other else (spec.max_episode_steps, spec.kwargs)

    def make(render_mode: str | None = None, **more: Any) -> gymnasium.Env:
        env = made(render_mode=render_mode, **(options | more))
        return Turned(env, signs, side, record, most)

    gymnasium.register(environment, make, max_episode_steps=steps)
    try:
        with suppress(Enough):
            yield record
    finally:
        del gymnasium.registry[environment]
        if spec is not None:
            gymnasium.registry[environment] = spec
