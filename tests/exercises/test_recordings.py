"""Our solution of exercise 9 gives what environments pay; its grader compares with it alone."""

import runpy
from pathlib import Path

import numpy as np
import pytest

from botschool.course.locomotion import Runner
from botschool.course.recordings import paid_episode, recorded

FILE = Path(__file__).parents[2] / "solutions/ex09_reward_functions/reward_functions.py"
SOLUTION = runpy.run_path(str(FILE))


@pytest.mark.parametrize("episode", [recorded, lambda robot: paid_episode(robot, 7)])
@pytest.mark.parametrize("robot", ["Hopper", "HalfCheetah", "Ant", "Walker2D", "Humanoid"])
def test_rewards_are_those_of_pybullets_robots(robot, episode):
    paid = episode(robot)
    parts = SOLUTION["components_v0"](paid.trajectory)
    for key, values in paid.v0.items():
        np.testing.assert_allclose(parts[key], values, 1e-4, 1e-4, err_msg=key)
    assert parts.keys() == paid.v0.keys()
    np.testing.assert_allclose(SOLUTION["reward_v5"](paid.trajectory), paid.v5, 1e-4, 1e-4)


@pytest.mark.parametrize("robot", ["PlanarHopper", "PlanarWalker2D", "PlanarHalfCheetah"])
def test_components_add_up_to_what_planar_runners_are_paid(robot):
    runner, rng = Runner(f"{robot}-v0"), np.random.default_rng(3)
    genotype, inputs = 0.3 * rng.normal(size=runner.size), runner.policy.spec.inputs
    genotype[-2 * inputs :] = np.repeat([0.0, 1.0], inputs)
    paid = [step.reward for step in runner.play(genotype, 5, 100)]
    parts = SOLUTION["planar_v0"](runner.record(genotype, 5, 100))
    np.testing.assert_allclose(sum(parts.values()), paid, 1e-4, 1e-4)
