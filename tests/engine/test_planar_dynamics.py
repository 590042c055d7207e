"""Planar jointed bodies (docs/specification.md, "Planar runners") against MuJoCo and mechanics."""

from __future__ import annotations

import math
from pathlib import Path

import gymnasium
import numpy as np
import pytest

from botschool import _core

SUBSTEPS = {"hopper": (0.001, 8), "walker2d": (0.0005, 16), "halfcheetah": (0.002, 25)}
"""Seconds of a substep, and how many make a step."""
RUNNERS = list(SUBSTEPS)
G = 9.81


def hinge_form(table):
    """The matrix T with (x, z, absolute angles) = T (x, z, pitch, hinge angles)."""
    parents = [segment["parent"] for segment in table["segments"]]
    matrix = np.eye(len(parents) + 2)
    for i, parent in enumerate(parents[1:], start=1):
        matrix[2 + i] += matrix[2 + parent]
    return matrix


def random_states(table, rng):
    """Positions in hinge form within the hinges' limits, and speeds."""
    q = rng.uniform(-1, 1, len(table["segments"]) + 2)
    q[2] = rng.uniform(-math.pi, math.pi)
    for i, segment in enumerate(table["segments"][1:], start=3):
        q[i] = rng.uniform(*np.clip(segment["range"], -math.pi, math.pi))
    return q, rng.normal(0, 4, len(q))


def mjcf(table, total_mass=None, gravity=G, capsules=True):
    """The same body for MuJoCo, without contacts: its masses computed there from the capsules, or
    those of the table, then without motors."""
    segments = table["segments"]

    def body(i):
        segment = segments[i]
        text = f'<body pos="{segment["x"]!r} 0 {segment["z"]!r}">'
        if i == 0:
            text += '<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>'
        options = "".join(f'{k}="{segment[k]!r}" ' for k in ("damping", "stiffness", "armature"))
        text += f'<joint name="j{i}" type="hinge" axis="0 -1 0" limited="false" {options}/>'
        mass, x, z, inertia = table["masses"][i].tolist()
        if not capsules:
            text += f'<inertial pos="{x!r} 0 {z!r}" mass="{mass!r}" '
            text += f'diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>'
        for x, z, angle, half, radius in segment["capsules"] if capsules else ():
            dx, dz = half * math.cos(angle), half * math.sin(angle)
            ends = f"{x - dx!r} 0 {z - dz!r} {x + dx!r} 0 {z + dz!r}"
            text += f'<geom type="capsule" fromto="{ends}" size="{radius!r}"/>'
        for child, other in enumerate(segments):
            if other["parent"] == i:
                text += body(child)
        return text + "</body>"

    motors = "".join(
        f'<motor joint="j{i}" gear="{segment["torque"]!r}"/>'
        for i, segment in enumerate(segments)
        if i > 0 and capsules
    )
    mass = f'settotalmass="{total_mass}"' if total_mass else ""
    return f"""<mujoco><compiler angle="radian" inertiafromgeom="auto" {mass}/>
    <option gravity="0 0 -{gravity}"><flag contact="disable"/></option>
    <default><geom density="1000"/></default>
    <worldbody>{body(0)}</worldbody><actuator>{motors}</actuator></mujoco>"""


def full_mass_matrix(mujoco, model, data):
    matrix = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, matrix, data.qM)
    return matrix


@pytest.mark.slow
@pytest.mark.parametrize("name", RUNNERS)
def test_accelerations_and_mass_matrix_are_those_of_mujoco(name):
    """At 10,000 random states, with motors, dampers and springs, without contacts."""
    mujoco = pytest.importorskip("mujoco")
    body = _core.PlanarBody(name)
    total = 14 if name == "halfcheetah" else None
    model = mujoco.MjModel.from_xml_string(mjcf(body.table, total))
    data = mujoco.MjData(model)
    form = hinge_form(body.table)
    rng = np.random.default_rng(1)
    for _ in range(10_000):
        q, v = random_states(body.table, rng)
        action = rng.uniform(-1, 1, body.size - 3)
        data.qpos, data.qvel, data.ctrl = q, v, action
        mujoco.mj_forward(model, data)
        theirs = full_mass_matrix(mujoco, model, data)
        ours = form.T @ body.mass_matrix(form @ q) @ form
        assert np.abs(ours - theirs).max() <= 1e-9 * np.abs(theirs).max()
        acceleration = np.linalg.inv(form) @ body.accelerations(form @ q, form @ v, action)
        error = np.abs(acceleration - data.qacc).max()
        assert error <= 1e-9 * np.abs(data.qacc).max()


@pytest.mark.parametrize(
    ("name", "model", "flipped"),
    [
        ("hopper", "hopper", False),
        ("walker2d", "walker2d", False),
        ("halfcheetah", "half_cheetah", True),
    ],
)
def test_bodies_are_those_of_gymnasium(name, model, flipped):
    """Mass matrix and hinges of the models that come with Gymnasium."""
    mujoco = pytest.importorskip("mujoco")
    assets = Path(gymnasium.__file__).parent / "envs" / "mujoco" / "assets"
    model = mujoco.MjModel.from_xml_path(str(assets / f"{model}.xml"))
    data = mujoco.MjData(model)
    body = _core.PlanarBody(name)
    form = hinge_form(body.table)
    # there the pitch, and a cheetah's hinges, count clockwise
    signs = np.ones(body.size)
    signs[2] = -1
    signs[3:] = -1 if flipped else 1
    rng = np.random.default_rng(2)
    for _ in range(100):
        q, v = random_states(body.table, rng)
        data.qpos, data.qvel = signs * q, signs * v
        mujoco.mj_forward(model, data)
        theirs = full_mass_matrix(mujoco, model, data) * np.outer(signs, signs)
        ours = form.T @ body.mass_matrix(form @ q) @ form
        assert np.abs(ours - theirs).max() <= 1e-9 * np.abs(theirs).max()
    for i, segment in enumerate(body.table["segments"][1:], start=3):
        ends = np.sort(signs[i] * model.jnt_range[i])
        assert ends == pytest.approx(segment["range"])
        assert model.dof_damping[i] == segment["damping"]
        assert model.jnt_stiffness[i] == segment["stiffness"]
        assert model.actuator_gear[i - 3, 0] == segment["torque"]


class Moving:
    """A body that is simulated, with its state at hand."""

    def __init__(self, name, angles=(), height=5.0, single=False, gravity=G):
        self.body = _core.PlanarBody(name)
        self.masses = self.body.table["masses"]
        self.single, self.gravity = single, gravity
        self.q, self.v = np.zeros((2, self.body.size))
        self.q[1] = height
        self.q[2 : 2 + len(angles)] = angles
        self.load = np.zeros(0)

    def advance(self, h, steps, action=None, **around):
        action = np.zeros(self.body.size - 3) if action is None else action
        state = np.concatenate([self.q, self.v])
        options = {"single": self.single, "gravity": self.gravity} | around
        state, self.load = self.body.advance(state, action, h, steps, **options)
        self.q, self.v = state.reshape(2, -1)

    def origins(self):
        """Where the segments begin, (segments, 2)."""
        found = []
        for i, segment in enumerate(self.body.table["segments"]):
            origin = self.q[:2]
            if i:
                parent = segment["parent"]
                origin = found[parent] + turned(segment["x"], segment["z"], self.q[2 + parent])
            found.append(origin)
        return np.array(found)

    def centres(self):
        """Centres of mass of the segments, (segments, 2)."""
        arms = [turned(*mass[1:3], a) for mass, a in zip(self.masses, self.q[2:], strict=True)]
        return self.origins() + arms

    def energy(self):
        kinetic = self.v @ self.body.mass_matrix(self.q) @ self.v / 2
        springs = sum(
            segment["stiffness"] * (self.q[2 + i] - self.q[2 + segment["parent"]]) ** 2 / 2
            for i, segment in enumerate(self.body.table["segments"][1:], start=1)
        )
        return kinetic + springs + self.gravity * self.masses[:, 0] @ self.centres()[:, 1]

    def momentum(self):
        """Along x and z, and the angular momentum about the centre of mass."""
        generalised = self.body.mass_matrix(self.q) @ self.v
        arm = self.masses[:, 0] @ self.centres() / self.masses[:, 0].sum() - self.q[:2]
        turning = generalised[2:].sum() - (arm[0] * generalised[1] - arm[1] * generalised[0])
        return np.array([*generalised[:2], turning])


def turned(x, z, angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([x * c - z * s, x * s + z * c])


def swing(name, angle, **options):
    """A body hung up by its root, all its segments at this angle, and the energy it can lose."""
    body = Moving(f"hung {name}", **options)
    lowest = body.energy()
    body.q[2:] = angle
    return body, body.energy() - lowest


@pytest.mark.parametrize("single", [False, True])
@pytest.mark.parametrize("angle", [0.8, 1.5, 2.5])
@pytest.mark.parametrize("name", RUNNERS)
def test_a_free_swing_keeps_its_energy(name, angle, single):
    """To 0.1 % for 10 s, at the runners' substeps."""
    seconds, steps = SUBSTEPS[name]
    body, scale = swing(name, angle, single=single)
    start = body.energy()
    turns = 0
    for _ in range(round(10 / seconds / steps)):
        before = body.v[2]
        body.advance(seconds, steps)
        turns += before * body.v[2] < 0
        assert abs(body.energy() - start) < 1e-3 * scale
    assert turns >= 4


@pytest.mark.parametrize("depth", [0.0002, 0.0008, 0.003])
@pytest.mark.parametrize("speed", [-0.05, 0.02, 1.0])
@pytest.mark.parametrize(("name", "radius"), [("box", 0.05), (np.zeros(64), 0.1)])
def test_a_contact_is_a_spring_with_a_damper_that_is_whole_from_a_millimetre_on(
    name, radius, depth, speed
):
    """A box stands on two of its four corners, a straight chain lies on both ends of each rod; a
    contact never pulls."""
    body = Moving(name, height=radius - depth)
    body.v[1] = speed
    body.advance(1e-9, 1)
    push = 30000 * depth - 600 * min(depth / 0.001, 1) * speed
    touching = slice(2) if radius == 0.05 else slice(None)
    assert body.load[touching] == pytest.approx(max(push, 0), rel=1e-4)
    assert body.load.sum() == pytest.approx(body.load[touching].sum())


@pytest.mark.parametrize("share", [0.5, 0.9, 1.1, 2.0])
def test_a_box_slides_from_its_friction_angle_on(share):
    """On a plane whose slope is `share` of the friction coefficient, 0.5."""
    slope = 0.5 * share
    angle = math.atan(slope)
    box = Moving("box", [angle], height=0.05 / math.cos(angle))
    box.advance(0.001, 500, slope=slope)
    before = np.hypot(*box.v[:2])
    box.advance(0.001, 500, slope=slope)
    speed = np.hypot(*box.v[:2])
    if share < 1:
        assert speed < 0.01  # it creeps: friction grows with the speed up to there
        assert speed == pytest.approx(before, rel=0.01)
        assert box.q[2] == pytest.approx(angle, abs=0.02)
    else:
        down = G * (math.sin(angle) - 0.5 * math.cos(angle))
        assert (speed - before) / 0.5 == pytest.approx(down, rel=0.02)
