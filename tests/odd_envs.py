"""Environments whose episodes depend on more than their seed, and others that break a rule.

A test names them as `odd_envs:NAME-v0` and does not import this module, which draws when it is
imported.
"""

import os
import random
import sys

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.envs.classic_control import CartPoleEnv

from duels import Duel
from tiny_envs import Tiny

DRAWN = np.random.uniform(-0.5, 0.5, 5)  # noqa: NPY002
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


class DrawsAtImport(Odd):
    def begins(self):
        return DRAWN[self.np_random.integers(5)]


class DrawsWhenMade(Odd):
    def made(self):
        self.slope = np.random.normal()  # noqa: NPY002

    def pushed(self):
        return self.slope


class SeedsOnce(Odd):
    def made(self):
        self.own = np.random.default_rng(5)

    def begins(self):
        return self.own.uniform(-0.5, 0.5)


class GetsTired(Odd):
    force = 1.0

    def pushed(self):
        self.force *= 0.99
        return self.force


class GetsHarder(Odd):
    episodes = 0

    def begins(self):
        self.episodes += 1
        return min(0.9, self.episodes / 1000)


class ImportsLate(Odd):
    """Imports torch in its first step, after it could be seeded for the episode."""

    def pushed(self):
        import torch

        return float(torch.randn(()))


# nothing helps


class OrdersTexts(Odd):
    """A set of texts has another order in each process."""

    def begins(self):
        order = list({f"place {i}" for i in range(97)})
        return sum(n * int(place[6:]) for n, place in enumerate(order)) % 99_991 / 100_000


class HashesTexts(Odd):
    def begins(self):
        return hash("place") % 99_991 / 100_000


class KnowsProcess(Odd):
    def begins(self):
        return os.getpid() % 997 / 1000


class CountsForAll(Odd):
    count = 0

    def begins(self):
        CountsForAll.count += 1
        return (CountsForAll.count % 50) / 100


class CountsInstances(Odd):
    count = 0

    def made(self):
        CountsInstances.count += 1
        self.slope = CountsInstances.count / 100

    def pushed(self):
        return self.slope


class DrawsOnItsOwn(Odd):
    def begins(self):
        return OWN.uniform(-0.5, 0.5)


class Samples(Odd):
    def begins(self):
        return 0.1 * self.observation_space.sample()[0]


class GetsHarderLate(Odd):
    episodes = 0

    def begins(self):
        GetsHarderLate.episodes += 1
        return 0.1 if GetsHarderLate.episodes < 100 else 0.9


# games


class Carries(Duel):
    """Its steps change a hidden state, which reset keeps."""

    heat = 0.0

    def step(self, actions):
        self.heat = 0.9 * self.heat + 0.1
        seen, paid, *ends = super().step(actions)
        return seen, {agent: reward + self.heat for agent, reward in paid.items()}, *ends


class Shares(Duel):
    """All its games change the same hidden state."""

    heat = [0.0]  # noqa: RUF012

    def step(self, actions):
        self.heat[0] += 0.1
        seen, paid, *ends = super().step(actions)
        return seen, {agent: reward + self.heat[0] for agent, reward in paid.items()}, *ends


# broken rules


class Alone(CartPoleEnv):
    def reset(self, seed=None, options=None):
        return super().reset(seed=seed)[0]


class Number(CartPoleEnv):
    observation_space = spaces.Box(0, 100, (1,), np.float32)

    def reset(self, seed=None, options=None):
        super().reset(seed=seed)
        return 38


class Three(CartPoleEnv):
    def reset(self, seed=None, options=None):
        return (*super().reset(seed=seed), 0)


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


class Outside(CartPoleEnv):
    def reset(self, seed=None, options=None):
        super().reset(seed=seed)
        return np.zeros(3, np.float32), {}


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


class NoInfo(CartPoleEnv):
    def reset(self, seed=None, options=None):
        return super().reset(seed=seed)[0], None

    def step(self, action):
        return *super().step(action)[:4], None


class Named(CartPoleEnv):
    """Its arguments have the names of ours."""

    def __init__(self, name="flat", wrappers="none", render_mode=None):
        super().__init__(render_mode=render_mode)
        self.given = name, wrappers


for kind in list(globals().values()):
    if getattr(kind, "__module__", None) == __name__ and issubclass(kind, gymnasium.Env):
        limit = 12 if issubclass(kind, Odd) else None
        gymnasium.register(f"{kind.__name__}-v0", kind, max_episode_steps=limit)
