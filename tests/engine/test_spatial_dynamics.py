"""Physics of bodies in space: docs/specification.md, "Bodies in space"."""

from __future__ import annotations

from pathlib import Path

import gymnasium
import numpy as np
import pytest

from botschool import _core

mujoco = pytest.importorskip("mujoco")
ASSETS = Path(gymnasium.__file__).parent / "envs" / "mujoco" / "assets"
BODIES = ["ant", "humanoid", "humanoidstandup"]
SUBSTEP = {"ant": 0.005, "humanoid": 0.003, "humanoidstandup": 0.003, "ball": 0.003, "box": 0.003}


def model_of(name):
    """MuJoCo's model of a body in the air, without limits of hinges."""
    model = mujoco.MjModel.from_xml_path(str(ASSETS / f"{name}.xml"))
    off = mujoco.mjtDisableBit
    model.opt.disableflags |= off.mjDSBL_CONTACT | off.mjDSBL_LIMIT
    return model, mujoco.MjData(model)


def random_states(model, count, seed=0):
    rng = np.random.default_rng(seed)
    for _ in range(count):
        position = model.qpos0 + rng.uniform(-0.7, 0.7, model.nq)
        position[3:7] = rng.normal(size=4)
        position[3:7] /= np.linalg.norm(position[3:7])
        action = rng.uniform(*model.actuator_ctrlrange[0], model.nu)
        yield position, rng.normal(0, 3, model.nv), action


@pytest.mark.parametrize("name", BODIES)
def test_it_moves_as_in_mujoco(name):
    """Accelerations, mass matrix, centre of mass and places of links at 1,000 states."""
    model, data = model_of(name)
    body = _core.SpatialBody(name)
    links = body.table["links"]
    mass = np.array([link["mass"] for link in links])
    matrix = np.zeros((model.nv, model.nv))
    for position, speed, action in random_states(model, 1000):
        data.qpos[:], data.qvel[:], data.ctrl[:] = position, speed, action
        mujoco.mj_forward(model, data)
        found = body.accelerations(position, speed, action)
        assert np.abs(found - data.qacc).max() <= 1e-9 * np.abs(data.qacc).max()
        mujoco.mj_fullM(model, matrix, data.qM)
        found = body.mass_matrix(position)
        assert np.abs(found - matrix).max() <= 1e-9 * np.abs(matrix).max()
        places = body.places(position)
        centres = [
            p[0] + np.array(link["centre"]) @ p[1:] for p, link in zip(places, links, strict=True)
        ]
        assert mass @ centres / mass.sum() == pytest.approx(data.subtree_com[1], abs=1e-9)


def at(name, height, **rows):
    """A body at rest, and its state with some rows set."""
    body = _core.SpatialBody(name)
    state = np.zeros(body.size)
    state[2], state[3] = height, 1
    for key, value in rows.items():
        row = {"vx": 0, "vz": 2, "spin": 4}[key] + body.coordinates
        state[row] = value
    return body, state


def loads(body, state):
    return state[-len(body.table["balls"]) :]


def moved(body, state, seconds, h, action=None, **options):
    action = np.zeros(body.table["motors"]) if action is None else action
    return body.advance(state, action, h, round(seconds / h), **options)


@pytest.mark.parametrize("h", [0.005, 0.003, 0.001])
def test_a_ball_falls_slides_and_rolls(h):
    body, state = at("ball", 2.0)
    fallen = moved(body, state, 120 * h, h)
    assert fallen[2] == pytest.approx(2 - 9.81 / 2 * (120 * h) ** 2, abs=1e-9)
    body, state = at("ball", 0.1, vx=2.0)  # it slides first, and rolls with 5/7 of its speed then
    rolling = moved(body, state, 0.6, h)
    n = body.coordinates
    assert rolling[n] == pytest.approx(2 * 5 / 7, rel=1e-6)
    assert rolling[n + 4] == pytest.approx(rolling[n] / 0.1, rel=1e-6)
    sunk = 0.1 - rolling[2]
    assert sunk == pytest.approx(2 * 9.81 / 40000, rel=1e-3)  # as deep as one that lies
    assert loads(body, rolling)[0] == pytest.approx(2 * 9.81, rel=1e-3)


def standing(name):
    body, state = at(name, 1.0)
    if name == "ant":
        state[7:15] = [0, 0.8, 0, -0.8, 0, -0.8, 0, 0.8]
    else:
        links = body.table["links"][1:]
        state[7 : body.coordinates] = [
            min(max(0, link["range"][0]), link["range"][1]) for link in links
        ]
    places = body.places(state[: body.coordinates])
    lowest = min(
        (places[link][0] + np.array(place) @ places[link][1:])[2] - radius
        for link, place, radius, _ in body.table["balls"]
    )
    state[2] -= lowest
    return body, state


def energy(body, state, stiffness=0.0):
    n, links = body.coordinates, body.table["links"]
    speed = state[n : n + body.speeds]
    places = body.places(state[:n])
    height = [
        (p[0] + np.array(link["centre"]) @ p[1:])[2] for p, link in zip(places, links, strict=True)
    ]
    springs = sum(
        link["stiffness"] * angle**2 / 2 for link, angle in zip(links[1:], state[7:n], strict=True)
    )
    mass = np.array([link["mass"] for link in links])
    return speed @ body.mass_matrix(state[:n]) @ speed / 2 + 9.81 * mass @ height + springs


@pytest.mark.parametrize("name", ["ball", "box", "ant", "humanoid"])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_energy_never_grows(name, seed):
    """Of a body that is thrown, falls, bounces, slides and comes to rest."""
    rng = np.random.default_rng(seed)
    body, state = standing(name)
    state[2] += 0.5
    n = body.coordinates
    state[3:7] = rng.normal(size=4)
    state[3:7] /= np.linalg.norm(state[3:7])
    state[n : n + 6] = rng.normal(0, 2, 6)
    before = energy(body, state)
    whole = before
    for _ in range(300):
        state = body.advance(state, np.zeros(body.table["motors"]), SUBSTEP[name], 4)
        now = energy(body, state)
        # springs of ground and limits give back what they have stored: little, and less than before
        assert now < before + 0.02 * abs(whole)
        before = min(before, now)
    assert before < 0.7 * whole


def test_free_motion_keeps_energy_and_momentum():
    """Terms that are quadratic in the speeds are of second order."""
    body, state = at("box", 100.0)
    n = body.coordinates
    state[n : n + 6] = [1, 0, 0, 3, 8, 1]
    errors = []
    for h in (0.004, 0.002):
        after = body.advance(state, np.zeros(0), h, round(2 / h), 0.0)
        kinetic = [
            s[n : n + 6] @ body.mass_matrix(s[:n]) @ s[n : n + 6] / 2 for s in (state, after)
        ]
        errors.append(abs(kinetic[1] / kinetic[0] - 1))
    assert errors[0] < 0.02
    assert errors[1] < 0.35 * errors[0]


@pytest.mark.parametrize("ground", [[0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1], [-0.1, 0.05, 0.05]])
def test_a_ball_lies_on_any_ground(ground):
    """It never sinks through it, and rolls down."""
    body, state = at("ball", 1.0, vx=1.5)
    state[0] = 1.0
    for _ in range(200):
        state = moved(body, state, 0.015, 0.003, ground=ground)
        x, y, z = state[:3]
        wave = [[4.1, 5.3], [7.9, 6.7]]
        height = ground[0] * x + ground[1] * np.clip((x - 2) / 0.05, 0, 1)
        height += ground[2] / 2 * sum(np.sin(a * x) * np.sin(b * y) for a, b in wave)
        assert z > height - 0.005
    assert np.isfinite(state).all()


def test_the_table_of_a_body_is_checked():
    with pytest.raises(ValueError, match="no body in space 'cat'"):
        _core.SpatialBody("cat")
    body, state = at("ball", 1.0)
    with pytest.raises(ValueError, match="the state has 3 values"):
        body.advance(np.zeros(3), np.zeros(0), 0.01)
    with pytest.raises(ValueError, match="above 0"):
        body.advance(state, np.zeros(0), 0.0)
