"""Give short episodes of PyBullet's locomotors and their rewards, simulated or recorded."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from botschool.course.files import episode_file

RECORDED = "locomotors.npz"
"""Episodes with seed 1, for use without PyBullet; made by `tools/studies record_locomotors`."""
STEPS = 30


class Paid(NamedTuple):
    """An episode with random actions."""

    trajectory: dict
    """The trajectory, as exercise 9 describes it."""
    v0: dict[str, np.ndarray]
    """The components of the reward of version 0, each of shape (T,)."""
    v5: np.ndarray
    """The reward of version 5, shape (T,)."""


def paid_episode(robot: str, seed: int) -> Paid:
    """Return an episode of Hopper, HalfCheetah, Ant, Walker2D or Humanoid, in version 5.

    Without PyBullet, return the recorded episode, whatever the seed.
    """
    return simulated(robot, seed) if find_spec("pybullet") else recorded(robot)


def simulated(robot: str, seed: int) -> Paid:
    """Simulate an episode with PyBullet. Raises BotschoolError if it is not installed."""
    from botschool.envs.locomotors import STEP, Locomotor

    env, rng = Locomotor(robot, 5), np.random.default_rng(seed)
    env.reset(seed=seed)
    rows, infos, rewards = [env.measured()], [], []
    while len(rewards) < STEPS:
        action = rng.uniform(-1, 1, env.action_space.shape).astype(np.float32)
        _, reward, ended, _, info = env.step(action)
        rows.append({**env.measured(), "actions": action})
        infos.append(info["v0"])
        rewards.append(reward)
        if ended:
            break
    env.close()
    one = {key: np.array([row[key] for row in rows[1:]], dtype=float) for key in rows[-1]}
    one["distance"] = np.array([row["distance"] for row in rows])
    v0 = {key: np.array([info[key] for info in infos]) for key in infos[0]}
    return Paid({**one, "robot": robot, "duration": STEP}, v0, np.array(rewards))


def recorded(robot: str) -> Paid:
    """Return the episode from data/episodes. Raises BotschoolError outside a course."""
    from botschool.envs.locomotors import STEP

    parts: dict[str, dict[str, np.ndarray]] = {"trajectory": {}, "v0": {}, "v5": {}}
    with np.load(episode_file(RECORDED), allow_pickle=False) as file:
        for name in file.files:
            owner, part, key = name.split("/")
            if owner == robot:
                parts[part][key] = file[name]
    trajectory = {**parts["trajectory"], "robot": robot, "duration": STEP}
    return Paid(trajectory, parts["v0"], parts["v5"]["reward"])


def write_recordings(file: str | Path) -> None:
    """Simulate an episode of each robot and write all of them to a file."""
    from botschool.envs.locomotor_bodies import BODIES

    arrays: dict[str, Any] = {}
    for robot in BODIES:
        one = simulated(robot, seed=1)
        for key, value in one.trajectory.items():
            if isinstance(value, np.ndarray):
                arrays[f"{robot}/trajectory/{key}"] = value
        arrays |= {f"{robot}/v0/{key}": value for key, value in one.v0.items()}
        arrays[f"{robot}/v5/reward"] = one.v5
    np.savez_compressed(file, **arrays)
