"""Our solution of exercise 1 gives what Gymnasium pays; its grader compares with it alone."""

import runpy
import warnings
from pathlib import Path

import gymnasium
import numpy as np
import pytest

FILE = Path(__file__).parents[2] / "solutions/ex01_gymnasium/gymnasium_basics.py"
SOLUTION = runpy.run_path(str(FILE))


@pytest.mark.parametrize("side", [-1, 0, 1])
def test_the_reward_and_the_end_are_those_of_cartpole(side):
    env, rng = gymnasium.make("CartPole-v1").unwrapped, np.random.default_rng(7)
    for seed in range(20):
        env.reset(seed=seed)
        env.state = env.state + np.array([2.3, 1.0, 0.0, 0.0]) * side  # leaves by a side, or falls
        observation, terminated = env.state, False
        while not terminated:
            action = int(rng.integers(2))
            wanted = SOLUTION["cartpole_reward"](observation, action)
            observation, reward, terminated, _, _ = env.step(action)
            assert reward == wanted
            assert SOLUTION["fallen"](np.array(env.state)) == terminated
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of a step beyond the end
            assert env.step(0)[1] == SOLUTION["cartpole_reward"](observation, 0)


def test_the_reward_is_that_of_pendulum():
    env, rng = gymnasium.make("Pendulum-v1").unwrapped, np.random.default_rng(7)
    for _ in range(200):
        env.reset(seed=1)
        angle, speed = env.state = rng.uniform((-9, -7), (9, 7))
        action = rng.uniform(-6, 6, 1)
        reward = env.step(action)[1]
        observation = np.array([np.cos(angle), np.sin(angle), speed])
        np.testing.assert_allclose(SOLUTION["pendulum_reward"](observation, action), reward, 1e-6)
