"""CartPole with any force: at full force it is Gymnasium's CartPole."""

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import botschool.envs

gymnasium.register_envs(botschool.envs)
NAME = "botschool/PushedCartPole-v0"


def test_passes_the_checker():
    with gymnasium.make(NAME) as env:
        check_env(env.unwrapped, skip_render_check=True)
        assert env.spec.max_episode_steps == 500


@pytest.mark.parametrize("factor", [1.0, 3.0])
def test_full_force_is_cartpole(factor):
    """Beyond its limits the action is cut."""
    sides = np.random.default_rng(1).integers(0, 2, 30)
    with gymnasium.make("CartPole-v1") as known, gymnasium.make(NAME) as own:
        observed = [known.reset(seed=4)[0], own.reset(seed=4)[0]]
        for side in sides:
            np.testing.assert_array_equal(*observed)
            push = np.array([factor * (2 * side - 1)], dtype=np.float32)
            one, other = known.step(int(side)), own.unwrapped.step(push)
            assert one[1:4] == other[1:4]
            observed = [one[0], other[0]]
            if one[2]:
                break


def test_no_force_lets_the_cart_roll():
    with gymnasium.make(NAME) as env:
        before, _ = env.reset(seed=1)
        after, reward, *_ = env.step(np.zeros(1, dtype=np.float32))
        pushed = gymnasium.make(NAME)
        pushed.reset(seed=1)
        half = pushed.step(np.full(1, 0.5, dtype=np.float32))[0]
    assert reward == 1.0
    assert abs(after[1] - before[1]) < 0.02 < half[1] - before[1]
