"""Declared arenas: what robots sense and are paid against an independent account; the same bits
whoever computes them; how they start; what users see of them."""

import dataclasses

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from hypothesis import given
from hypothesis import strategies as st

import botschool.envs.native
from botschool import _core, arena, config, problems
from botschool.arenas.plan import Cylinder, Light, Plan, Robot, Wall, Zone
from botschool.arenas.section import REWARDS, WORDS
from botschool.config import PolicyConfig
from botschool.evolution.run import Run, evolve
from botschool.policies.policy import Policy
from botschool.problems.native import NativeProblem
from botschool.render.scenes import make_scene, scene_of
from reference_arena import KHEPERA, MARXBOT, Declared, World
from reference_network import REPEATABLE
from running import run_seeds, same, write_experiment

NEAR = {"rel": 0, "abs": 1e-9}
BODIES = {"Khepera": KHEPERA, "marXbot": MARXBOT}
FULL = Plan(
    width=1500,
    height=1000,
    robots=[Robot("marXbot", speed=300), Robot("Khepera", heading=90), Robot("Khepera")],
    walls=[Wall(400, 0, 400, 500), Wall(1000, 400, 1200, 700)],
    cylinders=[Cylinder(radius=30), Cylinder(radius=60)],
    lights=[Light(), Light(x=700, y=(100, 900))],
    zones=[Zone(radius=150, shade=0.5), Zone(radius=250)],
    sensors=WORDS["sensors"],
    laser_beams=7,
    laser_angle=150,
    laser_range=300,
    light_distance=150,
    distance=150,
)
"""Everything that there is."""


def reference(own):
    """A declared arena as it stands, for the independent account."""
    cylinders, walls = own.objects[: own.cylinders], own.objects[own.cylinders :]
    world = World(
        [BODIES[model.name] for model in own.models], [model.speed for model in own.models],
        own.robots, walls[:, :4], cylinders[:, [0, 1, 4]],
    )  # fmt: skip
    return Declared(world, own.plan, own.lights, own.zones)


# what robots sense and are paid


@pytest.mark.slow
@REPEATABLE
@given(
    st.integers(0, 10**6), st.integers(1, 32), st.sampled_from([30.0, 90.0, 200.0, 360.0]),
    st.floats(20, 2000), st.floats(20, 2000),
)  # fmt: skip
def test_sensors_follow_the_reference(seed, beams, angle, reach, half):
    plan = dataclasses.replace(
        FULL, laser_beams=beams, laser_angle=angle, laser_range=reach, light_distance=half
    )
    own = arena.make(plan, max_steps=10)
    seen = own.reset(seed=seed)
    expected = [value for robot in range(3) for value in reference(own).observation(robot, 0.0)]
    assert seen == pytest.approx(expected, **NEAR)


@pytest.mark.slow
@pytest.mark.parametrize("reward", REWARDS)
def test_rewards_follow_the_reference(reward):
    near = 700 if reward == "together" else 150
    zones = [Zone(radius=400), Zone(radius=450)]
    plan = dataclasses.replace(FULL, reward=reward, zones=zones, distance=near)
    rng = np.random.default_rng(3)
    own = arena.make(plan, max_steps=10**6)
    rewards = []
    for seed in range(40):
        own.reset(seed=seed)
        visited = set()
        reference(own).paid(own.robots, own.action, [""] * 3, visited)
        for _ in range(25):
            before, world = own.robots.copy(), reference(own)
            own.action = np.repeat(rng.uniform(-0.3, 1.1, 3), 2) + rng.normal(0, 0.1, 6)
            action = own.action.copy()
            rewards.append(own.step())
            bumps = [world.world.drive(r, *action[2 * r : 2 * r + 2]) for r in range(3)]
            assert own.robots[:, :2] == pytest.approx(np.array(world.world.poses)[:, :2], **NEAR)
            expected = world.paid(before, action, bumps, visited)
            assert rewards[-1] == pytest.approx(expected, **NEAR)
            assert not own.terminated
    assert len(set(rewards)) > 1


# collisions, starts, ends


def test_starts_are_drawn_within_their_ranges_and_fit():
    plan = Plan(
        robots=[Robot(x=(50, 200), y=(100, 300), heading=(90, 180)), Robot("e-puck", y=60)],
        walls=[Wall(0, 200, 250, 200)],
        cylinders=[Cylinder(x=(40, 360), radius=40)],
        zones=[Zone(radius=60), Zone(radius=60)],
    )
    own, poses = arena.make(plan), []
    for seed in range(300):
        own.reset(seed=seed)
        own.sense()  # refuses what overlaps
        gap = np.hypot(*(own.zones[0] - own.zones[1]))
        assert gap >= 120 and own.objects[0, 4] == 40
        poses.append(own.robots.copy())
    poses = np.array(poses)
    assert np.all((poses[:, 0] >= [50, 100, np.pi / 2]) & (poses[:, 0] <= [200, 300, np.pi]))
    assert np.all(np.ptp(poses[:, 0], axis=0) > [130, 180, 1.4])
    assert np.all(poses[:, 1, 1] == 60)


# the same bits


def policy_of(plan, **choices):
    robots = len(plan.robots)
    choices = {"nrobots": robots, "nhiddens": 6, "architecture": 3, "normalize": 1} | choices
    return Policy("ErArena", NativeProblem("ErArena", plan=plan).interface, PolicyConfig(**choices))


@pytest.mark.parametrize("reward", ["avoid", "explore", "near-light", "together"])
def test_returns_depend_on_the_episode_alone(reward):
    plan = dataclasses.replace(FULL, noise=0.05, reward=reward, distance=500)
    policy = policy_of(plan)
    genotypes = np.array([policy.initial(1, i) for i in range(7)])
    vectors = np.repeat([0.1, 0.5], policy.spec.inputs)
    episodes = problems.Episodes.of(np.arange(7) + 2**40, 6)
    episodes.collect = np.ones(len(episodes), np.uint8)

    def outcome(isa, chosen=slice(None), workers=1):
        problem = NativeProblem("ErArena", plan=plan, instruction_set=isa)
        part = episodes.select(chosen)
        found = problem.evaluate(policy, genotypes, vectors, part, 120, workers)
        return found.fitness, found.steps, found.moments

    expected = outcome("baseline")
    assert len(np.unique(expected[0])) > 5
    order = np.random.default_rng(1).permutation(len(episodes))
    for isa in _core.instruction_sets():
        for workers in (1, 3):
            assert all(map(np.array_equal, outcome(isa, workers=workers), expected))
        assert all(map(np.array_equal, outcome(isa, order), [x[order] for x in expected]))
        for i in (0, 17, 41):
            one = slice(i, i + 1)
            assert all(map(np.array_equal, outcome(isa, one), [x[one] for x in expected]))


def test_an_episode_is_that_of_the_arena_by_hand():
    plan = dataclasses.replace(FULL, noise=0.05, reward="explore")
    policy = policy_of(plan, heterogeneous=1)
    tape = list(NativeProblem("ErArena", plan=plan).play(
        policy, policy.initial(2), np.repeat([0.0, 1.0], policy.spec.inputs), 9, 3, 100
    ))  # fmt: skip
    own = arena.make(plan, max_steps=100)
    own.reset(9, 3)
    for step in tape:
        assert step.observation == pytest.approx(own.observation, abs=1e-4)
        own.action = step.action
        assert own.step() == step.reward
        assert np.array_equal(own.state, step.state)


ARENA = """
[ARENA]
width = 600
robot1 = e-puck, x 100 to 300
robot2 = Khepera
zone1 = radius 150
sensors = infrared, ground, camera
reward = on-zone
"""


def declared(folder, **options):
    """A very small experiment with a declared arena: its file."""
    policy = {"nrobots": 2, "architecture": 3, "normalize": 1, "clip": 1}
    path = write_experiment(folder, "ErArena", "OpenAI-ES", policy, **options)
    path.write_text(path.read_text() + ARENA)
    return path


def test_runs_are_the_same_whoever_computes_them(tmp_path):
    own = config.load(declared(tmp_path))
    assert run_seeds(own, tmp_path / "1")
    assert run_seeds(own, tmp_path / "3", workers=3)
    assert same(tmp_path / "1", tmp_path / "3")
    for steps in (700, 1500, 2500):
        run_seeds(own, tmp_path / "parts", steps=steps, resume=True)
    assert run_seeds(own, tmp_path / "parts", resume=True)
    assert same(tmp_path / "1", tmp_path / "parts")
    for isa in _core.instruction_sets():
        run = Run(own, 1)
        run.problem = NativeProblem("ErArena", plan=own.plan, instruction_set=isa)
        run.evaluator.problem = run.problem
        (tmp_path / isa).mkdir()
        assert evolve(run, tmp_path / isa)
        assert same(tmp_path / "1", tmp_path / isa)


def test_a_run_goes_on_in_its_own_arena_only(tmp_path, refused):
    path = declared(tmp_path)
    run_seeds(config.load(path), tmp_path / "results", steps=500)
    path.write_text(path.read_text().replace("radius 150", "radius 140"))
    refused(
        "es", "-f", path, "-o", tmp_path / "results", "--resume",
        says=["zone1 = radius 150", "now radius 140"],
    )  # fmt: skip


# what users see


@pytest.mark.slow
def test_the_command_evolves_shows_and_replays(tmp_path, command):
    path = declared(tmp_path)
    code, _, errors = command("es", "-f", path, "-o", tmp_path)
    assert (code, errors) == (0, "")
    robot = tmp_path / "bestgS1.npy"
    for flag in ("--replay=a.html", "--video=a.gif"):
        flag = flag.replace("=", f"={tmp_path}/")
        code, out, errors = command("es", "-f", path, "-p", "-g", robot, flag, "--episodes", 1)
        assert code == 0 and "mean" in out, errors
    assert "robot 1" in (tmp_path / "a.html").read_text()
    assert (tmp_path / "a.gif").stat().st_size > 1000


def test_pictures_show_what_is_declared():
    """Each thing and each sensor changes the picture."""
    own = arena.make(FULL)
    own.reset(seed=3)

    def frame(plan, state):
        problem = NativeProblem("ErArena", plan=plan)
        seen = own.observation if plan is FULL else None
        return scene_of(problem).draw(state, own.action, seen)

    full = frame(FULL, own.state)
    assert full.shape[0] < full.shape[1]  # 1000 x 1500
    for name in ("lights", "zones", "cylinders", "walls"):
        less = dataclasses.replace(FULL, **{name: ()}, sensors="infrared")
        assert (frame(less, own.state) != full).sum() > 100
    blind = make_scene("ErArena", FULL.models, FULL).draw(own.state, own.action)
    assert (blind != full).sum() > 1000


def test_the_gymnasium_face(tmp_path):
    plan = dataclasses.replace(FULL, robots=["marXbot"], sensors=("laser", "light"), noise=0.01)
    env = gymnasium.make("botschool/Arena-v0", render_mode="rgb_array", arena=plan)
    assert env.spec.max_episode_steps == 1000
    check_env(env.unwrapped)
    assert env.observation_space.shape == (15,)
    with pytest.raises(botschool.errors.BotschoolError, match="but this arena has 2"):
        botschool.envs.native.NativeEnv("ErArena", arena=declared(tmp_path))
