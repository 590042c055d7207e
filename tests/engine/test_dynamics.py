"""Native classic control agrees with Gymnasium's own code, one step from any state."""

import math

import gymnasium
import numpy as np
import pytest

from botschool import _core

STATES = 100_000
PI = math.pi
# Ranges of random states (wide enough to leave the arena) and actions (to be clipped).
RANGES = {
    "CartPole-v1": [2.6, 5, 0.3, 5],
    "Pendulum-v1": [4 * PI, 8],
    "Acrobot-v1": [PI, PI, 4 * PI, 9 * PI],
    "MountainCarContinuous-v0": [1.2, 0.07],
}
ACTIONS = {"CartPole-v1": 2, "Pendulum-v1": 5.0, "Acrobot-v1": 3, "MountainCarContinuous-v0": 2.0}


def random_states(name, rng):
    """Shape (STATES, states): anywhere in the ranges, one in five near where the episode begins."""
    ranges = np.array(RANGES[name])
    states = rng.uniform(-ranges, ranges, size=(STATES, len(ranges)))
    states[::5] *= 0.1
    if name == "MountainCarContinuous-v0":
        states[:, 0] = rng.uniform(-1.2, 0.6, size=STATES)
        states[:100, 0], states[100:200, 0] = -1.2, 0.6
        # Gymnasium keeps its states in single precision, and computes in it if they are: not here
        return states.astype(np.float32).astype(np.float64)
    if name == "CartPole-v1":  # around both thresholds
        states[1::5, 0] = rng.choice([-2.4, 2.4], STATES // 5) + rng.uniform(
            -1e-2, 1e-2, STATES // 5
        )
        angles = rng.choice([-PI / 15, PI / 15], STATES // 5)
        states[2::5, 2] = angles + rng.uniform(-1e-2, 1e-2, STATES // 5)
    if name == "Acrobot-v1":  # around the height that ends it
        states[1::5, :2] = rng.normal([2, 0.3], 0.2, size=(STATES // 5, 2))
        states[1::5, 2:] *= 0.2
    return states


def gymnasium_steps(name, states, actions):
    env = gymnasium.make(name).unwrapped
    env.reset(seed=0)
    rows = []
    for state, action in zip(states, actions, strict=True):
        env.state = state
        env.steps_beyond_terminated = None  # CartPole's reward depends on it
        observation, reward, terminated, _, _ = env.step(action)
        rows.append((env.state, reward, terminated, observation))
    return [np.array(column) for column in zip(*rows, strict=True)]


def native_steps(name, states, actions):
    stepper = _core.make_stepper(name)
    rows = []
    for state, action in zip(
        states, np.asarray(actions, float).reshape(len(states), 1), strict=True
    ):
        stepper.state = state
        reward, ended = stepper.step(action)
        rows.append((stepper.state, reward, ended, stepper.observation))
    return [np.array(column) for column in zip(*rows, strict=True)]


def wrong(actual, expected, tolerance):
    """Where two arrays differ by more than the tolerance, relative to values above 1."""
    return np.abs(actual - expected) > tolerance * np.maximum(1, np.abs(expected))


@pytest.mark.slow
@pytest.mark.parametrize("name", RANGES)
def test_one_step_agrees_with_gymnasium(name):
    rng = np.random.default_rng(7)
    states = random_states(name, rng)
    limit = ACTIONS[name]
    if isinstance(limit, int):
        actions = rng.integers(limit, size=STATES)
    else:
        actions = rng.uniform(-limit, limit, size=(STATES, 1))
    theirs, rewards, terminated, observations = gymnasium_steps(name, states, actions)
    state, reward, ended, observation = native_steps(name, states, actions)
    if name == "MountainCarContinuous-v0":
        # both round to single precision: now and then the last bit of double decides how
        apart = state != theirs
        assert apart.mean() < 1e-4
        assert np.all(np.abs(state - theirs) <= np.spacing(np.abs(theirs).astype(np.float32)))
    else:
        assert not wrong(state, theirs, 1e-9).any()
    assert not wrong(reward, rewards, 1e-9).any()
    assert np.array_equal(ended, terminated)
    assert observations.dtype == np.float32
    assert not wrong(observation, observations, 1e-6).any()
    # the states drawn were worth it
    assert 0.01 < ended.mean() < 0.99 or name == "Pendulum-v1"


@pytest.mark.parametrize("name", RANGES)
def test_an_episode_follows_gymnasiums(name):
    """From Gymnasium's own start state, for 200 steps, each compared on its own."""
    rng = np.random.default_rng(3)
    env, stepper = gymnasium.make(name), _core.make_stepper(name)
    single = name == "MountainCarContinuous-v0"
    for seed in range(5):
        env.reset(seed=seed)
        for _ in range(200):
            stepper.state = np.asarray(env.unwrapped.state, dtype=np.float64)
            action = env.action_space.sample() if rng.random() < 0.2 else stay(env, stepper)
            _, reward, terminated, truncated, _ = env.step(action)
            ours, ended = stepper.step(np.atleast_1d(np.asarray(action, dtype=np.float64)))
            # single precision is what Gymnasium computes in when state or action are
            tolerance = 1e-6 if single or name == "Pendulum-v1" else 1e-9
            assert not wrong(stepper.state, env.unwrapped.state, tolerance).any()
            assert not wrong(ours, reward, tolerance) and ended == terminated
            if terminated or truncated:
                break


def stay(env, stepper):
    """An action that keeps an episode going for a while."""
    if isinstance(env.action_space, gymnasium.spaces.Discrete):
        return int(stepper.observation[-2:].sum() > 0) * int(env.action_space.n - 1)
    return np.full(env.action_space.shape, np.sign(stepper.state[-1]), dtype=np.float32)


def test_mountain_car_ends_at_the_goal_alone():
    stepper = _core.make_stepper("MountainCarContinuous-v0")
    for position, velocity, ends in [
        (0.44, 0.02, True),
        (0.44, 0.005, False),
        (0.5, -0.01, False),
        (0.6, 0.01, True),
        (-1.2, -0.05, False),
    ]:
        stepper.state = np.array([position, velocity])
        reward, ended = stepper.step(np.array([0.0]))
        assert ended == ends and reward == (100 if ends else 0)
    assert stepper.state.tolist() == pytest.approx([-1.2, 0])  # stopped by the wall
