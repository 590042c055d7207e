"""The chain of BodyBrain as a native problem: docs/specification.md, "PlanarBodyBrain"."""

from __future__ import annotations

import math

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import botschool.envs  # noqa: F401 (registers the environments)
from botschool import _core, problems
from botschool.config import PolicyConfig
from botschool.envs.morphology import MORPHOLOGY_SIZE, decode
from botschool.errors import BotschoolError
from botschool.policy import Policy
from botschool.problems import Episodes
from botschool.render.replay import write_replay
from botschool.render.scenes import make_scene
from botschool.render.scenes.planarbodybrain import PIECE, START, ChainState
from test_replay import held, unpacked

NAME = "PlanarBodyBrain-v0"
ID = f"botschool/{NAME}"
G = 10.0
BODIES = 0.6 * np.random.default_rng(1).normal(size=(3, MORPHOLOGY_SIZE))
STRAIGHT = np.zeros(MORPHOLOGY_SIZE)
LIMITS = slice(22, 42)
RODS = 11


def turned(vector, angle):
    (x, z), c, s = vector, math.cos(angle), math.sin(angle)
    return np.array([x * c - z * s, x * s + z * c])


def start_angles(parameters):
    """Of the torso, and of each rod against the one before, within the limits."""
    body = decode(parameters)
    return body.angles + np.append(0.0, np.clip(0.0, *body.limits.T))


# ------------------------------------------------------------------- physics
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


def mjcf(table):
    """The same chain for MuJoCo, without contacts, limits and motors."""

    def body(i):
        rod = table["segments"][i]
        mass, x, z, inertia = table["masses"][i].tolist()
        text = f'<body pos="{rod["x"]!r} 0 0">'
        if i == 0:
            text += '<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>'
        text += f'<joint type="hinge" axis="0 -1 0" limited="false" damping="{rod["damping"]!r}" '
        text += f'armature="{rod["armature"]!r}"/>'
        text += f'<inertial pos="{x!r} 0 {z!r}" mass="{mass!r}" '
        text += f'diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>'
        if i + 1 < RODS:
            text += body(i + 1)
        return text + "</body>"

    return f"""<mujoco><option gravity="0 0 -{G}"><flag contact="disable"/></option>
    <worldbody>{body(0)}</worldbody></mujoco>"""


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
    model = mujoco.MjModel.from_xml_string(mjcf(chain.table))
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
        theirs = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, theirs, data.qM)
        ours = form.T @ chain.mass_matrix(form @ q) @ form
        assert np.abs(ours - theirs).max() <= 1e-9 * np.abs(theirs).max()
        acceleration = np.linalg.solve(form, chain.accelerations(form @ q, form @ v, action, G))
        assert np.abs(acceleration - data.qacc).max() <= 1e-9 * np.abs(data.qacc).max()


class Moving:
    """A chain that is simulated, with its state at hand."""

    def __init__(self, parameters, height=5.0, single=False):
        self.body, self.single = _core.PlanarBody(parameters), single
        self.masses, self.lengths = self.body.table["masses"], decode(parameters).lengths
        self.q, self.v = np.zeros((2, self.body.size))
        self.q[1] = height
        self.q[2:] = np.cumsum(start_angles(parameters))
        self.load = np.zeros(2 * RODS)

    def advance(self, h, steps, action=None, **around):
        action = np.zeros(RODS - 1) if action is None else action
        state = np.concatenate([self.q, self.v])
        options = {"gravity": G, "single": self.single} | around
        state, self.load = self.body.advance(state, action, h, steps, **options)
        self.q, self.v = state.reshape(2, -1)

    def along(self):
        """From the rear to the front end of each rod."""
        return np.array([turned((length, 0), a) for length, a in zip(self.lengths, self.q[2:])])  # noqa: B905

    def lift(self, gap):
        """So that the lowest ball is `gap` above the ground."""
        self.q[1] = 0
        radii = np.array([contact[3] for contact in self.body.table["contacts"]])
        rears = np.concatenate([[0.0], np.cumsum(self.along()[:, 1])])
        self.q[1] = gap - (np.stack([rears[:-1], rears[1:]], axis=1).ravel() - radii).min()

    def centres(self):
        along = self.along()
        return self.q[:2] + np.cumsum(along, axis=0) - along / 2

    def energy(self):
        kinetic = self.v @ self.body.mass_matrix(self.q) @ self.v / 2
        return kinetic + G * self.masses[:, 0] @ self.centres()[:, 1]

    def momentum(self):
        """Along x and z, and the angular momentum about the centre of mass."""
        generalised = self.body.mass_matrix(self.q) @ self.v
        arm = self.masses[:, 0] @ self.centres() / self.masses[:, 0].sum() - self.q[:2]
        turning = generalised[2:].sum() - (arm[0] * generalised[1] - arm[1] * generalised[0])
        return np.array([*generalised[:2], turning])


def test_momentum_is_kept_in_flight():
    """While motors and limits work, but for an error of second order in the substep."""
    for p in BODIES:
        errors = []
        for h in (0.001, 0.00025):
            flying = Moving(p, height=100.0)
            rng = np.random.default_rng(3)
            flying.v[:] = rng.normal(0, 1, flying.body.size)
            flying.advance(h, round(0.02 / h))
            start, worst = flying.momentum(), 0.0
            weight = flying.masses[:, 0].sum() * G
            for k in range(1, 51):
                flying.advance(h, round(0.02 / h), rng.uniform(-0.3, 0.3, RODS - 1))
                fallen = np.array([0, -weight * 0.02 * k, 0])
                lost = np.abs(flying.momentum() - start - fallen).max()
                worst = max(worst, lost / np.abs(start).max())
            errors.append(worst)
        assert errors[0] < 0.05 and errors[1] < 0.005 and errors[0] > 6 * errors[1]


def test_a_stick_rests_on_the_ground_and_slides_from_its_friction_angle_on():
    lying = Moving(STRAIGHT, height=0.11)
    lying.advance(0.001, 2000)
    there = lying.q.copy()
    assert np.abs(lying.v).max() < 1e-3
    lying.advance(0.001, 2000)
    assert lying.q == pytest.approx(there, abs=1e-4)
    assert lying.load.sum() == pytest.approx(lying.masses[:, 0].sum() * G, rel=1e-3)
    for share, slides in ((0.9, False), (1.1, True)):  # friction is 2.5
        angle = math.atan(2.5 * share)
        lying = Moving(STRAIGHT, height=0.1 / math.cos(angle))
        lying.q[2:] = angle
        lying.advance(0.001, 500, slope=2.5 * share)
        before = lying.v[:2].copy()
        lying.advance(0.001, 500, slope=2.5 * share)
        gain = np.hypot(*lying.v[:2]) - np.hypot(*before)
        down = G * (math.sin(angle) - 2.5 * math.cos(angle))
        assert gain / 0.5 == pytest.approx(down if slides else 0, abs=0.05)


def test_a_fall_loses_energy():
    for p in BODIES:
        falling = Moving(p)
        falling.lift(3.0)
        start = falling.energy()
        for _ in range(300):
            falling.advance(0.001, 10)
            assert falling.energy() < start * 1.02
        assert falling.energy() < 0.5 * start


def test_half_the_substep_stays_near():
    """Positions of twelve bodies after 0.4 s of work on the ground, against an eighth of it."""
    errors = []
    for p in 0.6 * np.random.default_rng(5).normal(size=(12, MORPHOLOGY_SIZE)):
        ends = []
        for part in (1, 2, 8):
            body = Moving(p)
            body.lift(0.1)
            body.advance(0.001 / part, 400 * part, np.full(RODS - 1, 0.05))
            ends.append(body.q)
        errors.append([np.abs(end - ends[2]).max() for end in ends[:2]])
    whole, half = np.median(errors, axis=0)
    assert half < whole < 0.02 and np.max(errors) < 0.2


# ------------------------------------------------------------------- problem
def stepped(parameters, seed=0, strength=1.0, steps=400):
    """Steps of an episode with random actions: (state before, action, state, reward, ended)."""
    stepper = _core.make_stepper(NAME)
    stepper.set_body(np.asarray(parameters))
    stepper.start(seed)
    rng = np.random.default_rng(seed)
    for _ in range(steps):
        before, action = stepper.state, strength * rng.uniform(-1.5, 1.5, RODS - 1)
        reward, ended = stepper.step(action)
        yield before, action, stepper.state, reward, ended
        if ended:
            return


def torso(parts):
    """The middle of the torso."""
    return parts.rears()[:2].mean(axis=0)


def worth(parts):
    return 130 * torso(parts)[0] / 30 - 5 * abs(parts.position[2])


def test_a_state_holds_body_and_ground():
    stepper = _core.make_stepper(NAME)
    pushed = []
    for seed, p in enumerate((STRAIGHT, *BODIES)):
        stepper.set_body(p)
        stepper.start(seed)
        parts, body = ChainState(stepper.state), decode(p)
        assert parts.lengths == pytest.approx(body.lengths)
        assert parts.thicknesses == pytest.approx(body.thicknesses)
        assert parts.densities == pytest.approx(body.densities)
        assert parts.angles == pytest.approx(body.angles, abs=1e-12)
        limits = np.stack([parts.low, parts.high], axis=1)
        assert limits == pytest.approx(body.limits, abs=1e-12)
        # the ground: even, then slopes that are forgotten slowly and pulled back to height 0
        assert len(parts.heights) == 161 and parts.heights[0] == 0
        slopes = np.diff(parts.heights, prepend=[0.0])
        push = slopes[1:] - 0.8 * slopes[:-1] + 0.01 * np.sign(parts.heights[:-1])
        assert np.all(np.abs(push) < 1 / 15 + 1e-12)
        pushed.append(push)
    assert np.std(pushed) == pytest.approx(1 / 15 / math.sqrt(3), rel=0.1)
    assert len(np.unique(np.round(pushed, 9))) == 4 * 160


def test_starts_stand_above_the_even_ground():
    stepper = _core.make_stepper(NAME)
    for seed, p in enumerate((STRAIGHT, *BODIES)):
        stepper.set_body(p)
        stepper.start(seed)
        parts = ChainState(stepper.state)
        assert not parts.speed.any() and not parts.load.any()
        assert parts.position[2:] == pytest.approx(np.cumsum(start_angles(p)), abs=1e-12)
        rears, radii = parts.rears(), np.repeat(parts.thicknesses, 2) / 2
        ends = np.stack([rears[:-1], rears[1:]], axis=1).reshape(-1, 2)
        left, right = (ends[:, 0] - radii).min(), (ends[:, 0] + radii).max()
        assert (left + right) / 2 == pytest.approx(20 * 14 / 30)
        assert (ends[:, 1] - radii).min() == pytest.approx(0.1)


def test_rewards_and_observations():
    touched = 0
    for p in BODIES:
        rest = decode(p).angles
        stepper = _core.make_stepper(NAME)
        for before, _, state, reward, ended in stepped(p, 2):
            parts = ChainState(state)
            gain = worth(parts) - worth(ChainState(before))
            assert reward == pytest.approx(gain, abs=2e-4) and not ended
            stepper.state = state
            angle, turning = parts.position[2], parts.speed[2]
            moving = parts.speed[:2] + turning * turned((0, parts.lengths[0] / 2), angle)
            touching = parts.load.reshape(-1, 2).sum(axis=1) > 0
            hinges = np.stack(
                [np.diff(parts.position[2:]) - rest[1:], np.diff(parts.speed[2:]) / 5], axis=1
            )
            wanted = [
                angle, 0.04 * turning, 0.3 * moving[0], 0.12 * moving[1], touching[0],
                *hinges.ravel(), *touching[1:],
            ]  # fmt: skip
            assert stepper.observation == pytest.approx(np.array(wanted, float), abs=1e-9)
            touched |= touching
    assert np.all(touched)
    low, high = stepper.bounds
    flags = np.r_[4, 25:35]
    assert (low[flags] == 0).all() and (high[flags] == 1).all()
    assert np.isinf(np.delete(low, flags)).all() and np.isinf(np.delete(high, flags)).all()


def test_hinges_keep_to_their_limits():
    p = np.zeros(MORPHOLOGY_SIZE)
    p[LIMITS] = np.tile([0.4, -0.2], 10)  # the smaller is the lower one
    p[42:53] = 0.1
    stepper = _core.make_stepper(NAME)
    stepper.set_body(p)
    stepper.start(1)
    angles = []
    for sign in (1.0, -1.0):
        for _ in range(60):
            stepper.step(np.full(RODS - 1, sign))
        angles.append(stepper.observation[5:25:2])
    assert np.all(angles[0] < 0.2 * np.pi + 0.05) and np.all(angles[1] > -0.1 * np.pi - 0.05)
    assert np.any(angles[0] > 0.5) and np.any(angles[1] < -0.25)


def test_the_ends_of_the_ground():
    stepper = _core.make_stepper(NAME)
    stepper.set_body(BODIES[0])
    for place, expected in ((-0.5, (-100, True)), (93.5, (None, True)), (92.5, (None, False))):
        stepper.start(1)
        state = stepper.state
        state[0] += place - torso(ChainState(state))[0]
        state[1] += 20
        stepper.state = state
        reward, ended = stepper.step(np.zeros(RODS - 1))
        assert ended == expected[1]
        assert reward == expected[0] or (expected[0] is None and abs(reward) < 5)


def test_broken_physics_end_the_episode():
    """The state stays what it was, so that it can be drawn."""
    stepper = _core.make_stepper(NAME)
    for row, value in ((1, np.nan), (3, np.inf), (15, 1e30)):
        stepper.start(0)
        state = stepper.state
        state[row] = value
        stepper.state = state
        assert stepper.step(np.zeros(RODS - 1)) == (-100, True)
        assert np.array_equal(stepper.state, state, equal_nan=True)
    for action in (1e30, -np.inf, np.nan):
        stepper.start(0)
        stepper.step(np.full(RODS - 1, action))
        assert np.isfinite(stepper.state).all()


def test_extreme_bodies_hold_together():
    """Long beside short, thin beside thick, at full torque to and fro."""
    rng = np.random.default_rng(4)
    lowest = 0.0
    for seed in range(20):
        p = rng.choice([-3.0, 3.0], MORPHOLOGY_SIZE)
        stepper = _core.make_stepper(NAME)
        stepper.set_body(p)
        stepper.start(seed)
        for step in range(200):
            _, ended = stepper.step(np.sign(rng.normal(size=RODS - 1)))
            parts = ChainState(stepper.state)
            assert not ended or torso(parts)[0] < 0, (seed, step)
            rears = parts.rears()
            lowest = min(lowest, (rears[:, 1] - parts.ground(rears[:, 0])).min())
            if ended:
                break
    assert -0.2 < lowest < 0  # nothing sinks in


# ------------------------------------------------------------------ evolution
def policy_of(nhiddens=5):
    problem = problems.make(NAME)
    return problem, Policy(NAME, problem.interface, PolicyConfig(nhiddens=nhiddens, bias=1))


def bodies_of(policy):
    genotypes = np.array([policy.initial(1, i) for i in range(6)])
    genotypes[:, -64:] = np.tile(BODIES, (2, 1))
    genotypes[:, :-64] *= 3
    return genotypes


def test_the_tail_of_a_genotype_is_the_body():
    problem, policy = policy_of()
    assert policy.genotype_size == policy.nparameters + 64
    assert not policy.initial(1)[-64:].any()
    genotypes = bodies_of(policy)
    steps = list(problem.play(policy, genotypes[1], None, 7, 2, 50))
    assert ChainState(steps[0].state).lengths == pytest.approx(decode(BODIES[1]).lengths)
    stepper = _core.make_stepper(NAME)
    stepper.set_body(BODIES[1])
    stepper.start(7, 2)
    for step in steps:
        reward, _ = stepper.step(np.asarray(step.action, dtype=float))
        assert reward == step.reward
        assert np.array_equal(stepper.state, step.state)


def test_lanes_keep_their_bodies_apart():
    """Whatever the batch, the order and the instruction set; the same bits."""
    _, policy = policy_of()
    genotypes = bodies_of(policy)
    expected = None
    for isa in _core.instruction_sets():
        problem = problems.native.NativeProblem(NAME, instruction_set=isa)
        batch = problem.evaluate(policy, genotypes, None, Episodes.of(np.arange(6), 7), 60)
        if expected is None:
            expected = batch.fitness
            assert len(np.unique(expected[::7])) == 6
        assert batch.fitness.tobytes() == expected.tobytes()
        for i in range(6):
            alone = Episodes.of(np.array([i]), 7)
            outcome = problem.evaluate(policy, genotypes[i : i + 1], None, alone, 60)
            assert outcome.fitness.tobytes() == expected[7 * i : 7 * i + 7].tobytes()


def test_a_genotype_without_a_body_is_refused():
    problem, policy = policy_of()
    with pytest.raises(ValueError, match="are needed"):
        problem.engine(policy).record(np.zeros((1, policy.nparameters)), None, 1, 0, 10)


# -------------------------------------------------------------------- pictures
@pytest.mark.filterwarnings("ignore:.*(minimum|maximum) value.*infinity")
def test_gymnasium_accepts_it():
    env = gymnasium.make(ID, render_mode="rgb_array", morphology=BODIES[0])
    check_env(env.unwrapped, skip_render_check=False)
    assert env.spec.max_episode_steps == 1000 and env.unwrapped.metadata["render_fps"] == 50
    first = env.reset(seed=1)[0]
    frame = env.render()
    assert frame.shape == (300, 600, 3) and frame.std() > 10
    env.unwrapped.set_morphology(BODIES[1])
    assert not np.array_equal(env.reset(seed=1)[0], first)
    assert (env.render() != frame).any()
    for wrong in (np.zeros(63), np.full(64, np.nan), np.zeros((8, 8)), ["a"] * 64):
        with pytest.raises(BotschoolError, match="64 finite numbers"):
            env.unwrapped.set_morphology(wrong)
    env.close()


def test_pictures_show_rods_ground_and_contacts():
    scene = make_scene(NAME)
    for _, _, state, _, _ in stepped(BODIES[0], 1):
        touching = ChainState(state).load.reshape(-1, 2).sum(axis=1) > 0
        if touching.any() and not touching.all():
            break
    numbers, parts = scene.numbers(state), ChainState(state)
    ((label, lines),) = scene.charted
    touching = parts.load.reshape(-1, 2).sum(axis=1) > 0
    assert label == "ground" and [numbers[i] for i in lines] == touching.tolist()
    assert touching.any() and not touching.all()
    # each rod's shapes are where it is, the ground's pieces join
    camera = np.array([parts.rears()[:, 0].mean(), 0])
    rods = [shape for shape in scene.shapes if shape.height is not None]
    for shape, i in zip(rods, reversed(range(RODS)), strict=True):
        corners = shape.placed(numbers)
        assert np.ptp(corners @ turned((1, 0), parts.position[2 + i])) == pytest.approx(
            parts.lengths[i]
        )
        sides = corners[[0, 3]].mean(axis=0), corners[[1, 2]].mean(axis=0)
        apart = np.array(sides) - (parts.rears()[i : i + 2] - camera)
        assert apart[:, 0] == pytest.approx(0, abs=1e-9) and np.ptp(apart[:, 1]) < 1e-9
    lines = [s for s in scene.shapes if s.kind == "line" and s.size is not None]
    pieces = np.array(sorted(line.placed(numbers).tolist() for line in lines))
    assert pieces[1:, 0] == pytest.approx(pieces[:-1, 1], abs=1e-9)
    assert pieces[0, 0, 0] <= -10 + 1e-9 and pieces[-1, 1, 0] >= 10
    lift = numbers[scene.shapes[0].pose + 1] - float(
        parts.ground(numbers[scene.shapes[0].pose] + camera[0])
    )
    heights = parts.ground(pieces[:, 0, 0] + camera[0])
    assert pieces[:, 0, 1] - lift == pytest.approx(heights, abs=1e-9)
    state[0] = START + 40.2 * PIECE
    assert (scene.draw(state) != scene.draw(without_contacts(state))).any()


def without_contacts(state):
    """The same without contacts."""
    state = state.copy()
    state[26:48] = 0
    return state


def test_replays_chart_the_contacts_below_the_neurons(tmp_path):
    problem, policy = policy_of()
    steps = list(problem.play(policy, bodies_of(policy)[2], None, 3, 0, 60))
    spec = policy.spec
    write_replay(
        tmp_path / "a.html", NAME, "a robot", [steps], 50.0,
        (spec.inputs, spec.outputs), make_scene(NAME),
    )  # fmt: skip
    data = held(tmp_path / "a.html")
    assert data["groups"][-1] == ["ground", RODS]
    charted = unpacked(data["episodes"][0]["activations"])[:, -RODS:]
    for row, step in zip(charted, steps, strict=True):
        touching = ChainState(step.state).load.reshape(-1, 2).sum(axis=1) > 0
        assert row.round(3).tolist() == touching.tolist()
    assert charted.any()
