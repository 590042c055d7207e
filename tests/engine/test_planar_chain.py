"""How PlanarBodyBrain's chain moves: docs/specification.md, "PlanarBodyBrain"."""

from __future__ import annotations

import math

import numpy as np
import pytest

from botschool import _core
from botschool.envs.morphology import MORPHOLOGY_SIZE, decode
from test_planar_dynamics import full_mass_matrix, mjcf

G = 10.0
BODIES = 0.6 * np.random.default_rng(1).normal(size=(3, MORPHOLOGY_SIZE))
STRAIGHT = np.zeros(MORPHOLOGY_SIZE)
LIMITS = slice(22, 42)
RODS = 11


def start_angles(parameters):
    """Of the torso, and of each rod against the one before, within the limits."""
    body = decode(parameters)
    return body.angles + np.append(0.0, np.clip(0.0, *body.limits.T))


def test_parameters_mean_what_they_mean_to_box2ds_chain():
    for p in (STRAIGHT, *BODIES, 1e6 * np.ones(64), -1e6 * np.ones(64)):
        body, table = decode(p), _core.PlanarBody(p).table
        masses = body.densities * body.lengths * body.thicknesses
        inertias = masses * (body.lengths**2 + body.thicknesses**2) / 12
        expected = np.stack([masses, body.lengths / 2, np.zeros(RODS), inertias], axis=1)
        assert table["masses"] == pytest.approx(expected, rel=1e-9, abs=1e-12)
        for i, rod in enumerate(table["segments"]):
            ((x, z, angle, half, radius),) = rod["capsules"]
            assert (x, z, angle) == (half, 0, 0) and rod["parent"] == i - 1
            assert 2 * half == pytest.approx(body.lengths[i])
            assert 2 * radius == pytest.approx(body.thicknesses[i])
            if i:
                assert rod["x"] == pytest.approx(body.lengths[i - 1])
                wanted = body.angles[i] + body.limits[i - 1]
                assert rod["range"] == pytest.approx(wanted, abs=1e-12)
        ends = [(c[0], c[1], c[3]) for c in table["contacts"]]
        wanted = [(c // 2, c % 2 * body.lengths[c // 2]) for c in range(2 * RODS)]
        assert np.array(ends)[:, :2] == pytest.approx(np.array(wanted))
        assert np.array(ends)[:, 2] == pytest.approx(np.repeat(body.thicknesses, 2) / 2)


def motor_torques(action, rates):
    """5 rad/s in the direction of the action, with at most 90 N m times its size."""
    strength, gap = 90 * np.minimum(np.abs(action), 1), 5 * np.sign(action) - rates
    return strength * gap / np.maximum(np.abs(gap), 0.5)


@pytest.mark.parametrize("number", range(10))
def test_accelerations_and_mass_matrix_are_those_of_mujoco(number):
    """At 1,000 random states of each of ten bodies, with motors and dampers, without contacts."""
    mujoco = pytest.importorskip("mujoco")
    rng = np.random.default_rng(number)
    p = rng.normal(0, 1, MORPHOLOGY_SIZE)
    p[LIMITS] = np.tile([-1.0, 1.0], 10)
    chain = _core.PlanarBody(p)
    rest = np.array([np.mean(rod["range"]) for rod in chain.table["segments"][1:]])
    model = mujoco.MjModel.from_xml_string(mjcf(chain.table, gravity=G, capsules=False))
    data = mujoco.MjData(model)
    form = np.eye(chain.size)  # (x, z, absolute angles) = form (x, z, angle, hinge angles)
    form[2:, 2:] = np.tri(RODS)
    for _ in range(1000):
        q, v = rng.uniform(-1, 1, chain.size), rng.normal(0, 4, chain.size)
        q[2] *= math.pi
        q[3:] = rest + q[3:] * math.pi / 2 * 0.999
        action = rng.uniform(-1.2, 1.2, RODS - 1)
        data.qpos, data.qvel = q, v
        data.qfrc_applied[3:] = motor_torques(action, v[3:])
        mujoco.mj_forward(model, data)
        theirs = full_mass_matrix(mujoco, model, data)
        ours = form.T @ chain.mass_matrix(form @ q) @ form
        assert np.abs(ours - theirs).max() <= 1e-9 * np.abs(theirs).max()
        acceleration = np.linalg.solve(form, chain.accelerations(form @ q, form @ v, action, G))
        assert np.abs(acceleration - data.qacc).max() <= 1e-9 * np.abs(data.qacc).max()
