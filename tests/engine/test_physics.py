"""Physics in numbers: what they change, and that the lanes and the environment agree."""

import gymnasium
import numpy as np
import pytest

import botschool
import botschool.envs
from botschool import BotschoolError, _core, config, problems
from botschool.problems.native import NativeProblem

WORLDS = (
    (
        "PlanarHopper-v5",
        "gravity=3.7, friction=0.4..1.2, mass=1.2, motors=0.8, delay=2, noise=0.02",
    ),
    ("PlanarHalfCheetah-v5", "push=30..60, slope=-0.1..0.1, bumps=0.05, delay=0..3"),
    ("PlanarWalker2D-v5", "step=0.1, stairs=0.05, firmness=0.5..2"),
    ("SpatialAnt-v5", "gravity=1.6..9.81, push=40, stairs=0.1, slope=0.05, noise=0.01..0.05"),
    ("SpatialHumanoid-v5", "mass=0.8..1.25, motors=0.8..1.25, bumps=0.02..0.05, delay=1"),
    ("SpatialBalanceBot-v0", "push=5, gravity=5..15, friction=0.5"),
)


def returns(environment, physics, instruction_set="", workers=1, n=24, seed=7, limit=80, **more):
    problem = NativeProblem(environment, instruction_set=instruction_set, physics=physics, **more)
    policy = problem.policy(config.PolicyConfig(nhiddens=5))
    genotypes = np.array([policy.initial(1, i) for i in range(n)])
    episodes = problems.Episodes.of([seed] * n, 1)
    return problem.evaluate(policy, genotypes, None, episodes, limit, workers).fitness


@pytest.mark.parametrize(("environment", "physics"), WORLDS)
def test_every_instruction_set_and_number_of_threads_has_the_same_world(environment, physics):
    sets = _core.instruction_sets()
    first = returns(environment, physics, sets[0])
    assert np.array_equal(first, returns(environment, physics, sets[-1], workers=2))
    assert not np.array_equal(first, returns(environment, ""))


@pytest.mark.parametrize(("environment", "physics"), WORLDS)
def test_the_environment_has_the_world_of_the_lanes(environment, physics):
    problem = NativeProblem(environment, physics=physics)
    policy = problem.policy(config.PolicyConfig(nhiddens=5))
    steps = list(problem.play(policy, policy.initial(3), None, 5, 0, 60))
    stepper = _core.make_stepper(problem.dynamics)
    stepper.set(problem.limit, problem.options())
    stepper.start(5, 0)
    for step in steps:
        assert stepper.step(np.asarray(step.action, float))[0] == step.reward


@pytest.mark.parametrize(
    ("environment", "older", "newer"),
    [
        ("PlanarHopper-v5", "vary='ground'", "firmness=0.5..2, friction=0.6..1.2"),
        ("PlanarHopper-v5", "vary='delay'", "delay=0..1"),
        ("SpatialAnt-v5", "vary='mass, motors'", "mass=0.8..1.25, motors=0.8..1.25"),
        ("SpatialAnt-v5", "vary='noise'", "noise=0.02"),
        ("SpatialAnt-v5", "slope=0.1, step=0.05, bumps=0.03", "slope=0.1, step=0.05, bumps=0.03"),
    ],
)  # fmt: skip
def test_words_of_vary_are_ranges_with_the_same_bits(environment, older, newer):
    assert np.array_equal(returns(environment, "", options=older), returns(environment, newer))


def test_numbers_do_what_they_say():
    """A body in the air falls with this gravity; a push moves it by force times time over mass."""
    env = gymnasium.make("botschool/PlanarHopper-v5", physics="gravity=3.7", ends="0")
    env.reset(seed=1)
    sim = env.unwrapped._simulation._stepper
    state = sim.state
    state[:] = 0
    state[1] = 5
    sim.state = state
    for _ in range(10):
        env.step(np.zeros(3, np.float32))
    assert sim.state[7] == pytest.approx(-3.7 * 10 * 0.008, rel=1e-4)

    pushed = gymnasium.make("botschool/SpatialAnt-v5", physics="push=100, gravity=0.01", ends="0")
    pushed.reset(seed=1)
    sim = pushed.unwrapped._simulation._stepper
    state = sim.state
    state[2] = 5
    sim.state = state
    before = sim.state[15:17].copy()
    for _ in range(20):  # a second
        pushed.step(np.zeros(8, np.float32))
    mass = sum(link["mass"] for link in _core.SpatialBody("ant").table["links"])
    speed = np.linalg.norm(sim.state[15:17] - before)
    assert 0.4 < speed / (100 * 0.1 / mass) < 1.6


def test_a_slope_and_stairs_carry_a_body_in_a_plane():
    for physics, height in (("slope=0.2", 0.2 * 3), ("stairs=0.1", 0.1 * 2 + 0.1)):
        env = gymnasium.make("botschool/PlanarHalfCheetah-v5", physics=physics, ends="0")
        env.reset(seed=1)
        sim = env.unwrapped._simulation._stepper
        state = sim.state
        state[:] = 0
        state[0], state[1] = 3.0, height + 0.75
        sim.state = state
        for _ in range(40):
            env.step(np.zeros(6, np.float32))
        level = gymnasium.make("botschool/PlanarHalfCheetah-v5")
        level.reset(seed=1)
        for _ in range(40):
            level.step(np.zeros(6, np.float32))
        rest = level.unwrapped._simulation.state[1]
        assert sim.state[1] == pytest.approx(rest + height, abs=0.15)


@pytest.mark.parametrize(
    ("physics", "sentence"),
    [
        ("gravty=3", "physics has no 'gravty': did you mean gravity?"),
        ("friction=2..1", "the smaller one first"),
        ("delay=1.5", "a whole number of steps"),
        ("mass=0", "from 0.1 to 10"),
        ("friction", "cannot be read"),
        ("mass=1, mass=2", "twice"),
    ],
)
def test_wrong_physics_is_one_sentence(physics, sentence):
    with pytest.raises(BotschoolError) as told:
        botschool.problem("PlanarHopper-v5", physics=physics)
    assert sentence in str(told.value) and "\n" not in str(told.value)


def test_only_bodies_have_physics():
    with pytest.raises(BotschoolError, match="has no physics in numbers"):
        botschool.problem("CartPole-v1", physics="gravity=3")


@pytest.mark.slow
def test_a_curve_over_a_number_is_one_command(command, refused, tmp_path):
    file = tmp_path / "own.ini"
    file.write_text("[EXP]\nenvironment = PlanarHopper-v5\n[POLICY]\nnhiddens = 2\nmaxsteps = 20\n")
    own = config.load(file)
    robot = tmp_path / "robot.npy"
    np.save(robot, problems.of(own).policy(own.policy).initial(1))
    again = ("landscape", file, "-g", robot, "--episodes", 2, "--points", 4)
    code, out, errors = command(*again, "--physics", "friction=0.5..2", "-o", tmp_path / "f.png")
    assert code == 0, errors
    assert out.count("friction ") == 4 and (tmp_path / "f.png").exists()
    refused(*again, "--physics", "friction=1", says=["one range"])
