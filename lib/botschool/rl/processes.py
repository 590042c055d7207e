"""Run each environment in a process of its own, with the same results as in one process."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import gymnasium
import numpy as np
from stable_baselines3.common.vec_env import SubprocVecEnv

from botschool.errors import BotschoolError

ERROR = "botschool_error"
"""Key in an info dictionary: the error message of an environment."""


class Relay(gymnasium.Wrapper):
    """Send a BotschoolError through the pipe as an info; otherwise it would end the process."""

    def __init__(self, env: gymnasium.Env) -> None:
        super().__init__(env)
        self._last = None

    def reset(self, **options):
        try:
            self._last, info = self.env.reset(**options)
        except BotschoolError as error:
            return self._anything(), {ERROR: str(error)}
        return self._last, info

    def step(self, action):
        try:
            self._last, *rest = self.env.step(action)
        except BotschoolError as error:
            return self._anything(), 0.0, False, False, {ERROR: str(error)}
        return self._last, *rest

    def _anything(self):
        return self.observation_space.sample() if self._last is None else self._last


class ProcessVecEnv(SubprocVecEnv):
    """Stable-Baselines3's SubprocVecEnv that raises the errors of its environments."""

    def __init__(self, makers: Sequence[Callable[[], gymnasium.Env]]) -> None:
        try:
            super().__init__([_Relayed(make) for make in makers])
        except (EOFError, OSError):
            self.close()
            raise self._died() from None

    def step_wait(self):
        try:
            observations, rewards, dones, infos = super().step_wait()
        except (EOFError, OSError):
            raise self._died() from None
        self._raise_relayed(infos)
        self._raise_relayed(self.reset_infos)
        return observations, rewards.astype(np.float32), dones, infos  # the types of DummyVecEnv

    def reset(self):
        try:
            observations = super().reset()
        except (EOFError, OSError):
            raise self._died() from None
        self._raise_relayed(self.reset_infos)
        return observations

    def close(self) -> None:
        try:
            super().close()
        except (EOFError, OSError):  # a process has ended
            for process in self.processes:
                process.terminate()
                process.join()
            self.closed = True

    def _raise_relayed(self, infos) -> None:
        self.waiting = False
        for info in infos:
            if info and ERROR in info:
                raise BotschoolError(info[ERROR])

    def _died(self) -> BotschoolError:
        self.waiting = False
        return BotschoolError(
            "A process with an environment ended unexpectedly: train with --vec-env dummy to "
            "see why, or with fewer environments (--envs) if memory is short."
        )


class _Relayed:
    """Make an environment inside a Relay; a class, because processes receive it by pickle."""

    def __init__(self, make: Callable[[], gymnasium.Env]) -> None:
        self.make = make

    def __call__(self) -> gymnasium.Env:
        return Relay(self.make())
