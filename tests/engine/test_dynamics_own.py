"""Swing-up and double pole against their equations in docs/specification.md, "Classic
control"; how all problems start and end."""

import math

import gymnasium
import numpy as np
import pytest

from botschool import _core, problems
from botschool.config import PolicyConfig
from botschool.policies.policy import Policy

PI = math.pi


def native_step(stepper, state, action):
    """(next state, reward, ended, observation)."""
    stepper.state = state
    reward, ended = stepper.step(np.array([action]))
    return stepper.state, reward, ended, stepper.observation


def swingup_step(state, action):
    """Cart and pole as a Lagrangian system: the pole is a rod, theta = 0 upright, x to the right.

    mass matrix * (x'', theta'') = forces, with a rod's centre at half its length and its moment of
    inertia m l^2 / 3 about the hinge; explicit Euler.
    """
    cart, pole, length, gravity, friction = 0.5, 0.5, 0.6, 9.82, 0.1
    _, v, theta, omega = state
    sine, cosine = math.sin(theta), math.cos(theta)
    half = pole * length / 2
    # a pole at angle theta leans to negative x: its tip is at x - length sin(theta)
    matrix = [[cart + pole, -half * cosine], [-half * cosine, pole * length**2 / 3]]
    forces = [
        10 * np.clip(action, -1, 1) - friction * v - half * omega**2 * sine,
        half * gravity * sine,
    ]
    linear, angular = np.linalg.solve(matrix, forces)
    return np.array(state) + 0.01 * np.array([v, linear, omega, angular])


@pytest.mark.slow
def test_swingup_follows_its_equations():
    rng = np.random.default_rng(1)
    stepper = _core.make_stepper("envSwingupCustom")
    for _ in range(10_000):
        state, action = rng.uniform([-2.5, -6, -9, -15], [2.5, 6, 9, 15]), rng.uniform(-2, 2)
        after, reward, ended, observation = native_step(stepper, state, action)
        expected = swingup_step(state, action)
        assert after == pytest.approx(expected, rel=1e-9, abs=1e-9)
        x, v, theta, omega = after
        assert reward == pytest.approx((math.cos(theta) + 1) / 2 * math.cos(x / 2.4 * PI / 2))
        assert ended == (abs(x) > 2.4)
        seen = [x, v, math.cos(theta), math.sin(theta), omega]
        assert observation == pytest.approx(seen, abs=1e-12)


CART, HALF, MASS, HINGE = 1.0, [0.5, 0.25], [0.1, 0.05], 2e-6


def double_pole_slopes(y, force, gravity=-9.8, hinge=HINGE):
    """Accelerations of cart and poles from the Lagrangian's linear system.

    A pole of half-length l and mass m has the moment of inertia 4/3 m l^2 about its hinge, and
    friction there opposes its turning.
    """
    _, v, angle1, omega1, angle2, omega2 = y
    matrix, forces = np.zeros((3, 3)), np.zeros(3)
    matrix[0, 0], forces[0] = CART + sum(MASS), force
    for p, (angle, omega) in enumerate([(angle1, omega1), (angle2, omega2)]):
        sine, cosine = math.sin(angle), math.cos(angle)
        moment = MASS[p] * HALF[p]
        matrix[0, 1 + p] = matrix[1 + p, 0] = moment * cosine
        matrix[1 + p, 1 + p] = 4 / 3 * moment * HALF[p]
        forces[0] += moment * omega**2 * sine
        forces[1 + p] = -moment * gravity * sine - hinge * omega
    linear, angular1, angular2 = np.linalg.solve(matrix, forces)
    return np.array([v, linear, omega1, angular1, omega2, angular2])


def double_pole_step(state, action):
    y, h = np.array(state), 0.01
    for _ in range(2):
        k1 = double_pole_slopes(y, 10 * action)
        k2 = double_pole_slopes(y + h / 2 * k1, 10 * action)
        k3 = double_pole_slopes(y + h / 2 * k2, 10 * action)
        k4 = double_pole_slopes(y + h * k3, 10 * action)
        y = y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return y


@pytest.mark.slow
def test_double_pole_follows_its_equations():
    rng = np.random.default_rng(2)
    stepper = _core.make_stepper("ErDpole")
    ends = 0
    for _ in range(2000):
        state = rng.uniform(-1, 1, size=6) * [2.5, 3, 0.65, 3, 0.65, 3]
        action = rng.uniform(-2, 2)  # not clipped
        after, reward, ended, observation = native_step(stepper, state, action)
        assert after == pytest.approx(double_pole_step(state, action), rel=1e-9, abs=1e-9)
        assert observation == pytest.approx(after[[0, 2, 4]] / [4.8, 0.52, 0.52], abs=1e-12)
        assert ended == (abs(after[0]) > 2.4 or max(abs(after[[2, 4]])) > 0.628329)
        assert reward == (0 if ended else 1)
        ends += ended
    assert 200 < ends < 1800


# What a fresh episode's state is drawn from: (low, high) of uniform values, or (mean, sd).
STARTS = {
    "CartPole-v1": [(-0.05, 0.05)] * 4,
    "Pendulum-v1": [(-PI, PI), (-1, 1)],
    "Acrobot-v1": [(-0.1, 0.1)] * 4,
    "MountainCarContinuous-v0": [(-0.6, -0.4), (0, 0)],
    "ErDpole": [(-1.944, 1.944), (-1.215, 1.215)]
    + [(-0.10472, 0.10472), (-0.135088, 0.135088)] * 2,
}


def starts(name, count=4000):
    stepper = _core.make_stepper(name)
    rows = []
    for k in range(count):
        stepper.start(k // 100, k % 100)
        rows.append(stepper.state)
    return np.array(rows)


@pytest.mark.parametrize("name", [name for name in STARTS if name != "ErDpole"])
def test_start_states_are_those_of_gymnasium(name):
    env = gymnasium.make(name).unwrapped
    theirs = []
    for seed in range(1000):
        env.reset(seed=seed)
        theirs.append(np.array(env.state, dtype=float))
    theirs, ours = np.array(theirs), starts(name)
    assert ours.mean(axis=0) == pytest.approx(theirs.mean(axis=0), abs=0.15 * max(theirs.std(0)))
    assert ours.std(axis=0) == pytest.approx(theirs.std(axis=0), rel=0.1)


# (state, action, whether the step ends the episode); thresholds just missed and just passed
ENDS = [
    ("CartPole-v1", [2.4 - 1e-9, 0, 0, 0], 0, False),
    ("CartPole-v1", [2.4 + 1e-9, 0, 0, 0], 0, True),
    ("CartPole-v1", [-2.4 - 1e-9, 0, 0, 0], 0, True),
    ("CartPole-v1", [0, 0, 12 * PI / 180 - 1e-9, 0], 0, False),
    ("CartPole-v1", [0, 0, 12 * PI / 180 + 1e-9, 0], 0, True),
    ("CartPole-v1", [0, 0, -12 * PI / 180 - 1e-9, 0], 0, True),
    ("CartPole-v1", [2.4 - 1e-9, 1, 0, 0], 0, True),
    ("envSwingupCustom", [2.4 - 1e-9, 0, 3, 0], 1, False),
    ("envSwingupCustom", [2.4 + 1e-9, 0, 3, 0], 1, True),
    ("envSwingupCustom", [-2.4 - 1e-9, 0, 3, 0], 1, True),
    ("envSwingupCustom", [0, 0, 100, 30], 1, False),
    ("ErDpole", [2.395, 0, 0, 0, 0, 0], 0, False),
    ("ErDpole", [2.401, 0, 0, 0, 0, 0], 0, True),
    ("ErDpole", [-2.401, 0, 0, 0, 0, 0], 0, True),
    ("ErDpole", [0, 0, 0.62, 0, 0, 0], 0, False),
    ("ErDpole", [0, 0, 0.63, 0, 0, 0], 0, True),
    ("ErDpole", [0, 0, 0, 0, 0.61, 0], 0, False),
    ("ErDpole", [0, 0, 0, 0, -0.63, 0], 0, True),
    ("Pendulum-v1", [PI, 8], 2, False),
    ("Acrobot-v1", [PI, 0, 0, 0], 1, True),
    ("Acrobot-v1", [0, 0, 0, 0], 1, False),
]


@pytest.mark.parametrize(("name", "state", "action", "ends"), ENDS)
def test_where_episodes_end(name, state, action, ends):
    stepper = _core.make_stepper(name)
    _, _, ended, _ = native_step(stepper, np.array(state, dtype=float), float(action))
    assert ended == ends


LIMITS = {
    "CartPole-v0": 200,
    "CartPole-v1": 500,
    "Pendulum-v0": 200,
    "Pendulum-v1": 200,
    "Acrobot-v1": 500,
    "MountainCarContinuous-v0": 999,
    "envSwingupCustom": 1000,
    "ErDpole": 1000,
    "ErDiscrim": 500,
    "ErPredprey": 2000,
    "ErStaybehind": 500,
    "ErArena": 1000,
    "PlanarBodyBrain-v0": 1000,
    **{
        f"Planar{body}-v{version}": 1000
        for body in ("Hopper", "Walker2D", "HalfCheetah")
        for version in (0, 5)
    },
    **{f"Spatial{body}-v{version}": 1000 for body in ("Ant", "Humanoid") for version in (0, 5)},
    "SpatialHumanoidStandup-v0": 1000,
    "SpatialBody-v0": 1000,
    "SpatialBalanceBot-v0": 500,
}


@pytest.mark.parametrize("name", LIMITS)
def test_longest_episodes(name):
    problem = problems.make(name)
    assert problem.limit == LIMITS[name]
    assert set(problems.names()) == set(LIMITS)
    config = PolicyConfig(nhiddens=0, nrobots=problem.interface.robots)
    policy = Policy(name, problem.interface, config)
    lengths = set()
    for maxsteps in (1, 7, 5000):
        genotypes = np.zeros((1, policy.genotype_size))
        episodes = problems.Episodes.of(np.arange(1), 5)
        outcome = problem.evaluate(policy, genotypes, None, episodes, maxsteps)
        longest = min(maxsteps, LIMITS[name])
        assert np.all(outcome.steps <= longest)
        if maxsteps < 8 or name.startswith(("Pendulum", "Mountain", "Acro")):
            assert np.all(outcome.steps == longest) or name == "ErDpole"
        lengths |= set(outcome.steps.tolist())
        played = list(problem.play(policy, genotypes[0], None, 0, 0, maxsteps))
        assert len(played) == outcome.steps[0]
        assert played[-1].total == outcome.fitness[0]
    assert len(lengths) > 2
