"""PettingZoo environments for the tests: a quick one that works, and one for every way to fail.

`tiny_duels:Duel`, with an option fault=... for faults that show while it is played.
"""

import os
from pathlib import Path

import numpy as np
from gymnasium import spaces
from pettingzoo import AECEnv, ParallelEnv

DIE_ONCE = "TINY_DIE_ONCE"
"""Environment variable with the path of a file; the process that removes it dies at once."""


class Duel(ParallelEnv):
    """A cat on a line follows a mouse, which is to stay away, but gets tired when it moves.

    They see and do different things. The cat is paid 1 - distance, the mouse the distance less its
    effort; the mouse leaves when it is caught, and the cat stays until the end.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}  # noqa: RUF012
    names = ("cat", "mouse")
    length = 8

    def __init__(self, fault=None, render_mode=None):
        self.fault = fault
        self.render_mode = render_mode
        self.possible_agents = list(self.names)
        self.agents = []

    def observation_space(self, agent):
        if self.fault == "words":
            return spaces.Text(5)
        if agent == "mouse":
            return spaces.Dict(cat=spaces.Box(-9, 9, (1,), np.float32), side=spaces.Discrete(2))
        return spaces.Box(-9, 9, (3,), np.float32)

    def action_space(self, agent):
        if self.fault == "sequence":
            return spaces.Sequence(spaces.Discrete(2))
        if agent == "mouse":
            return spaces.MultiDiscrete([3, 2], start=[-1, 0])
        return spaces.Box(-0.4, 0.4, (1,), np.float32)

    def reset(self, seed=None, options=None):
        self.random = np.random.default_rng(None if self.fault == "unseeded" else seed)
        self.cat, self.mouse = self.random.uniform(-1, 1, 2)
        self.t = 0
        self.agents = [] if self.fault == "nobody" else list(self.names)
        seen = self._seen()
        return seen if self.fault == "old" else (seen, {agent: {} for agent in self.names})

    def step(self, actions):
        self._die_once()
        assert set(actions) == set(self.agents), actions
        assert all(self.action_space(agent).contains(act) for agent, act in actions.items())
        self.t += 1
        if self.fault == "raises":
            raise RuntimeError("the floor\n  is wet")
        effort = 0.0
        if "mouse" in actions:
            push, strong = actions["mouse"]
            effort = 0.1 * abs(push) * (1 + strong)
            self.mouse = np.clip(self.mouse + 0.15 * push * (1 + strong), -4, 4)
        self.cat = np.clip(self.cat + float(actions["cat"][0]), -4, 4)
        apart = abs(self.cat - self.mouse)
        paid = {"cat": 1 - apart, "mouse": apart - effort}
        ended = {"cat": False, "mouse": bool(apart < 0.1)}
        cut = dict.fromkeys(self.names, self.t >= self.length)
        wrong = {"nan": {"cat": np.nan}, "unpaid": {"mouse": 1.0}}
        here = list(self.agents)
        self.agents = [a for a in here if not (ended[a] or cut[a])]
        paid = {a: r for a, r in (wrong.get(self.fault) or paid).items() if a in here}
        seen = {} if self.fault == "blind" else {a: self._seen()[a] for a in here}
        return seen, paid, ended, cut, {}

    def render(self):
        if self.fault == "words drawn":
            return "a cat"
        return np.full((32, 48, 3), 200, dtype=np.uint8)

    def _seen(self):
        apart = self.mouse - self.cat
        cat = np.array([self.cat, self.mouse, apart], dtype=np.float32)
        mouse = {"cat": np.array([-apart], dtype=np.float32), "side": int(self.mouse > 0)}
        return {"cat": cat, "mouse": mouse}

    def _die_once(self):
        if DIE_ONCE in os.environ:
            try:
                Path(os.environ[DIE_ONCE]).unlink()
            except FileNotFoundError:
                return
            os._exit(3)


class Blind(Duel):
    """Draws nothing."""

    metadata = {"render_modes": []}  # noqa: RUF012


class Crowd(Duel):
    names = ("cat", "mouse", "dog")


class Hermit(Duel):
    names = ("cat",)


class Seedless(Duel):
    def reset(self, options=None):
        return super().reset()


class Turns(AECEnv):
    """Agents act one after the other."""

    metadata = {"is_parallelizable": False}  # noqa: RUF012
    possible_agents = ("white", "black")


def nothing():
    return None


def broken():
    raise RuntimeError("no floor")


def packaged():
    import a_package_that_is_not_there  # noqa: F401


board = {"no": "environment"}
