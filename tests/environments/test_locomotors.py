"""The PyBullet locomotors: the reference's numbers, version 5's rewards, ends, pictures, errors."""

import subprocess
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

pytestmark = pytest.mark.filterwarnings("ignore:.*(out of date|argv|Overriding).*")


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


@pytest.mark.long
@pytest.mark.parametrize("body", BODIES)
def test_version_0_agrees_over_whole_episodes(make, reference, body):
    theirs, ours = reference(body), make(f"{body}BulletEnv-v0")
    for seed in range(10):
        expected, rewards, _, ended = episode(theirs, seed, 1000, 0.2 + 0.1 * seed)
        observations, own_rewards, _, own_ended = episode(ours, seed, 1000, 0.2 + 0.1 * seed)
        np.testing.assert_allclose(observations, expected, rtol=0, atol=1e-6)
        np.testing.assert_allclose(own_rewards, rewards, rtol=0, atol=1e-6)
        assert own_ended == ended


def reflexes(env, number):
    """Observations of an episode in which a random layer of neurons acts."""
    rng = np.random.default_rng(number)
    observation, _ = env.reset(seed=number)
    observations = [observation]
    weights, biases = rng.normal(size=(3, 15)), rng.normal(size=3)
    for _ in range(60):
        observation, _, ended, _, _ = env.step(np.tanh(weights @ observation + biases))
        observations.append(observation)
        if ended:
            break
    return np.array(observations)


@pytest.mark.parametrize(("before", "number"), [(34, 30), (19, 136), (19, 113)])
def test_an_episode_does_not_depend_on_the_one_before(make, before, number):
    """Contacts that outlived restoreState moved the last digits of these."""
    fresh = reflexes(make("HopperBulletEnv-v5"), number)
    used = make("HopperBulletEnv-v5")
    reflexes(used, before)
    np.testing.assert_array_equal(reflexes(used, number), fresh)


def test_the_first_episode_of_the_reference_differs_in_one_reward_alone(make, reference):
    module = sys.modules["pybullet_envs_gymnasium.gym_locomotion_envs"]
    theirs = module.HopperBulletEnv()
    _, rewards, _, _ = episode(theirs, 1)
    _, own, _, _ = episode(make("HopperBulletEnv-v0"), 1)
    theirs.close()
    assert 1e-3 < abs(own[0] - rewards[0]) < 0.2
    np.testing.assert_allclose(own[1:], rewards[1:], rtol=0, atol=1e-6)


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


@pytest.mark.parametrize("name", IDS)
def test_the_components_add_up_to_the_reward(make, name):
    _, rewards, infos, _ = episode(make(name), 3)
    own = [sum(info[name[-2:]].values()) for info in infos]
    np.testing.assert_allclose(own, rewards, rtol=0, atol=1e-9)


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


@pytest.mark.parametrize("body", BODIES)
def test_progress_is_the_speed_towards_the_target(make, body):
    """Over an episode it is the distance covered, up to how the limbs are placed at its ends."""
    env = make(f"{body}BulletEnv-v5")
    env.reset(seed=1)
    client, robot = env.unwrapped._client, env.unwrapped._robot
    import pybullet

    def velocity():
        parts = range(pybullet.getNumJoints(robot, physicsClientId=client))
        states = pybullet.getLinkStates(robot, parts, 1, physicsClientId=client)
        return np.mean([state[6][0] for state in states])

    for action in actions(env, 1, 8, 0.2):
        before = velocity()
        *_, info = env.step(action)
        assert info["v0"]["progress"] == pytest.approx((before + velocity()) / 2, abs=0.35)


@pytest.mark.parametrize("version", [0, 5])
def test_when_a_half_cheetah_ends(make, version):
    _, _, infos, ended = episode(make(f"HalfCheetahBulletEnv-v{version}"), 1, 300, 1.0)
    alive = [info["v0"]["alive"] for info in infos]
    assert min(alive) == -1
    assert ended == (version == 5)
    assert (alive.index(-1) == len(alive) - 1) == (version == 5)


@pytest.mark.parametrize("version, noise", [(0, 0.1), (5, 0.03)])
def test_start_noise_of_the_humanoid(make, version, noise):
    env = make(f"HumanoidBulletEnv-v{version}").unwrapped
    starts = []
    for seed in range(20):
        env.reset(seed=seed)
        states = env._bullet.getJointStates(env._robot, env._joints, physicsClientId=env._client)
        starts += [state[0] for state in states]
    assert 0.95 * noise < np.max(np.abs(starts)) <= noise


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("fault", [1e30, np.nan, "sinks"])
def test_a_broken_simulation_ends_the_episode_and_is_mended(make, body, fault):
    env = make(f"{body}BulletEnv-v0")
    expected = episode(env, 7, 40)
    inner = env.unwrapped
    last, _ = env.reset(seed=1)
    world = {"physicsClientId": inner._client}
    if fault == "sinks":
        place = [0, 0, -50], [0, 0, 0, 1]
        inner._bullet.resetBasePositionAndOrientation(inner._robot, *place, **world)
    else:
        inner._bullet.resetJointState(inner._robot, inner._joints[0], fault, **world)
    observation, reward, terminated, truncated, info = env.step(0 * env.action_space.sample())
    assert terminated and not truncated and reward == 0 and info == {"exploded": True}
    assert (observation == last).all()
    again = episode(env, 7, 40)
    assert all(np.array_equal(one, two) for one, two in zip(expected[:2], again[:2], strict=True))


def test_an_action_must_be_finite(make):
    env = make("HopperBulletEnv-v5")
    env.reset(seed=1)
    with pytest.raises(BotschoolError, match="holds NaN"):
        env.step(np.array([0, np.nan, 0], np.float32))


def test_pictures_show_the_robot_moving(make):
    env = make("AntBulletEnv-v5", render_mode="rgb_array")
    env.reset(seed=1)
    first = env.render()
    assert first.shape == (300, 400, 3) and first.dtype == np.uint8
    for action in actions(env, 1, 10, 1.0):
        env.step(action)
    second = env.render()
    assert 100 < (first != second).any(axis=2).sum() < 60_000


def test_a_window_needs_a_display(make, monkeypatch):
    if sys.platform != "linux":
        pytest.skip("elsewhere there is a display")
    monkeypatch.delenv("DISPLAY", raising=False)
    with pytest.raises(BotschoolError, match="no display"):
        make("HopperBulletEnv-v5", render_mode="human")


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


@pytest.mark.parametrize("order", ["first", "last"])
def test_another_package_may_have_the_plain_names(order):
    """Experiments get our environment anyway."""
    pytest.importorskip("pybullet_envs_gymnasium")
    imports = ["import pybullet_envs_gymnasium", "import botschool.envs"]
    lines = [
        "import warnings; warnings.simplefilter('ignore')",
        *(imports if order == "first" else imports[::-1]),
        "import gymnasium",
        "from botschool import problems",
        "env = problems.make('HopperBulletEnv-v0')._env.unwrapped",
        "assert type(env).__module__ == 'botschool.envs.locomotors', env",
        "gymnasium.make('HopperBulletEnv-v0').reset(seed=1)",
        "gymnasium.make('HopperBulletEnv-v5').reset(seed=1)",
    ]
    subprocess.run([sys.executable, "-c", "\n".join(lines)], check=True, capture_output=True)


def test_nothing_is_printed():
    lines = [
        "from botschool import problems",
        "env = problems.make('HumanoidBulletEnv-v0')._env",
        "env.reset(seed=1); env.step(env.action_space.sample()); env.close()",
    ]
    done = subprocess.run(
        [sys.executable, "-c", "\n".join(lines)], check=True, capture_output=True, text=True
    )
    assert done.stdout == "" and done.stderr == ""


def test_without_pybullet_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "pybullet", None)
    with pytest.raises(BotschoolError, match=r"pip install 'botschool\[pybullet\]'"):
        problems.make("AntBulletEnv-v5")


@pytest.mark.parametrize("file", ["hopper.xml", "plane_stadium.sdf"])
@pytest.mark.parametrize("text", [None, "<mujoco><worldbody>"])
def test_a_broken_installation_says_which_file(monkeypatch, tmp_path, file, text):
    import shutil

    from botschool.envs import bullet

    data = bullet.data_folder()
    (tmp_path / "mjcf").mkdir()
    shutil.copy(data / "mjcf" / "hopper.xml", tmp_path / "mjcf")
    for name in ("plane_stadium.sdf", "plane100.obj", "plane.mtl", "checker_blue.png"):
        if (data / name).exists():
            shutil.copy(data / name, tmp_path)
    broken = next(tmp_path.rglob(file))
    broken.unlink() if text is None else broken.write_text(text)
    monkeypatch.setattr(bullet, "data_folder", lambda: tmp_path)
    with pytest.raises(BotschoolError, match=file):
        problems.make("HopperBulletEnv-v0")


@pytest.mark.long
def test_stable_baselines_trains():
    sb3 = pytest.importorskip("stable_baselines3")
    model = sb3.PPO("MlpPolicy", "botschool/HopperBulletEnv-v5", n_steps=256, seed=1)
    model.learn(1000)
    assert model.num_timesteps >= 1000
