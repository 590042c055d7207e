"""The PyBullet locomotors: the reference's numbers, version 5's rewards, ends, pictures, errors."""

import sys

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import botschool.envs  # noqa: F401  (registers the locomotors)
from botschool import problems
from botschool.config import PolicyConfig
from botschool.errors import BotschoolError
from botschool.policies.policy import Policy
from botschool.problems import Episodes

pytest.importorskip("pybullet")

BODIES = ("Hopper", "HalfCheetah", "Ant", "Walker2D", "Humanoid")
IDS = [f"{body}BulletEnv-v{version}" for body in BODIES for version in (0, 5)]

pytestmark = [
    pytest.mark.slow,
    pytest.mark.filterwarnings("ignore:.*(out of date|argv|Overriding).*"),
]


@pytest.fixture
def make():
    made = []

    def call(name, **options):
        made.append(gymnasium.make(f"botschool/{name}", **options))
        return made[-1]

    yield call
    for env in made:
        env.close()


def actions(env, seed, steps, size=0.6):
    rng = np.random.default_rng(seed)
    shape = (steps, *env.action_space.shape)
    return (size * rng.uniform(-1, 1, shape)).astype(np.float32)


def episode(env, seed, steps=150, size=0.6):
    """(observations, rewards, infos, ended) of an episode with random actions."""
    observation, _ = env.reset(seed=seed)
    observations, rewards, infos, ended = [observation], [], [], False
    for action in actions(env, seed, steps, size):
        observation, reward, ended, _, info = env.step(action)
        observations.append(observation)
        rewards.append(reward)
        infos.append(info)
        if ended:
            break
    return np.array(observations), np.array(rewards), infos, ended


@pytest.fixture(scope="module")
def reference():
    """Makes environments of pybullet_envs_gymnasium, past their first episode (see locomotors)."""
    module = pytest.importorskip("pybullet_envs_gymnasium.gym_locomotion_envs")
    made = []

    def call(body):
        made.append(getattr(module, f"{body}BulletEnv")())
        made[-1].reset(seed=0)
        return made[-1]

    yield call
    for env in made:
        env.close()


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("size", [0.1, 0.6, 2.0])
def test_version_0_agrees_with_the_reference(make, reference, body, size):
    theirs, ours = reference(body), make(f"{body}BulletEnv-v0")
    for seed in (1, 2):
        expected, rewards, _, ended = episode(theirs, seed, 200, size)
        observations, own_rewards, _, own_ended = episode(ours, seed, 200, size)
        assert observations.dtype == expected.dtype
        np.testing.assert_allclose(observations, expected, rtol=0, atol=1e-6)
        np.testing.assert_allclose(own_rewards, rewards, rtol=0, atol=1e-6)
        assert own_ended == ended


@pytest.mark.parametrize("name", IDS)
def test_the_environment_checker_passes(make, name):
    check_env(make(name).unwrapped, skip_render_check=True)


@pytest.mark.parametrize("name", IDS)
def test_an_episode_does_not_depend_on_what_was_before(make, name):
    one, other = make(name), make(name)
    expected = [episode(one, seed, 60) for seed in range(3)]
    for seed in (2, 0, 1):
        for env in (one, other):
            env.reset(seed=50 + seed)
            env.step(env.action_space.sample())
            observations, rewards, infos, _ = episode(env, seed, 60)
            assert observations.tobytes() == expected[seed][0].tobytes()
            assert rewards.tobytes() == expected[seed][1].tobytes()
            assert infos == expected[seed][2]


def positions_and_speeds(observations, joints):
    values = observations[1:, 8 : 8 + 2 * joints].astype(float)
    return values[:, 0::2], values[:, 1::2]


@pytest.mark.parametrize("body", BODIES)
def test_version_5_rewards_what_the_specification_says(make, body):
    env = make(f"{body}BulletEnv-v5")
    joints = env.action_space.shape[0]
    for seed in range(3):
        observations, rewards, infos, _ = episode(env, seed)
        position, _ = positions_and_speeds(observations, joints)
        acted = actions(env, seed, 150)[: len(rewards)].astype(float)
        progress = np.array([info["v0"]["progress"] for info in infos])
        limits = 0.1 * (np.abs(position) > 0.99).sum(axis=1)
        angle = np.arctan2(observations[1:, 1], observations[1:, 2])
        beyond = np.maximum(np.abs(position) - 1, 0).sum(axis=1)
        expected = {
            "Hopper": progress,
            "Walker2D": progress,
            "HalfCheetah": progress - limits,
            "Ant": progress + 0.01 - 0.01 * (acted**2).mean(axis=1) - limits,
            "Humanoid": progress + 1 - limits - 10 * beyond - 0.1 * angle**2,
        }[body]
        np.testing.assert_allclose(rewards, expected, rtol=0, atol=1e-4)


@pytest.mark.parametrize("version", [0, 5])
def test_when_a_half_cheetah_ends(make, version):
    _, _, infos, ended = episode(make(f"HalfCheetahBulletEnv-v{version}"), 1, 300, 1.0)
    alive = [info["v0"]["alive"] for info in infos]
    assert min(alive) == -1
    assert ended == (version == 5)
    assert (alive.index(-1) == len(alive) - 1) == (version == 5)


def test_pictures_show_the_robot_moving(make):
    env = make("AntBulletEnv-v5", render_mode="rgb_array")
    env.reset(seed=1)
    first = env.render()
    assert first.shape == (300, 400, 3) and first.dtype == np.uint8
    for action in actions(env, 1, 10, 1.0):
        env.step(action)
    second = env.render()
    assert 100 < (first != second).any(axis=2).sum() < 60_000


def test_fitness_is_that_of_an_episode_by_hand(make):
    problem = problems.make("HopperBulletEnv-v5")
    policy = Policy(problem.name, problem.interface, PolicyConfig(nhiddens=4))
    genotypes = np.array([policy.initial(1, i) for i in range(3)])
    outcome = problem.evaluate(policy, genotypes, None, Episodes.of(np.full(3, 5), 2), 1000)
    env = make("HopperBulletEnv-v5")
    policy.load(genotypes[2], None)
    policy.reset(5, 1)
    (observation, _), total, ended = env.reset(seed=6), 0.0, False
    while not ended:
        observation, reward, ended, _, _ = env.step(np.clip(policy.act(observation), -1, 1))
        total += reward
    assert outcome.fitness[5] == total


def test_without_pybullet_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "pybullet", None)
    with pytest.raises(BotschoolError, match=r"pip install 'botschool\[pybullet\]'"):
        problems.make("AntBulletEnv-v5")
