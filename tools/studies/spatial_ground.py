"""Measure how far the native humanoid on the ground is from MuJoCo's, whose limbs pass through each
other: python tools/studies/spatial_ground.py. The specification quotes it ("Bodies in space").
"""

from __future__ import annotations

from pathlib import Path

import gymnasium
import mujoco
import numpy as np

from botschool import _core

SUBSTEP, SUBSTEPS, STEPS, EPISODES = 0.003, 5, 40, 100


def model_of() -> mujoco.MjModel:
    """Return Gymnasium's humanoid; its limbs touch the ground only."""
    assets = Path(gymnasium.__file__).parent / "envs" / "mujoco" / "assets"
    model = mujoco.MjModel.from_xml_path(str(assets / "humanoid.xml"))
    limbs = model.geom_bodyid > 0
    model.geom_contype[limbs], model.geom_conaffinity[limbs] = 1, 0
    model.geom_contype[~limbs], model.geom_conaffinity[~limbs] = 0, 1
    return model


def differences(strength: float) -> tuple[float, float]:
    """Return root mean squares after 0.6 s: of the height in m, of the hinges' angles in rad.

    strength: of random actions, as a share of their range.
    """
    model = model_of()
    data, body = mujoco.MjData(model), _core.SpatialBody("humanoid")
    rng, found = np.random.default_rng(1), []
    for _ in range(EPISODES):
        mujoco.mj_resetData(model, data)
        data.qpos[:] += rng.uniform(-0.01, 0.01, model.nq)
        data.qpos[3:7] /= np.linalg.norm(data.qpos[3:7])
        data.qpos[7:] = np.clip(data.qpos[7:], *model.jnt_range[1:].T)
        data.qvel[:] = rng.uniform(-0.01, 0.01, model.nv)
        state = np.zeros(body.size)
        state[: model.nq], state[model.nq : model.nq + model.nv] = data.qpos, data.qvel
        for _ in range(STEPS):
            action = strength * rng.uniform(*model.actuator_ctrlrange[0], model.nu)
            data.ctrl[:] = action
            mujoco.mj_step(model, data, SUBSTEPS)
            state = body.advance(state, action, SUBSTEP, SUBSTEPS)
        found.append(state[2 : model.nq] - data.qpos[2:])
    error = np.array(found)
    return float(np.sqrt((error[:, 0] ** 2).mean())), float(np.sqrt((error[:, 5:] ** 2).mean()))


if __name__ == "__main__":
    for words, strength in (("full actions", 1.0), ("none", 0.0)):
        height, angles = differences(strength)
        print(f"{words}: {1000 * height:.0f} mm, {angles:.3f} rad")
