"""Environments whose episodes depend on more than their seed, and others that break a rule.

A test names them as `odd_envs:NAME-v0` and does not import this module, which draws when it is
imported.
"""

import random
import sys

import gymnasium
import numpy as np
from gymnasium.envs.classic_control import CartPoleEnv

from tiny_envs import Tiny

OWN = random.Random(3)


class Odd(Tiny):
    """Tiny, which begins where `begins` says and is pushed by `pushed`."""

    def __init__(self, render_mode=None):
        super().__init__(render_mode=render_mode)
        self.made()

    def made(self):
        pass

    def begins(self):
        return 0.1

    def pushed(self):
        return 0.0

    def reset(self, seed=None, options=None):
        super().reset(seed=seed)
        self.x = self.begins()
        return self._observation(), {}

    def step(self, action):
        self.x += 0.1 * self.pushed()
        return super().step(action)


# one environment does not repeat, but seeds or a new environment for each episode help


class DrawsGlobally(Odd):
    def begins(self):
        return random.uniform(-0.5, 0.5)

    def pushed(self):
        return np.random.normal()  # noqa: NPY002


class SeedsOnce(Odd):
    def made(self):
        self.own = np.random.default_rng(5)

    def begins(self):
        return self.own.uniform(-0.5, 0.5)


class GetsHarder(Odd):
    episodes = 0

    def begins(self):
        self.episodes += 1
        return min(0.9, self.episodes / 1000)


class KeepsAWorld(Odd):
    episodes = 0

    def made(self):
        import Box2D

        self.world = Box2D.b2World()

    def begins(self):
        self.episodes += 1
        return 0.1 if self.episodes < 40 else 0.9


# nothing helps


class HashesTexts(Odd):
    def begins(self):
        return hash("place") % 99_991 / 100_000


class CountsForAll(Odd):
    count = 0

    def begins(self):
        CountsForAll.count += 1
        return (CountsForAll.count % 50) / 100


class DrawsOnItsOwn(Odd):
    def begins(self):
        return OWN.uniform(-0.5, 0.5)


# broken rules


class Alone(CartPoleEnv):
    def reset(self, seed=None, options=None):
        return super().reset(seed=seed)[0]


class Pair(CartPoleEnv):
    def reset(self, seed=None, options=None):
        super().reset(seed=seed)
        return 0.1, 0.2


class Seedless(CartPoleEnv):
    def reset(self):
        return super().reset()


class Optionless(CartPoleEnv):
    def reset(self, seed=None):
        return super().reset(seed=seed)


class Four(CartPoleEnv):
    def step(self, action):
        observation, reward, ended, _, info = super().step(action)
        return observation, reward, ended, info


class Ends(CartPoleEnv):
    def step(self, action):
        observation, reward, *ends, info = super().step(action)
        return observation, reward, np.array(ends), False, info


class Quits(CartPoleEnv):
    def __init__(self, render_mode=None):
        sys.exit("no licence")


class Pays(CartPoleEnv):
    def __init__(self, reward=0, render_mode=None):
        super().__init__(render_mode=render_mode)
        self.reward = reward

    def step(self, action):
        observation, _, *ends = super().step(action)
        return observation, self.reward * (1 + action), *ends


for kind in list(globals().values()):
    if getattr(kind, "__module__", None) == __name__ and issubclass(kind, gymnasium.Env):
        limit = 12 if issubclass(kind, Odd) else None
        gymnasium.register(f"{kind.__name__}-v0", kind, max_episode_steps=limit)
