"""Gymnasium environments for the tests: a quick one that works, and one for every way to fail.

The ids are `tiny_envs:Tiny-v0` and `tiny_envs:Tiny<fault>-v0`. A fault shows in the episodes that
start from a seed of FAULTY_SEED or above, so that a run with a small seed breaks in the middle.
"""

import os
from pathlib import Path

import gymnasium
import numpy as np
from gymnasium import spaces

FAULTY_SEED = 4
POST_EVALUATION = 100_000
DIE_ONCE = "TINY_DIE_ONCE"
"""Environment variable with the path of a file; the process that removes it dies at once."""


def die_once():
    """End this process if it is the one that removes the file that DIE_ONCE names."""
    if DIE_ONCE in os.environ:
        try:
            Path(os.environ[DIE_ONCE]).unlink()
        except FileNotFoundError:
            return
        os._exit(3)


class Tiny(gymnasium.Env):
    """A point on a line is pushed towards 0: reward 1 - |x| a step, lost past |x| = 1."""

    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}  # noqa: RUF012
    observation_space = spaces.Box(-2, 2, (2,), np.float32)
    action_space = spaces.Box(-0.4, 0.4, (1,), np.float32)

    def __init__(self, fault=None, render_mode=None):
        self.fault = fault
        self.render_mode = render_mode
        if fault == "discrete":
            self.action_space = spaces.Discrete(3, start=-1)
        if fault == "large":
            self.observation_space = spaces.Box(0, 255, (101, 101, 3), np.uint8)
        if fault == "words":
            self.observation_space = spaces.Text(5)
        if fault == "sequence":
            self.action_space = spaces.Sequence(spaces.Discrete(2))
        if fault == "makes":
            raise RuntimeError("no licence")
        if fault == "package":
            import a_package_that_is_not_there  # noqa: F401

    def reset(self, seed=None, options=None):
        super().reset(seed=seed)
        self.broken = self.fault is not None and FAULTY_SEED <= (seed or 0) < POST_EVALUATION
        self.x, self.speed = self.np_random.uniform(-0.5, 0.5, 2)
        if self.broken and self.fault == "resets":
            raise ValueError("cannot\nstart")
        return self._observation(), {}

    def step(self, action):
        if self.fault == "discrete":
            action = [0.4 * action]
        die_once()
        self.speed += 0.3 * float(action[0]) + 0.02 * self.np_random.normal()
        self.x += 0.3 * self.speed
        reward = 1 - abs(self.x)
        result = self._observation(), reward, bool(abs(self.x) > 1), False, {}
        return self._faulty(result) if self.broken else result

    def render(self):
        return np.full((32, 48, 3), 200, dtype=np.uint8)

    def _observation(self):
        return np.array([self.x, self.speed], dtype=np.float32)

    def _faulty(self, result):
        observation, _, ended, _, info = result
        faults = {
            "nan": (observation, np.nan, ended, False, info),
            "inf": (observation * np.inf, 0.0, ended, False, info),
            "none": (observation, None, ended, False, info),
            "vector": (observation, np.zeros(2), ended, False, info),
            "shape": (np.zeros(3), 0.0, ended, False, info),
            "text": ("left", 0.0, ended, False, info),
            "old": (observation, 0.0, ended, info),
        }
        if self.fault == "raises":
            raise RuntimeError("the motor\n  is broken")
        if self.fault == "exits":
            raise SystemExit("good bye")
        if self.fault == "dies":
            os._exit(3)
        return faults.get(self.fault, result)


FAULTS = [
    *("nan", "inf", "none", "vector", "shape", "text", "old", "raises", "exits", "dies"),
    *("resets", "makes", "package", "large", "words", "sequence", "discrete"),
]

for fault in [None, *FAULTS]:
    gymnasium.register(f"Tiny{fault or ''}-v0", Tiny, kwargs={"fault": fault}, max_episode_steps=12)


class Blind(Tiny):
    """Draws nothing."""

    metadata = {"render_modes": []}  # noqa: RUF012


gymnasium.register("Blind-v0", Blind, max_episode_steps=12)


class Small(Tiny):
    """Pays little."""

    def step(self, action):
        observation, reward, *ends = super().step(action)
        return observation, 1e-4 * reward, *ends


gymnasium.register("Small-v0", Small, max_episode_steps=12)


class Nested(Tiny):
    """Observes in parts, of all kinds, and is moved by several choices at once."""

    observation_space = spaces.Dict(
        {
            "x": spaces.Box(-2, 2, (2,), np.float32),
            "view": spaces.Box(0, 255, (2, 3, 1), np.uint8),
            "pair": spaces.Tuple((spaces.Discrete(3, start=-1), spaces.MultiBinary(2))),
            "hint": spaces.Text(8),
        }
    )
    action_space = spaces.MultiDiscrete([3, 2], start=[-1, 0])

    def step(self, action):
        assert self.action_space.contains(action), action
        push, strong = action
        return super().step([0.2 * push * (1 + strong)])

    def _observation(self):
        side = np.int64(np.sign(self.x))
        return {
            "hint": "left",
            "pair": (side, np.array([self.x > 0, self.speed > 0], dtype=np.int8)),
            "view": np.arange(6, dtype=np.uint8).reshape(2, 3, 1),
            "x": super()._observation(),
        }


class Buttons(Tiny):
    """Two rows of two buttons, of which the lower ones push."""

    action_space = spaces.MultiBinary([2, 2])

    def step(self, action):
        assert self.action_space.contains(action), action
        return super().step([0.4 * (int(action[1, 1]) - int(action[1, 0]))])


class Plate(Tiny):
    """A square of actuators."""

    action_space = spaces.Box(-0.4, 0.4, (2, 2), np.float32)

    def step(self, action):
        assert self.action_space.contains(action), action
        return super().step([action.mean()])


for kind in (Nested, Buttons, Plate):
    gymnasium.register(f"{kind.__name__}-v0", kind, max_episode_steps=12)


class Goal(gymnasium.Env):
    """A point on a line is moved to a place; reward 0 there, else -1."""

    place = spaces.Box(-2, 2, (1,), np.float32)
    observation_space = spaces.Dict(observation=place, achieved_goal=place, desired_goal=place)

    def __init__(self, discrete=False):
        self.action_space = spaces.Discrete(2) if discrete else spaces.Box(-1, 1, (1,), np.float32)

    def reset(self, seed=None, options=None):
        super().reset(seed=seed)
        self.x, self.goal = self.np_random.uniform(-1, 1, (2, 1)).astype(np.float32)
        return self._observation(), {}

    def step(self, action):
        push = 2.0 * action - 1 if isinstance(self.action_space, spaces.Discrete) else action
        self.x = np.clip(self.x + np.float32(0.2) * np.float32(push), -2, 2).reshape(1)
        reward = float(self.compute_reward(self.x, self.goal, {}))
        return self._observation(), reward, False, False, {}

    def compute_reward(self, achieved, desired, info):
        return -(np.abs(achieved - desired).max(axis=-1) > 0.2).astype(np.float32)

    def _observation(self):
        return {"observation": self.x, "achieved_goal": self.x, "desired_goal": self.goal}


for kind in (False, True):
    gymnasium.register(
        f"Goal{'discrete' if kind else ''}-v0",
        Goal,
        kwargs={"discrete": kind},
        max_episode_steps=12,
    )


class Doubled(gymnasium.RewardWrapper):
    """Pays `times` as much; 2 if not told otherwise."""

    def __init__(self, env, times=2):
        super().__init__(env)
        self.times = times

    def reward(self, reward):
        return self.times * reward


class Picture(Tiny):
    """Shows the point as a light column in a picture."""

    observation_space = spaces.Box(0, 255, (40, 40, 3), np.uint8)

    def _observation(self):
        picture = np.zeros((40, 40, 3), dtype=np.uint8)
        column = int(np.clip(20 + 20 * self.x, 1, 38))
        picture[:, column - 1 : column + 2] = 200
        return picture


gymnasium.register("Picture-v0", Picture, max_episode_steps=12)


class Throttle(Tiny):
    """Is pushed by 0 to 100 percent; 50 do not push."""

    action_space = spaces.Box(0, 100, (1,), np.float32)

    def step(self, action):
        return super().step((action - 50) / 125)


gymnasium.register("Throttle-v0", Throttle, max_episode_steps=12)
