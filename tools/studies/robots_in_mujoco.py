"""Play a robot of one's own in MuJoCo's own simulation of its file, nothing retrained.

    python tools/studies robots_in_mujoco FILE.ini GENOTYPE.npy

Ten starts as those of SpatialBody-v0, substeps of 2 ms. An episode ends when the root is below half
its height at the start.
"""

from __future__ import annotations

import argparse

import mujoco
import numpy as np

from botschool import config, problems

START = 0.02
"""Coordinates and speeds of a start are uniform within +- this."""


def world(path: str) -> mujoco.MjModel:
    """Return the model of a file, with a floor."""
    spec = mujoco.MjSpec.from_file(path)
    plane = mujoco.mjtGeom.mjGEOM_PLANE
    if not any(geom.type == plane for geom in spec.worldbody.geoms):
        spec.worldbody.add_geom(type=plane, size=[99, 99, 1])
    model = spec.compile()
    model.opt.timestep = 0.002
    return model


def way(model: mujoco.MjModel, problem, policy, seed: int, seconds: float) -> tuple[float, float]:
    """Return the metres ahead of an episode, and its seconds."""
    robot, data, rng = problem.robot, mujoco.MjData(model), np.random.default_rng(seed)
    low, home, high = robot.controls.T
    data.qpos[:] = [0, 0, robot.facts[0], *robot.pose]
    data.qpos[:] += rng.uniform(-START, START, model.nq)
    data.qpos[3:7] /= np.linalg.norm(data.qpos[3:7])
    data.qvel[:] = rng.uniform(-START, START, model.nv)
    policy.reset(seed, 0)
    while data.time < seconds and data.qpos[2] > robot.facts[0] / 2:
        action = np.clip(policy.act(np.concatenate([data.qpos[2:], data.qvel])), -1, 1)
        data.ctrl[:] = home + np.where(action > 0, action * (high - home), action * (home - low))
        mujoco.mj_step(model, data, nstep=round(1 / problem.fps / model.opt.timestep))
    return float(data.qpos[0]), float(data.time)


def main(arguments: list[str] | None = None) -> None:
    """Print the way of ten episodes, and how many are faster than 0.5 m/s to the end."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("experiment")
    parser.add_argument("genotype")
    parser.add_argument("--seconds", type=float, default=10.0)
    given = parser.parse_args(arguments)
    experiment = config.load(given.experiment)
    problem = problems.of(experiment)
    policy = problem.policy(experiment.policy)
    policy.load(*policy.split(np.load(given.genotype)))
    model = world(problem.robot.path)
    good = 0
    for seed in range(10):
        metres, lasted = way(model, problem, policy, seed, given.seconds)
        print(f"start {seed}: {metres:.2f} m in {lasted:.2f} s")
        good += lasted >= given.seconds and metres >= 0.5 * given.seconds
    print(f"{good} of 10 starts at 0.5 m/s or more for {given.seconds:g} s")
