"""Runners beside the same bodies in Gymnasium's MuJoCo, EnvPool's MuJoCo and PyBullet."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from importlib.util import find_spec

import gymnasium
import numpy as np
from report import Table, rate, verdict
from speed import DATA, Around, best_call, rates

from botschool import config
from botschool.policies.policy import Interface, Policy

BODIES = {
    # experiment file: target (steps/s), id in Gymnasium and in EnvPool, ours in PyBullet
    "planarhopper": (300e3, "Hopper-v5", "HopperBulletEnv-v5"),
    "planarwalker2d": (150e3, "Walker2d-v5", "Walker2DBulletEnv-v5"),
    "planarhalfcheetah": (150e3, "HalfCheetah-v5", "HalfCheetahBulletEnv-v5"),
    "spatialant": (400e3, "Ant-v5", "AntBulletEnv-v5"),
    "spatialhumanoid_linear": (500e3, "Humanoid-v5", "HumanoidBulletEnv-v5"),
}
CANDIDATES = 320
"""Of a batch; when no episode of it is left to begin, lanes fall idle one by one."""
LONG_BATCH = 1280
STEPS = 100
"""Of a turn of those who play in Python."""


class InPython:
    """The loop that everybody writes, with a network of the same size."""

    def __init__(self, env: gymnasium.Env, hiddens: int) -> None:
        self.env = env
        spaces = env.observation_space.shape[0], env.action_space.shape[0]
        interface = Interface(*spaces, discrete=False)
        self.policy = Policy("runner", interface, config.PolicyConfig(nhiddens=hiddens, bias=1))
        self.policy.load(self.policy.initial(1), None)
        self.observation, self.done = None, True

    def play(self) -> int:
        """STEPS steps."""
        for _ in range(STEPS):
            if self.done:
                self.observation, _ = self.env.reset(seed=1)
                self.policy.reset(1, 0)
            action = np.clip(self.policy.act(self.observation), -1, 1).astype(np.float32)
            self.observation, _, terminated, truncated, _ = self.env.step(action)
            self.done = terminated or truncated
        return STEPS


class InEnvPool:
    """EnvPool's C++ environments, stepped together by one thread, with random actions."""

    def __init__(self, name: str) -> None:
        import envpool

        self.envs = envpool.make(name, env_type="gymnasium", num_envs=64, num_threads=1, seed=1)
        shape = (STEPS, 64, *self.envs.action_space.shape)
        self.actions = np.random.default_rng(1).uniform(-1, 1, shape)
        self.envs.reset()

    def play(self) -> int:
        """STEPS steps of all environments."""
        for actions in self.actions:
            self.envs.step(actions)
        return STEPS * 64


def _evolved(body: str) -> bool:
    """Return whether data/genotypes has the robot."""
    return (DATA.parent / "genotypes" / f"{body}.npy").is_file()


def _others(body: str, hiddens: int) -> list[Callable[[], int] | None]:
    """MuJoCo in Gymnasium and in EnvPool, and PyBullet; None for what is not installed."""
    _, mujoco, bullet = BODIES[body]
    players: list[Callable[[], int] | None] = [None] * 3
    if find_spec("mujoco"):
        players[0] = InPython(gymnasium.make(mujoco, disable_env_checker=True), hiddens).play
    if find_spec("envpool"):
        players[1] = InEnvPool(mujoco).play
    if find_spec("pybullet"):
        players[2] = InPython(gymnasium.make(bullet, disable_env_checker=True), hiddens).play
    return players


def runners(seconds: float, repetitions: int) -> Table:
    """Steps per second, one core."""
    table = Table(
        "Runners: steps/s of policy and problem, one core",
        f"{CANDIDATES} candidates around the robots of data/genotypes (noise 0.02), an episode "
        f"each; best of {repetitions} interleaved repetitions, in processor time. MuJoCo and "
        "PyBullet: a Python loop over gymnasium.make(id) with a random network of the same size "
        "in double precision. EnvPool: 64 environments stepped by one thread, random actions, "
        "no network. A step is 0.008 s (half cheetah and ant 0.05 s, humanoid 0.015 s) in all but "
        "PyBullet (0.0165 s). The targets of ant and humanoid are for AVX-512.",
        [
            "experiment", "steps / episode", "native", "target", "",
            "Gymnasium's MuJoCo", "EnvPool's MuJoCo", "PyBullet",
        ],
    )  # fmt: skip
    for body, (target, *_) in BODIES.items():
        if not _evolved(body):
            continue
        around = Around(body, CANDIDATES)
        others = _others(body, around.policy.config.nhiddens)
        present = [player for player in others if player]
        best = iter([max(r) for r in rates([around.evaluate, *present], seconds, repetitions)])
        own = next(best)
        table.add(
            body,
            f"{around.evaluate() / CANDIDATES:.0f}",
            rate(own),
            rate(target),
            verdict(own >= target),
            *(rate(next(best)) if player else "-" for player in others),
        )
    return table


def two_workers_on_runners(repetitions: int) -> Table:
    """Evaluation of whole episodes on one worker and on two."""
    table = Table(
        "Runners: two workers against one",
        f"Steps/s as above, by the clock; the fastest of {repetitions} calls each, taking turns. "
        "A worker steps 16 episodes together until the longest of them ends. So the end of a batch "
        "takes as long with two workers as with one, and it is a larger part of a short batch.",
        ["experiment", "candidates", "1 worker", "2 workers", "2 / 1", "target", ""],
    )
    for body in filter(_evolved, BODIES):
        for candidates in (CANDIDATES, LONG_BATCH):
            around = Around(body, candidates)
            one, two = best_call([partial(around.evaluate, w) for w in (1, 2)], repetitions)
            ratio = two / one
            target = ("1.9", verdict(ratio >= 1.9)) if candidates == LONG_BATCH else ("-", "-")
            table.add(body, str(candidates), rate(one), rate(two), f"{ratio:.2f}", *target)
    return table
