"""Our native problems as Gymnasium and PettingZoo environments."""

import sys
import warnings

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import botschool.envs
from botschool import _core, arena, problems
from botschool.config import PolicyConfig
from botschool.errors import BotschoolError
from botschool.policies.policy import Policy
from botschool.problems import make

gymnasium.register_envs(botschool.envs)
LONGEST = {"Discrim": 500, "DoublePole": 1000, "SwingUp": 1000, "Predator": None, "Prey": None}
PROBLEMS = {"Discrim": "ErDiscrim", "DoublePole": "ErDpole", "SwingUp": "envSwingupCustom"}
SIDES = ("Predator", "Prey")


def env_of(name, **options):
    return gymnasium.make(f"botschool/{name}-v0", **options)


def refused(call, *words):
    with pytest.raises(BotschoolError) as caught:
        call()
    for word in words:
        assert word in str(caught.value), caught.value


@pytest.mark.parametrize("name", LONGEST)
def test_passes_the_checker_without_a_warning(name):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with env_of(name, render_mode="rgb_array") as env:
            check_env(env.unwrapped)
            assert env.spec.max_episode_steps == LONGEST[name]
            assert env.observation_space.dtype == env.action_space.dtype == np.float32


@pytest.mark.parametrize("name", LONGEST)
def test_seeds_decide(name):
    def episode(env, seed):
        actions = np.random.default_rng(1)
        rows = [(env.reset(seed=seed)[0], 0.0, False, False)]
        while not (rows[-1][2] or rows[-1][3]) and len(rows) < 60:
            action = actions.uniform(-1, 1, env.action_space.shape).astype(np.float32)
            rows.append(env.step(action)[:4])
            assert env.observation_space.contains(rows[-1][0])
        return [(row[0].tolist(), *row[1:]) for row in rows]

    with env_of(name) as one, env_of(name) as other:
        first = episode(one, 5)
        assert first == episode(other, 5) == episode(one, 5)
        following = [episode(env, None) for env in (one, other)]
        assert following[0] == following[1]
        if name not in SIDES:  # which start always alike
            assert first != episode(one, 6) and first != following[0]


@pytest.mark.parametrize("name", PROBLEMS)
def test_it_is_the_native_problem(name):
    """From the same state, the same steps."""
    stepper = _core.make_stepper(PROBLEMS[name])
    with env_of(name, **({"noise": 0} if name == "Discrim" else {})) as env:
        env.reset(seed=2)
        stepper.state = env.unwrapped._simulation.state
        if name == "Discrim":
            stepper.set(500, _core.ArenaOptions(noise=0))
        for _ in range(40):
            action = env.action_space.sample()
            observation, reward, terminated, truncated, _ = env.step(action)
            assert (reward, terminated) == stepper.step(action.astype(float)) and not truncated
            assert np.array_equal(observation, stepper.observation.astype(np.float32))
            if terminated:
                break


@pytest.mark.parametrize("name", PROBLEMS)
def test_time_truncates(name):
    with env_of(name) as env:
        for seed in range(20):
            env.reset(seed=seed)
            steps, terminated, truncated = 0, False, False
            while not (terminated or truncated):
                _, _, terminated, truncated, _ = env.step(np.zeros(env.action_space.shape))
                steps += 1
            assert truncated == (steps == LONGEST[name]) and terminated != truncated
            if truncated:
                return
    assert name == "DoublePole"  # falls without help


@pytest.mark.parametrize("name", LONGEST)
def test_bad_actions_are_refused_in_a_sentence(name):
    with env_of(name) as env:
        env.reset(seed=1)
        size = env.action_space.shape[0]
        for bad in (np.zeros(size + 1), np.zeros(0), np.zeros((size, 1)), ["left"] * size):
            refused(lambda bad=bad: env.step(bad), f"has {size} number")
        for bad in (np.nan, np.inf):
            refused(lambda bad=bad: env.step(np.full(size, bad)), "finite")


# predator and prey


def zoo():
    pytest.importorskip("pettingzoo")
    from botschool.envs.predprey import parallel_env

    return parallel_env


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # pettingzoo's own
def test_passes_the_tests_of_pettingzoo():
    parallel_env = zoo()
    from pettingzoo.test import parallel_api_test, parallel_seed_test

    parallel_api_test(parallel_env(max_steps=60), num_cycles=200)
    parallel_seed_test(parallel_env, num_cycles=30)


def test_the_chase_of_two_agents_is_the_arena():
    env, own = zoo()(max_steps=30), arena.make("predprey", 30)
    rng = np.random.default_rng(2)
    views, _ = env.reset(seed=1)
    for _ in range(30):
        action = rng.uniform(-1, 1, 4).astype(np.float32)
        seen = np.concatenate([views["predator"], views["prey"]])
        assert np.array_equal(seen, own.observation.astype(np.float32))
        own.action = action
        reward = own.step()
        views, rewards, over, truncated, _ = env.step({"predator": action[:2], "prey": action[2:]})
        assert env.state().tolist() == own.state.tolist()
        assert rewards == {"predator": reward, "prey": 1.0 - reward if own.done else 0.0}
        assert over == {"predator": own.done, "prey": own.done}
        assert not any(truncated.values())
    assert env.agents == []
    refused(lambda: env.step({}), "has ended")
    env.reset()
    refused(lambda: env.step({"predator": np.zeros(2)}), "the prey has no action")
    refused(lambda: env.step({"predator": np.zeros(3), "prey": np.zeros(2)}), "has 2 numbers")


def both_networks(**policy):

    config = PolicyConfig(nrobots=2, heterogeneous=1, **policy)
    problem = make("ErPredprey")
    return problem, Policy("ErPredprey", problem.interface, config)


@pytest.mark.parametrize("name", SIDES)
def test_the_opponent_is_the_one_that_was_evolved(name, tmp_path):
    """Its side of an evaluated episode, when ours acts as there: nearly, evolution rounds more."""
    problem, policy = both_networks(nhiddens=25, bias=1, architecture=3)
    genotype = policy.initial(3)
    path = tmp_path / "both.npy"
    np.save(path, genotype)
    one = policy.nparameters
    theirs = genotype[one:] if name == "Predator" else genotype[:one]
    own, other = (slice(0, 2), slice(2, 4)) if name == "Predator" else (slice(2, 4), slice(0, 2))
    transitions = list(problem.play(policy, genotype, None, 1, 0, 2000))[:100]
    states = []
    for opponent in (path, genotype, theirs):
        with env_of(name, opponent=opponent) as env:
            env.reset(seed=1)
            for transition in transitions:
                env.step(transition.action[own])
            states.append(env.unwrapped._simulation.state)
    assert np.array_equal(states[0], states[1]) and np.array_equal(states[0], states[2])
    assert states[0] == pytest.approx(transitions[-1].state, rel=0, abs=0.05)
    assert other != own


def test_opponents_that_cannot_be(tmp_path):
    path = tmp_path / "bad.npy"
    path.write_text("no genotype")
    refused(lambda: env_of("Prey", opponent=path), "not a genotype")
    refused(lambda: env_of("Prey", opponent=tmp_path / "none.npy"), "none.npy")
    refused(lambda: env_of("Prey", opponent=np.zeros(7)), "shape (7,)")
    refused(lambda: env_of("Prey", opponent=np.full(10954, np.nan)), "")
    refused(lambda: env_of("Prey", experiment=tmp_path / "none.ini"), "none.ini")


# training


# --- CartPole with any force: at full force it is Gymnasium's CartPole.


gymnasium.register_envs(botschool.envs)
PUSHED = "botschool/PushedCartPole-v0"


def test_passes_the_checker():
    with gymnasium.make(PUSHED) as env:
        check_env(env.unwrapped, skip_render_check=True)
        assert env.spec.max_episode_steps == 500


@pytest.mark.parametrize("factor", [1.0, 3.0])
def test_full_force_is_cartpole(factor):
    """Beyond its limits the action is cut."""
    sides = np.random.default_rng(1).integers(0, 2, 30)
    with gymnasium.make("CartPole-v1") as known, gymnasium.make(PUSHED) as own:
        observed = [known.reset(seed=4)[0], own.reset(seed=4)[0]]
        for side in sides:
            np.testing.assert_array_equal(*observed)
            push = np.array([factor * (2 * side - 1)], dtype=np.float32)
            one, other = known.step(int(side)), own.unwrapped.step(push)
            assert one[1:4] == other[1:4]
            observed = [one[0], other[0]]
            if one[2]:
                break


# --- The balancing robot, which lives in a package of its own, as a problem.


BALANCE = "BalanceBotBulletEnv-v0"


def test_missing_package_is_said_in_a_sentence(monkeypatch):
    monkeypatch.setitem(sys.modules, "balance_bot", None)
    monkeypatch.delitem(gymnasium.registry, BALANCE, raising=False)
    with pytest.raises(BotschoolError, match=r"pip install -e envs/balance_bot") as raised:
        problems.make(BALANCE)
    assert str(raised.value).count(".") == 1
