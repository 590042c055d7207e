"""What a step of a locomotor costs beside bare physics and pybullet_envs_gymnasium."""

from __future__ import annotations

import time
from functools import partial
from importlib.util import find_spec

import gymnasium
import numpy as np
from report import Table, rate, verdict
from speed import DATA, Around, best_call

from botschool import config
from botschool.envs.bullet import hushed
from botschool.envs.locomotors import Locomotor

BODIES = ("Hopper", "HalfCheetah", "Ant", "Walker2D", "Humanoid")
TARGET, TWO_WORKERS = 1.6, 1.8
CANDIDATES = 40
EPISODE = 200
"""Steps, or fewer if the robot falls."""


class Contestant:
    """One environment; each turn plays the same episode as everybody else's."""

    def __init__(self, env: gymnasium.Env) -> None:
        self.env = env.unwrapped
        shape = (EPISODE, *env.action_space.shape)
        actions = np.random.default_rng(0).uniform(-0.5, 0.5, shape)
        self.actions = list(actions.astype(np.float32))
        with hushed():
            self.env.reset(seed=0)

    def turn(self) -> np.ndarray:
        """Plays the episode; returns the seconds of each step."""
        self.env.reset(seed=0)
        seconds = []
        for action in self.actions:
            start = time.perf_counter()
            _, _, ended, _, _ = self.env.step(action)
            seconds.append(time.perf_counter() - start)
            if ended:
                break
        return np.array(seconds)


class Bare(Contestant):
    """The same episode in the same world, but stepSimulation alone is timed."""

    def turn(self) -> np.ndarray:
        bullet, watch = self.env._bullet, StopWatch(self.env._bullet)
        self.env._bullet = watch
        try:
            super().turn()
        finally:
            self.env._bullet = bullet
        return np.array(watch.seconds)


class StopWatch:
    """PyBullet that times stepSimulation."""

    def __init__(self, bullet) -> None:
        self._bullet = bullet
        self._step = bullet.stepSimulation
        self.seconds = []

    def stepSimulation(self, physicsClientId: int) -> None:  # noqa: N802
        start = time.perf_counter()
        self._step(physicsClientId=physicsClientId)
        self.seconds.append(time.perf_counter() - start)

    def __getattr__(self, name):
        return getattr(self._bullet, name)


def _reference(body: str) -> gymnasium.Env | None:
    if find_spec("pybullet_envs_gymnasium") is None:
        return None
    with hushed():
        from pybullet_envs_gymnasium import gym_locomotion_envs

        return getattr(gym_locomotion_envs, f"{body}BulletEnv")()


def microseconds(contestants: list[Contestant], repetitions: int) -> list[float]:
    """Mean time of a step; of each step, the shortest in `repetitions` turns."""
    best = [contestant.turn() for contestant in contestants]
    for _ in range(repetitions - 1):
        for i, contestant in enumerate(contestants):
            best[i] = np.minimum(best[i], contestant.turn())
    return [1e6 * seconds.mean() for seconds in best]


def locomotors(repetitions: int) -> Table:
    """Bare physics, ours, the reference."""
    table = Table(
        "A step of the locomotors, one core",
        f"Microseconds a step: the mean over one episode of at most {EPISODE} steps, and of each "
        f"step its shortest time in {repetitions} turns. All play the same episode, so have the "
        "same contacts; bare physics is stepSimulation alone in it. Version 5 starts or ends "
        f"otherwise, so has an episode of its own. The target is {TARGET} times bare physics.",
        ["robot", "bare physics", "ours", "ours / bare", "", "pybullet_envs_gymnasium"],
    )
    if find_spec("pybullet") is None:
        table.add("PyBullet is not installed", *["-"] * 5)
        return table
    for body in BODIES:
        for version in (0, 5):
            ours = Locomotor(body, version)
            contestants = [Bare(ours), Contestant(ours)]
            reference = _reference(body) if version == 0 else None
            if reference is not None:
                contestants.append(Contestant(reference))
            bare, own, *other = microseconds(contestants, repetitions)
            table.add(
                f"{body}-v{version}",
                f"{bare:.0f}",
                f"{own:.0f}",
                f"{own / bare:.2f}",
                verdict(own <= TARGET * bare),
                f"{other[0]:.0f}" if other else "-",
            )
            ours.close()
            if reference is not None:
                reference.close()
    return table


def two_workers(repetitions: int) -> Table:
    """A generation of each locomotor, in one process and in two."""
    table = Table(
        "A generation of the locomotors: two workers against one",
        f"Steps/s of the whole evaluation of {CANDIDATES} candidates around the robot of "
        f"data/genotypes; the fastest of {repetitions} calls each, taking turns. The target is "
        f"{TWO_WORKERS} times one.",
        ["robot", "steps / episode", "1 worker", "2 workers", "2 / 1", ""],
    )
    if find_spec("pybullet") is None:
        table.add("PyBullet is not installed", *["-"] * 5)
        return table
    for body in BODIES:
        noise = config.load(DATA / f"{body.lower()}.ini").algo.noiseStdDev
        own = Around(body.lower(), CANDIDATES, noise)
        steps = own.evaluate(2)  # starts the workers
        one, two = best_call([partial(own.evaluate, w) for w in (1, 2)], repetitions)
        table.add(
            *(body, f"{steps / CANDIDATES:.0f}", rate(one), rate(two)),
            *(f"{two / one:.2f}", verdict(two >= TWO_WORKERS * one)),
        )
        own.problem.close()
    return table


if __name__ == "__main__":
    locomotors(50).show(markdown=False)
    two_workers(3).show(markdown=False)
