"""Grader of exercise 9; run it with `botschool grade 9`.

All tasks compare with our solution, on random trajectories, in which everything happens, and on
real ones. Where PyBullet is not installed, recorded episodes stand in. Nothing is left to chance:
an evolution depends on environment, steps and seed alone, so task 9.6 does it again.
"""

from functools import cache

import numpy as np

from botschool.course.locomotion import Runner
from botschool.course.recordings import paid_episode
from botschool.grading import Exercise, same, seed_of

exercise = Exercise(
    9,
    "Reward functions",
    file="reward_functions.py",
    imports=("botschool.course.locomotion", "botschool.evolution.run"),
)
ROBOTS = {"Hopper": 3, "HalfCheetah": 6, "Ant": 8, "Walker2D": 6, "Humanoid": 17}
"""Joints."""
PLANAR = {"PlanarHopper": (3, 1), "PlanarWalker2D": (6, 2), "PlanarHalfCheetah": (6, 2)}
"""Joints and feet."""
SIZES = (4, 20, 40)
"""Steps of a trajectory; long ones go up to the limits."""


def between(rng, low, high, shape):
    """Numbers like 0.15 and 0.25, so none that is at a limit."""
    return (rng.integers(10 * low, 10 * high, shape) + 0.5) / 10


def way(rng, steps):
    """Distances from the target, and the duration of a step."""
    distance = 1000 - np.cumsum(rng.normal(0.03, 0.08, steps + 1))
    return np.round(distance, 2), round(float(rng.uniform(0.004, 0.05)), 4)


def made_up(rng, robot, steps):
    """A random trajectory of one of PyBullet's robots."""
    joints = ROBOTS[robot]
    distance, duration = way(rng, steps)
    one = {
        "robot": robot,
        "duration": duration,
        "distance": distance,
        "height": between(rng, 0.1, 2.2, steps),
        "pitch": between(rng, -1.8, 1.8, steps),
        "heading": between(rng, -2, 2, steps),
        "touching": rng.integers(0, 2, steps).astype(float),
        "actions": between(rng, -1, 1, (steps, joints)),
        "speeds": between(rng, -2, 2, (steps, joints)),
        "positions": rng.choice([0.4, 0.97, 0.995, 1, 1.2], (steps, joints))
        * rng.choice([-1, 1], (steps, joints)),
    }
    if steps > min(SIZES):
        one["positions"][::3] = 0.99 * rng.choice([-1, 1], joints)
        # at first it stands; at the end it is near the limits, and exactly at them
        one["height"][:2], one["pitch"][:2], one["touching"][:2] = 1.5, 0.1, 0.0
        one["height"][-9:] = 0.79, 0.27, 0.25, 0.81, 0.8, 0.26, 0.78, 1.2, 1.2
        one["pitch"][-9:] = 0.1, -0.1, 0.9, -0.9, 0.0, 0.0, 0.0, 1.0, -1.0
        one["touching"][-9:] = 0.0
    return one


def trajectories(rng, *robots):
    for steps in SIZES:
        yield from (made_up(rng, robot, steps) for robot in robots)


@cache
def real(robot, seed):
    return paid_episode(robot, seed).trajectory


first = exercise.task("9.1", "Progress, and being alive")


@same(first, 6, "progress", 1e-7)
def measures_progress(rng):
    yield from (way(rng, steps) for steps in (1, 3, 12, 50))


@same(first, 8, "alive_bonus")
def tells_the_fallen(rng):
    for one in trajectories(rng, *ROBOTS):
        yield one["robot"], one["height"], one["pitch"], one["touching"]


costs = exercise.task("9.2", "What effort costs")


@same(costs, 7, "electricity")
def charges_for_electricity(rng):
    for one in trajectories(rng, "Hopper", "HalfCheetah", "Ant", "Walker2D"):
        yield one["robot"], one["actions"], one["speeds"]


@same(costs, 3, "electricity")
def charges_humanoids_more(rng):
    for one in trajectories(rng, "Humanoid"):
        yield one["robot"], one["actions"], one["speeds"]


@same(costs, 8, "joints_at_limit", 1e-6)
def counts_joints_at_their_limits(rng):
    yield from (one["positions"] for one in trajectories(rng, "Hopper", "Ant"))


standard = exercise.task("9.3", "Version 0", needs=("9.1", "9.2"))


def components(answer, trajectory):
    """The answer, and the names in it: there are no others."""
    if not isinstance(answer, dict):
        return answer
    return answer | {"the names of its components": ", ".join(sorted(map(str, answer)))}


same(standard, 6, "components_v0", 1e-7, view=components, name="rebuilds_version_0")(
    trajectories, *ROBOTS
)


@same(standard, 5, "components_v0", 1e-4)
def rebuilds_version_0_of_real_episodes(rng):
    yield from (real(robot, seed_of(rng)) for robot in ("Hopper", "HalfCheetah", "Humanoid"))


evolved = exercise.task("9.4", "Version 5", needs=("9.1", "9.2"))
same(evolved, 4, "reward_v5", 1e-6, name="rewards_progress_alone")(
    trajectories, "Hopper", "Walker2D"
)
same(evolved, 3, "reward_v5", 1e-6, name="rewards_half_cheetahs")(trajectories, "HalfCheetah")
same(evolved, 3, "reward_v5", 1e-6, name="rewards_ants")(trajectories, "Ant")
same(evolved, 4, "reward_v5", 1e-6, name="rewards_humanoids")(trajectories, "Humanoid")


@same(evolved, 3, "reward_v5", 1e-4)
def rewards_real_episodes(rng):
    yield from (real(robot, seed_of(rng)) for robot in ("Walker2D", "Ant"))


described = exercise.task("9.5", "Planar runners, and a gait in five numbers", needs=("9.1",))


def planar(rng, robot, steps):
    """A random trajectory of a planar runner, at the limits at first."""
    joints, feet = PLANAR[robot]
    distance, duration = way(rng, steps)
    one = {
        "robot": robot,
        "duration": duration,
        "distance": distance,
        "height": between(rng, 0.5, 2.3, steps),
        "pitch": rng.choice([0.1, 1.0], steps) * between(rng, -1.8, 1.8, steps),
        "actions": between(rng, -1, 1, (steps, joints)),
        "feet": rng.integers(0, 2, (steps, feet)).astype(float),
    }
    one["height"][:7] = 0.7, 0.8, 2.0, 1.0, 1.0, 1.0, 1.0
    one["pitch"][:7] = 0.1, 0.1, 0.1, 0.2, -0.2, 1.0, -1.0
    return one


@same(described, 8, "planar_v0", 1e-7, view=components)
def rebuilds_version_0_of_planar_runners(rng):
    yield from (planar(rng, robot, steps) for steps in (9, 40) for robot in PLANAR)


def random_robots(rng, runner, count):
    inputs = runner.policy.spec.inputs
    robots = 0.3 * rng.normal(size=(count, runner.size))
    robots[:, -2 * inputs :] = np.repeat([0.0, 1.0], inputs)
    return robots


@same(described, 3, "planar_v0", 1e-4)
def rebuilds_version_0_of_real_runs(rng):
    for robot in PLANAR:
        runner = Runner(f"{robot}-v0")
        yield runner.record(random_robots(rng, runner, 1)[0], seed_of(rng), 100)


@same(described, 7, "gait", 1e-7)
def describes_gaits(rng):
    yield from (planar(rng, robot, steps) for steps in (9, 40) for robot in PLANAR)


@same(described, 2, "gait", 1e-7)
def describes_those_who_earn_nothing(rng):
    """They go away: they are paid for standing, then in a single step, then for nothing."""
    for robot in ("PlanarHopper", "PlanarWalker2D"):
        one = planar(rng, robot, 40) | {"distance": 1000 + np.arange(41.0)}
        yield one
        height = np.full(40, 0.3)
        height[3] = 1
        yield one | {"height": height, "pitch": np.full(40, 0.05)}
        yield one | {"height": np.full(40, 0.3), "feet": 1 - one["feet"]}


both = exercise.task("9.6", "Evolve both, and compare", seconds=60, needs=("9.5",))


@same(both, 9, "compare", 1e-5)
def compares_gaits(rng):
    """An episode of a HalfCheetah that has fallen goes on in version 0 and ends in version 5."""
    for robot in ("PlanarHalfCheetah", "PlanarHopper"):
        one, two, three, four, five = random_robots(rng, Runner(f"{robot}-v5"), 5)
        rows = {"v0": np.array([one, two, three]), "v5": np.array([four, five])}
        yield robot, rows, seed_of(rng), 4
        yield robot, {"lamed": np.array([two, three])}, seed_of(rng), 2
        yield robot, {"v5": one[None], "v0": np.array([four, two])}, seed_of(rng), 1


@same(both, 11, "evolve_both", 1e-12)
def evolves_both(rng):
    seeds = [seed_of(rng) for _ in range(4)]
    for robot, steps in (("PlanarHopper", 8000), ("PlanarWalker2D", 1000)):
        yield robot, steps, seeds[:1]
    yield "PlanarHopper", 9000, seeds[:2]
    # seeds in no order, one of them twice
    for robot, steps in (("PlanarHopper", 10_000), ("PlanarWalker2D", 1000)):
        yield robot, steps, [seeds[2], seeds[3], seeds[2]]
