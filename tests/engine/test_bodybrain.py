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
from running import contents, experiment, run_seeds, same, write_experiment

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


@pytest.mark.parametrize("wrong", [np.zeros(63), np.full(64, np.nan), np.zeros((8, 8))])
def test_wrong_morphologies_are_refused(wrong):
    with pytest.raises(ValueError, match="64 finite numbers"):
        made(wrong)


# -------------------------------------------------------------- environment
def test_passes_the_checker():
    from gymnasium.utils.env_checker import check_env

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # angles have no bounds
        check_env(made(BODIES[0]))


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


def test_experiment_file_is_read():
    from running import TESTS

    read = config.load(TESTS.parent / "data" / "experiments" / "bodybrain.ini")
    assert (read.policy.episodes, read.policy.maxsteps, read.policy.nhiddens) == (3, 400, 50)
    assert read.algo.maxmsteps == 100 and read.policy.normalize
    assert SEGMENTS == 11 and DENSITIES.stop == MORPHOLOGY_SIZE and SIZES.stop == LIMITS.start
