"""Environments that graders make up, or turn round, for a submission's process."""

from functools import partial

import gymnasium
import numpy as np
import pytest

from botschool.envs.native import NativeEnv
from botschool.grading.run.worlds import made_up, turned

SIGNS = np.array([1.0, -1.0, -1.0, 1.0])


def test_an_environment_is_made_up():
    spaces = ([-1, -2, -3], [1, 2, np.inf]), (3, 2)
    name, got = made_up(*spaces, [1.0, -2.0], maxsteps=2)
    other, _ = made_up(*spaces, [1.0, -2.0, 3.0], maxsteps=2)
    assert name != other
    with gymnasium.make(name) as env:
        assert env.observation_space == gymnasium.spaces.Box(*map(np.float32, spaces[0]))
        assert env.action_space == gymnasium.spaces.Discrete(3, start=2)
        first = env.reset(seed=3)[0]
        assert env.step(2)[1:4] == (1.0, False, False)
        assert env.step(4)[1:4] == (-2.0, True, True)
        assert np.array_equal(env.reset(seed=3)[0], first)
    with gymnasium.make(other) as env:
        env.reset()
        assert [env.step(2)[2:4] for _ in range(2)] == [(False, False), (False, True)]
    assert [float(each) for each in got] == [2.0, 4.0]


def episodes(seeds):
    seen = []
    for seed in seeds:
        with gymnasium.make("CartPole-v1") as env:
            seen.append(env.reset(seed=seed)[0])
            seen += [env.step(1)[0] for _ in range(3)]
    return np.array(seen)


@pytest.mark.parametrize("side", [1, -1])
def test_signs_and_sides_are_turned_within_the_block_alone(side):
    with turned("CartPole-v1", SIGNS, side) as record:
        seen = episodes([4, 5])
    assert (record.seeds, record.returns, record.actions) == ([4, 5], [3.0, 3.0], [[1.0], [1.0]])
    usual = episodes([4, 5])
    assert np.allclose(seen[::4], SIGNS * usual[::4])  # what is seen at first
    assert np.allclose(seen, SIGNS * usual) is (side == 1)
    assert gymnasium.spec("CartPole-v1").max_episode_steps == 500


def test_a_training_is_broken_off():
    with turned("CartPole-v1", SIGNS, 1, most=2) as record:
        episodes([4, 5, 6, 7])
    assert record.seeds == [4, 5]


def test_a_native_problem_stands_for_a_name_that_a_submission_registers():
    name = "WorldsOfTests-v0"
    with turned(name, [1, -1, 1], 1, other=partial(NativeEnv, "SpatialBalanceBot-v0")) as record:
        env = gymnasium.make(name)
        env.reset(seed=1)
        env.step(np.zeros(1, dtype=np.float32))
    assert record.seeds == [1] and record.actions == [[0.0]] and name not in gymnasium.registry
