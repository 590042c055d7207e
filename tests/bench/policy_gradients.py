"""How fast the native PPO learns: processor seconds to a goal, by the settings of defaults.yaml.

    python tests/bench/policy_gradients.py [PROBLEM ...]    a table; seeds 411 to 415
    python tests/bench/policy_gradients.py threads          two threads beside one

A training counts until 20 new episodes, played every 1 % of its steps, reach the goal; without a
goal, or for Pendulum and Acrobot, until its end. 100 further episodes are played then.
"""

from __future__ import annotations

import sys
import time
from dataclasses import dataclass

import numpy as np

from botschool.rl.model import choose
from botschool.rl.native import PPO

SEEDS = range(411, 416)


@dataclass(frozen=True)
class Goal:
    """What a training should reach, and within how many seconds of one core."""

    value: float | None
    seconds: float | None
    whole: bool = False
    """Whether all steps count, and the last agent."""


GOALS = {
    "CartPole-v1": Goal(500, 0.5),
    "Pendulum-v1": Goal(-200, 3, whole=True),
    "Acrobot-v1": Goal(-85, 1, whole=True),
    "botschool/PlanarHopper-v5": Goal(2000, 15),
    "botschool/PlanarHalfCheetah-v5": Goal(None, None, whole=True),
    "botschool/PlanarWalker2D-v5": Goal(None, None, whole=True),
}


def made(env: str, seed: int, threads: int = 1) -> tuple[PPO, int]:
    """An untrained agent with the settings of defaults.yaml, and the length of its training."""
    s = choose("ppo", env, engine="native")
    options = s.parameters
    return PPO(env, seed, s.envs, s.normalize, s.steps, threads, **options), s.steps


def measured(env: str, seed: int) -> tuple[int, float, float, float]:
    """Steps, seconds of one core, mean return in the last 20 new episodes, and in 100 others."""
    goal, start = GOALS[env], time.process_time()
    ppo, steps = made(env, seed)
    last, every, looked = -np.inf, max(1, steps // 100), 0
    while ppo.steps < steps:
        ppo.collect()
        ppo.update()
        if ppo.steps // every > looked and not goal.whole:
            looked = ppo.steps // every
            last = ppo.play(
                range(1_000_000 * seed + looked * 20, 1_000_000 * seed + looked * 20 + 20)
            )
            last = last[0].mean()
            if last >= goal.value:
                break
    seconds = time.process_time() - start
    if goal.whole:
        last = ppo.play(range(20))[0].mean()
    return ppo.steps, seconds, last, ppo.play(range(10_000_000, 10_000_100))[0].mean()


def compare_threads(env: str, updates: int = 40) -> None:
    """Seconds of the wall with one thread and with two, taking turns."""
    seconds: dict[int, list[float]] = {1: [], 2: []}
    for _ in range(3):
        for threads, found in seconds.items():
            ppo, _ = made(env, 1, threads)
            start = time.perf_counter()
            for _ in range(updates):
                ppo.collect()
                ppo.update()
            found.append(time.perf_counter() - start)
    one, two = min(seconds[1]), min(seconds[2])
    print(f"{env}: {one:.2f} s with one thread, {two:.2f} s with two: {one / two:.2f} times")


def main(names: list[str]) -> None:
    if names == ["threads"]:
        for env in GOALS:
            if "Planar" in env:
                compare_threads(env)
        return
    print("| problem | goal | steps | seconds of one core | reached | 100 new episodes |")
    print("|---|---|---|---|---|---|")
    made("CartPole-v1", 1)  # what is loaded once does not count
    for env in names or GOALS:
        goal, found = GOALS[env], [measured(env, seed) for seed in SEEDS]
        columns = list(zip(*found, strict=True))
        shown = [
            ", ".join(f"{each:.{d}f}" for each in c)
            for c, d in zip(columns, (0, 2, 1, 1), strict=True)
        ]
        aim = "-" if goal.value is None else f"{goal.value} in {goal.seconds} s"
        print(f"| {env} | {aim} | {' | '.join(shown)} |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
