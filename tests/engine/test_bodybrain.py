"""Body and brain: the body that the genotype's tail describes, and episodes as pure functions."""

import sys
import warnings

import gymnasium
import numpy as np
import pytest

from botschool import config, problems
from botschool.envs.morphology import LENGTH, MORPHOLOGY_SIZE, SEGMENTS, THICKNESS, decode
from botschool.policies.policy import Policy
from botschool.problems import Episodes
from running import contents, experiment, finished_run, run_seeds, same, write_experiment

pytest.importorskip("Box2D")

ID = "botschool/BodyBrain-v0"
RNG = np.random.default_rng(1)
BODIES = 0.6 * RNG.normal(size=(3, MORPHOLOGY_SIZE))
SIZES, LIMITS, ANGLES, DENSITIES = (
    slice(0, 22), slice(22, 42), slice(42, 53), slice(53, 64),
)  # fmt: skip


def made(morphology=None, **options):
    """A new environment without wrappers."""
    return gymnasium.make(ID, morphology=morphology, **options).unwrapped


def episode(env, seed, steps=60):
    """Observations and rewards under random actions that follow from the seed."""
    rng = np.random.default_rng(seed)
    observation, _ = env.reset(seed=seed)
    observations, rewards = [observation], []
    for _ in range(steps):
        observation, reward, terminated, _, _ = env.step(rng.uniform(-1, 1, 10))
        observations.append(observation)
        rewards.append(reward)
        if terminated:
            break
    return np.array(observations).tobytes(), np.array(rewards).tobytes()


# --------------------------------------------------------------- morphology
def test_no_morphology_is_the_straight_body():
    body = decode(np.zeros(MORPHOLOGY_SIZE))
    assert np.all(body.lengths == 0.8) and np.all(body.thicknesses == 0.2)
    assert np.all(body.densities == 5) and not body.angles.any() and not body.limits.any()
    centres, headings = body.pose()
    np.testing.assert_allclose(centres[:, 0], 0.8 * np.arange(11) + 0.4)
    assert not centres[:, 1].any() and not headings.any()


def test_parameters_and_parts():
    """Each parameter changes its own part and nothing else."""
    for place in range(MORPHOLOGY_SIZE):
        p = np.zeros(MORPHOLOGY_SIZE)
        p[place] = 0.5
        body = decode(p)
        lengths, thicknesses = np.full(11, LENGTH), np.full(11, THICKNESS)
        limits, angles, densities = np.zeros((10, 2)), np.zeros(11), np.full(11, 5.0)
        scale = 1 + 0.9 * np.tanh(0.5)
        if place < 22:
            (thicknesses if place % 2 else lengths)[place // 2] *= scale
        elif place < 42:
            limits[(place - 22) // 2] = (0, np.pi / 4)
        elif place < 53:
            angles[place - 42] = 3 * np.pi / 8
        else:
            densities[place - 53] += 0.8 * np.tanh(0.5)
        np.testing.assert_allclose(body.lengths, lengths)
        np.testing.assert_allclose(body.thicknesses, thicknesses)
        np.testing.assert_allclose(body.limits, limits)
        np.testing.assert_allclose(body.angles, angles)
        np.testing.assert_allclose(body.densities, densities)


def test_extreme_parameters_stay_within_the_ranges():
    for sign in (-1, 1):
        body = decode(sign * 1e6 * np.ones(MORPHOLOGY_SIZE))
        np.testing.assert_allclose(body.lengths, 0.8 * (1 + 0.9 * sign))
        np.testing.assert_allclose(body.thicknesses, 0.2 * (1 + 0.9 * sign))
        np.testing.assert_allclose(body.limits, sign * np.pi / 2)
        np.testing.assert_allclose(body.angles, sign * 3 * np.pi / 4)
        np.testing.assert_allclose(body.densities, 5 + 0.8 * sign)


@pytest.mark.parametrize("wrong", [np.zeros(63), np.full(64, np.nan), np.zeros((8, 8))])
def test_wrong_morphologies_are_refused(wrong):
    with pytest.raises(ValueError, match="64 finite numbers"):
        made(wrong)


def test_corners_are_those_of_the_segments():
    for p in BODIES:
        body, env = decode(p), made(p)
        env.reset(seed=1)
        seen = [
            [tuple(s.transform * v) for v in s.fixtures[0].shape.vertices] for s in env.segments
        ]
        shift = np.array(seen[0]).mean(axis=0) - body.corners()[0].mean(axis=0)
        np.testing.assert_allclose(np.array(seen), body.corners() + shift, atol=1e-5)
        np.testing.assert_allclose([s.fixtures[0].density for s in env.segments], body.densities)
        low, high = np.min(seen, axis=(0, 1)), np.max(seen, axis=(0, 1))
        np.testing.assert_allclose(low[1], 5.1, atol=1e-5)
        np.testing.assert_allclose((low[0] + high[0]) / 2, 20 * 14 / 30, atol=1e-5)


def test_joints_keep_to_their_limits():
    p = np.zeros(MORPHOLOGY_SIZE)
    p[LIMITS] = np.tile([0.4, -0.2], 10)  # the smaller is the lower one
    p[ANGLES] = 0.1
    env = made(p)
    env.reset(seed=1)
    angles = []
    for sign in (1, -1):
        for _ in range(60):
            observation = env.step(np.full(10, sign))[0]
        angles.append(observation[5:25:2])
    assert np.all(angles[0] < 0.2 * np.pi + 0.05) and np.all(angles[1] > -0.1 * np.pi - 0.05)
    assert np.any(angles[0] > 0.5) and np.any(angles[1] < -0.25)


# -------------------------------------------------------------- environment
def test_passes_the_checker():
    from gymnasium.utils.env_checker import check_env

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # angles have no bounds
        check_env(made(BODIES[0]))


def test_terrain():
    env = made()
    env.reset(seed=5)
    heights = np.array(env.heights)
    assert len(heights) == 201 and np.all(heights[:41] == 5)
    slopes = np.diff(heights)
    pushed = slopes[40:] - 0.8 * slopes[39:-1] - 0.01 * np.sign(5 - heights[40:-1])
    assert np.all(np.abs(pushed) < 1 / 15) and np.ptp(pushed) > 0.1
    first = env.heights
    env.reset(seed=6)
    assert env.heights[:41] == first[:41] and env.heights[42:] != first[42:]


def test_reward_is_the_way_forward_and_the_angle():
    env = made(BODIES[1])
    env.reset(seed=2)

    def worth():
        torso = env.segments[0]
        return 130 * torso.position.x / 30 - 5 * abs(torso.angle)

    rng, before, start = np.random.default_rng(3), worth(), env.segments[0].position.x
    for _ in range(50):
        observation, reward, _, _, info = env.step(rng.uniform(-1, 1, 10))
        assert reward == pytest.approx(worth() - before, abs=1e-9)
        assert observation[0] == pytest.approx(env.segments[0].angle, abs=1e-6)
        assert info["distance"] == pytest.approx(env.segments[0].position.x - start)
        before = worth()


def test_contacts_with_the_ground_alone():
    env = made(BODIES[0])
    env.reset(seed=1)
    rng, touched = np.random.default_rng(1), set()
    for _ in range(200):
        observation = env.step(rng.uniform(-1, 1, 10))[0]
        seen = [any(e.contact.touching for e in s.contacts) for s in env.segments]
        assert [observation[4], *observation[25:]] == seen
        touched |= set(np.flatnonzero(seen))
        for contact in env._world.contacts:
            assert not contact.fixtureA.body.mass and contact.fixtureB.body.mass
    assert len(touched) > 0


def moved(env, x):
    """The whole robot, brought to another place."""
    shift = x - env.segments[0].position.x
    for segment in env.segments:
        segment.position = (segment.position.x + shift, segment.position.y + 20)


def test_the_ends_of_the_ground():
    env = made()
    env.reset(seed=1)
    moved(env, -0.5)
    assert env.step(np.zeros(10))[1:4] == (-100, True, False)
    env.reset(seed=1)
    moved(env, 93.5)
    _, reward, terminated, _, _ = env.step(np.zeros(10))
    assert terminated and reward > 300
    env.reset(seed=1)
    moved(env, 93.0)
    assert not env.step(np.zeros(10))[2]


@pytest.mark.slow
def test_an_explosion_ends_the_episode():
    env = made(BODIES[0], render_mode="rgb_array")
    for trouble in ("action", "speed"):
        env.reset(seed=1)
        if trouble == "speed":
            env.segments[4].linearVelocity = (np.nan, 0)
        action = np.full(10, np.nan) if trouble == "action" else np.zeros(10)
        observation, reward, terminated, truncated, _ = env.step(action)
        assert np.isfinite(observation).all() and (reward, terminated, truncated) == (
            -100, True, False,
        )  # fmt: skip
        assert env.render().shape == (400, 600, 3)
        with pytest.raises(gymnasium.error.ResetNeeded):
            env.step(np.zeros(10))
    assert episode(env, 3) == episode(made(BODIES[0]), 3)


@pytest.mark.slow
def test_worlds_are_freed():
    """What 200 episodes leave behind is far less than their worlds (some 5 KB each)."""
    memory = pytest.importorskip("psutil").Process().memory_info
    env = made(BODIES[0])
    for seed in range(100):
        env.reset(seed=seed)
    before = memory().rss
    for seed in range(200):
        env.reset(seed=seed)
    assert memory().rss - before < 400_000


def test_pictures():
    env = made(BODIES[0], render_mode="rgb_array")
    env.reset(seed=1)
    first = env.render()
    assert first.shape == (400, 600, 3) and first.dtype == np.uint8
    for _ in range(30):
        env.step(np.ones(10))
    assert np.any(env.render() != first)
    env.close()
    window = made(BODIES[0], render_mode="human")
    window.reset(seed=1)
    window.step(np.zeros(10))
    window.close()


def test_drawing_changes_nothing():
    assert episode(made(BODIES[2], render_mode="human"), 4, 20) == episode(made(BODIES[2]), 4, 20)


def test_a_missing_box2d_is_one_sentence(refused, tmp_path, monkeypatch):
    monkeypatch.delitem(sys.modules, "botschool.envs.bodybrain", raising=False)
    monkeypatch.setitem(sys.modules, "Box2D", None)
    ini = write_experiment(tmp_path, "envBodybrainCustom")
    refused("es", "-f", ini, "-o", tmp_path / "r", says=["not installed", "Box2D", "pip install"])


# ------------------------------------------------------------------ problem
@pytest.fixture
def problem():
    made = problems.make("envBodybrainCustom")
    yield made
    made.close()


def policy_of(problem):
    return Policy(problem.name, problem.interface, config.PolicyConfig(nhiddens=4, action_noise=1))


def genotypes_of(policy):
    brains = RNG.normal(size=(3, policy.genotype_size))
    brains[:, -MORPHOLOGY_SIZE:] = BODIES
    return brains


def test_genotypes_end_with_the_body(problem):
    policy = policy_of(problem)
    interface = problem.interface
    assert (interface.observations, interface.outputs, interface.morphology) == (35, 10, 64)
    assert policy.genotype_size == 35 * 4 + 4 * 10 + 64
    assert not policy.initial(1)[-64:].any()
    genotype = genotypes_of(policy)[0]
    transition = next(problem.play(policy, genotype, None, 7, 0, 10))
    env = made(genotype[-64:])
    observation, _ = env.reset(seed=7)
    np.testing.assert_array_equal(transition.observation.astype(np.float32), observation)
    reward = env.step(np.clip(transition.action, -1, 1))[1]  # as the action space has it
    assert reward == transition.reward


@pytest.mark.slow
def test_fitness_is_a_pure_function(problem):
    """Equal bits in any order, after anything, in this process and in workers."""
    policy = policy_of(problem)
    genotypes = genotypes_of(policy)
    batch = Episodes.of(np.array([5, 5, 9]), 2)
    one = problem.evaluate(policy, genotypes, None, batch, 60)
    assert len(set(one.fitness)) == 6
    for order in (np.arange(6)[::-1], RNG.permutation(6)):
        some = Episodes(batch.candidate[order], batch.seed[order], batch.episode[order])
        again = problem.evaluate(policy, genotypes, None, some, 60)
        np.testing.assert_array_equal(again.fitness, one.fitness[order])
    fresh = problems.make(ID)
    alone = fresh.evaluate(policy, genotypes, None, batch.select(slice(4, 5)), 60)
    assert alone.fitness[0] == one.fitness[4]
    workers = problem.evaluate(policy, genotypes, None, batch, 60, workers=2)
    np.testing.assert_array_equal(workers.fitness, one.fitness)
    played = list(problem.play(policy, genotypes[2], None, 9, 1, 60))
    assert played[-1].total == one.fitness[5]


@pytest.mark.slow
def test_runs_with_any_number_of_workers_and_interrupted(tmp_path):
    policy = {"maxsteps": 20, "normalize": 1}
    own = experiment(tmp_path, "envBodybrainCustom", "OpenAI-ES", policy, maxmsteps=0.0015)
    assert run_seeds(own, tmp_path / "one")
    assert run_seeds(own, tmp_path / "two", workers=2)
    assert run_seeds(own, tmp_path / "three", steps=500)
    assert run_seeds(own, tmp_path / "three", resume=True)
    assert same(tmp_path / "one", tmp_path / "two") and same(tmp_path / "one", tmp_path / "three")
    saved = np.load(tmp_path / "one" / "bestgS1.npy")
    assert saved.shape == (35 * 3 + 3 * 10 + 64 + 2 * 35,)
    assert saved[-64 - 70 : -70].any() and contents(tmp_path / "one")


@pytest.mark.slow
def test_film(command, tmp_path):
    ini, results = finished_run(tmp_path, "envBodybrainCustom", maxmsteps=0.0003)
    arguments = ["es", "-f", ini, "-p", "-g", results / "bestgS1.npy", "--episodes", 1]
    code, out, _ = command(*arguments, "--video", tmp_path / "film.mp4")
    assert code == 0, _
    assert "fitness" in out and (tmp_path / "film.mp4").stat().st_size > 5000


@pytest.mark.long
def test_stable_baselines_trains():
    ppo = pytest.importorskip("stable_baselines3").PPO
    env = gymnasium.make(ID, morphology=BODIES[0], max_episode_steps=100)
    agent = ppo("MlpPolicy", env, n_steps=128, batch_size=64, device="cpu", seed=1)
    before = [p.detach().clone() for p in agent.policy.parameters()]
    agent.learn(256)
    assert any((a != b).any() for a, b in zip(before, agent.policy.parameters(), strict=True))


def test_experiment_file_is_read():
    from running import TESTS

    read = config.load(TESTS.parent / "data" / "experiments" / "bodybrain.ini")
    assert (read.policy.episodes, read.policy.maxsteps, read.policy.nhiddens) == (3, 400, 50)
    assert read.algo.maxmsteps == 100 and read.policy.normalize
    assert SEGMENTS == 11 and DENSITIES.stop == MORPHOLOGY_SIZE and SIZES.stop == LIMITS.start
