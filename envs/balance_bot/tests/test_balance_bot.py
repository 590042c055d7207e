"""The package as its users see it: spaces, episodes, rewards, ends and pictures."""

import subprocess
import sys

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

pybullet = pytest.importorskip("pybullet")

import balance_bot  # noqa: E402, F401
from balance_bot.env import FASTEST, BalanceBotEnv  # noqa: E402

NAME = "BalanceBotBulletEnv-v0"


@pytest.fixture
def env():
    made = gymnasium.make(NAME)
    yield made
    made.close()


def upright(observation):
    """A controller that keeps the robot upright."""
    inclination, turning, _ = observation
    return np.array([-10 * inclination - turning], dtype=np.float32)


def episode(env, seed, act):
    """All observations and rewards, and how the episode ended."""
    observation, _ = env.reset(seed=seed)
    seen, rewards, ended = [observation], [], (False, False)
    while not any(ended):
        observation, reward, *ended, _ = env.step(act(observation))
        seen.append(observation)
        rewards.append(reward)
    return np.array(seen), np.array(rewards), tuple(ended)


@pytest.mark.filterwarnings("ignore:.*infinity.*", "ignore:.*no display.*")
def test_passes_gymnasiums_checker(env):
    check_env(env.unwrapped)


def test_masses_and_inertias_are_those_of_the_file(env):
    env.reset(seed=0)
    robot, client = env.unwrapped.robot, env.unwrapped.client
    for part, mass, inertia in ((-1, 0.8, 0.001), (0, 0.1, 0.0001), (1, 0.1, 0.0001)):
        info = pybullet.getDynamicsInfo(robot, part, client)
        assert info[0] == pytest.approx(mass)
        assert info[2] == pytest.approx((inertia,) * 3)
    for wheel, x in ((0, -1), (1, 1)):
        info = pybullet.getJointInfo(robot, wheel, client)
        assert info[13] == (x, 0, 0)
        assert pybullet.getDynamicsInfo(robot, wheel, client)[1] == pytest.approx(0.8)


def test_a_controller_balances_and_the_episode_is_truncated(env):
    for seed in range(3):
        seen, rewards, ended = episode(env, seed, upright)
        assert len(rewards) == 500
        assert ended == (False, True)
        np.testing.assert_allclose(rewards, 1 - 0.05 * np.abs(seen[1:, 2]), atol=1e-6)


def test_without_control_it_falls_and_the_episode_is_terminated(env):
    seen, rewards, ended = episode(env, 0, lambda observation: np.zeros(1, dtype=np.float32))
    assert ended == (True, False)
    assert 30 < len(rewards) < 200
    assert abs(seen[-1, 0]) > 0.9


def test_starts_at_rest_with_an_inclination_from_the_seed(env):
    starts = np.array([env.reset(seed=seed)[0] for seed in range(80)])
    assert np.all(starts[:, 1:] == 0)
    assert np.all(np.abs(starts[:, 0]) <= 0.3)
    assert starts[:, 0].min() < -0.25
    assert starts[:, 0].max() > 0.25
    assert len(np.unique(starts[:, 0])) == 80


def test_the_past_leaves_no_trace():
    """Equal seeds, equal episodes: after others, and beside another environment."""

    def wild(observation):
        return np.array([np.sin(40 * observation[0])], dtype=np.float32)

    fresh, used = gymnasium.make(NAME), gymnasium.make(NAME)
    for seed in range(5):
        episode(used, seed, wild)
    expected, got = episode(fresh, 7, wild), episode(used, 7, wild)
    np.testing.assert_array_equal(got[0], expected[0])
    np.testing.assert_array_equal(got[1], expected[1])
    fresh.close()
    used.close()


def test_wheels_keep_to_their_limits(env):
    env.reset(seed=1)
    raw = env.unwrapped
    raw.drive(np.array([50.0]))
    assert raw.speed == 1.0
    raw.speed = -FASTEST + 0.2
    raw.drive(np.array([-1.0]))
    assert raw.speed == -FASTEST


def test_pictures_follow_the_robot():
    env = gymnasium.make(NAME, render_mode="rgb_array")
    env.reset(seed=3)
    first = env.render()
    for _ in range(40):
        env.step(np.ones(1, dtype=np.float32))
    last = env.render()
    assert first.shape == last.shape == (360, 480, 3)
    assert first.dtype == np.uint8
    assert np.any(first != last)
    blue = (last[..., 2] > 1.5 * last[..., 0]) & (last[..., 0] < 100)
    assert 500 < blue.sum() < 60_000
    env.close()
    env.close()


def test_nothing_is_printed_and_the_import_is_light():
    program = (
        "import sys, gymnasium, balance_bot; assert 'pybullet' not in sys.modules;"
        f"env = gymnasium.make('{NAME}'); env.reset(seed=1); env.step(env.action_space.sample());"
        "env.close()"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout == done.stderr == ""


def test_unknown_render_mode_is_refused():
    with pytest.raises(ValueError, match="human, rgb_array or None"):
        BalanceBotEnv(render_mode="ascii")
