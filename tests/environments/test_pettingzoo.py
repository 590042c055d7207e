"""PettingZoo environments of two agents co-evolve (docs/specification.md, "Two sides")."""

from functools import partial

import numpy as np
import pytest

pytest.importorskip("pettingzoo")

import plain_algorithms
from botschool import _core, config, problems
from botschool.evolution.algorithm import ALGORITHMS as ALGORITHMS_BY_NAME
from botschool.evolution.coevolution import Coevolution
from botschool.policies.hyperparameters import PolicyConfig
from botschool.problems import Episodes
from duels import ALGORITHMS, FACE, run, write
from running import contents, same


def duel(options="", **policy):
    problem = problems.make("duels:Duel", options=options, competitive=True)
    return problem, problem.policy(PolicyConfig(nrobots=2, heterogeneous=1, **policy))


# networks of two sizes


def test_each_side_has_a_network_for_what_it_sees_and_does():
    problem, policy = duel(nhiddens=4, bias=1)
    assert problem.sides == ("cat", "mouse")
    assert policy.sizes == [4 * 3 + 4 + 4 + 1, 4 * 3 + 4 * 5 + 4 + 5]
    assert policy.nparameters == max(policy.sizes) and policy.neurons == ([3, 3], [1, 5])
    first = policy.initial(7, 2)
    assert first.shape == (2 * policy.nparameters,)
    assert (first[policy.sizes[0] : policy.nparameters] == 0).all()


# episodes


def test_an_episode_is_what_stepping_the_environment_gives():
    """... with an agent that leaves before the other."""
    from botschool.problems.spaces import fitted
    from duels import Duel

    problem, policy = duel(nhiddens=4, bias=1, action_noise=1, action_noise_range=0.3)
    rows = np.array([policy.initial(3, i) for i in range(12)])
    outcome = problem.evaluate(policy, rows, None, Episodes.of(np.full(12, 5), 1), 20)
    left_early = 0
    for i, row in enumerate(rows):
        env = Duel()
        seen, _ = env.reset(seed=5)
        totals, steps = dict.fromkeys(env.possible_agents, 0.0), 0
        for k, (side, genotype) in enumerate(zip(policy.sides, np.split(row, 2), strict=True)):
            side.network.parameters[:] = genotype[: policy.sizes[k]]
            side.network.seed(5 + k * 2**48, 0)
            side.network.reset()
        cat, mouse = policy.sides
        while env.agents:
            actions = {"cat": fitted(cat.act(seen["cat"].astype(float)), env.action_space("cat"))}
            if "mouse" in env.agents:
                flat = np.append(seen["mouse"]["cat"], np.eye(2)[seen["mouse"]["side"]])
                actions["mouse"] = fitted(mouse.act(flat), env.action_space("mouse"))
            seen, paid, *_ = env.step(actions)
            steps += 1
            for agent, reward in paid.items():
                totals[agent] += reward
            left_early += env.agents == ["cat"]
        assert outcome.steps[i] == steps == 8
        assert outcome.fitness[:, i].tolist() == list(totals.values())
    assert left_early > 0


def test_episodes_depend_on_seed_and_number_alone():
    problem, policy = duel(nhiddens=2)
    rows = np.array([policy.initial(3, i) for i in range(4)])
    pairs = np.array([[0, 0, 1, 2], [0, 3, 2, 1]], dtype=np.int32)
    genotypes = rows.reshape(8, -1)
    seeds, numbers = np.array([1, 2, 3, 4], np.uint64), np.array([1, 0, 0, 2], np.uint32)
    whole = problem.evaluate(policy, genotypes, None, Episodes(pairs, seeds, numbers), 20)
    assert whole.fitness.shape == (2, 4) and len(set(whole.fitness.ravel())) > 4
    back = slice(None, None, -1)
    again = problem.evaluate(
        policy, genotypes, None, Episodes(pairs[:, back], seeds[back], numbers[back]), 20
    )
    assert np.array_equal(whole.fitness, again.fitness[:, back])


# our predators and prey, by both ways


def test_an_episode_of_our_face_is_that_of_the_native_problem_in_double_precision():
    """Networks and world, step by step, without either of the ways to play an episode."""
    wild = {"nhiddens": 5, "architecture": 3, "winit": 2, "wrange": 2}
    options = PolicyConfig(nrobots=2, heterogeneous=1, bias=1, **wild)
    problem = problems.make(FACE, options="max_steps=300", competitive=True)
    policy = problem.policy(options)
    native = problems.make("ErPredprey").policy(options)
    rows = np.array([policy.initial(1, i) for i in range(6)])
    assert all(np.array_equal(row, native.initial(1, i)) for i, row in enumerate(rows))
    outcome = problem.evaluate(policy, rows, None, Episodes.of(np.full(6, 5), 1), 300)
    stepper = _core.make_stepper("ErPredprey")
    stepper.set(300, None)
    for i, row in enumerate(rows):
        stepper.start(1, 0)
        for side, genotype in zip(policy.sides, np.split(row, 2), strict=True):
            side.network.parameters[:] = genotype
            side.network.reset()
        paid, steps, ended = 0.0, 0, False
        while not ended and steps < 300:
            views = np.split(stepper.observation.astype(np.float32).astype(float), 2)
            acts = [side.act(view) for side, view in zip(policy.sides, views, strict=True)]
            reward, ended = stepper.step(np.concatenate(acts).astype(float))
            paid, steps = paid + reward, steps + 1
        assert (outcome.fitness[:, i].tolist(), outcome.steps[i]) == ([paid, 1 - paid], steps)
    assert len(set(outcome.steps.tolist())) > 2


BOLD = {"maxsteps": 60, "nhiddens": 0, "winit": 2, "bias": 1}


def test_a_run_of_our_face_leaves_what_the_native_problem_leaves(tmp_path):
    native = write(tmp_path / "native", "ErPredprey", "archive", "", BOLD)
    face = write(tmp_path / "face", FACE, "archive", "max_steps=60", BOLD)
    assert run(native, tmp_path / "a", generations=2) and run(face, tmp_path / "b", generations=2)
    one, two = contents(tmp_path / "a"), contents(tmp_path / "b")
    fitness = np.load(tmp_path / "a" / "S3FitG2.npy")
    assert len(set(fitness.ravel().tolist())) > 4
    for name in one.keys() | two.keys():
        if name != "checkpointS3.npz:botschool":
            assert one[name] == two[name], name


# runs


@pytest.mark.slow
@pytest.mark.parametrize("algo", ALGORITHMS)
def test_they_evolve_alike_with_workers_and_resumed(algo, tmp_path):
    own = write(tmp_path, algo=algo, policy={"episodes": 2})
    assert run(own, tmp_path / "whole")
    assert run(own, tmp_path / "parts", generations=2)
    assert run(own, tmp_path / "parts", workers=2 if algo == "coevo2" else 1, resume=True)
    for path in (tmp_path / "parts").glob("S3*G2.npy"):
        if not (tmp_path / "whole" / path.name).exists():
            path.unlink()
    assert same(tmp_path / "whole", tmp_path / "parts")


@pytest.mark.slow
def test_each_side_is_ranked_by_its_own_returns(tmp_path):
    own = config.load(write(tmp_path, policy={"episodes": 2}))
    assert run(tmp_path / "own.ini", tmp_path / "run")
    genotypes, fitness = (np.load(tmp_path / "run" / f"S3{f}G3.npy") for f in ("", "Fit"))
    coevolution = Coevolution(own, 3)
    assert genotypes.shape == (8, coevolution.policy.nparameters) and fitness.shape == (8, 4)
    for rows in np.split(fitness, 2):
        assert (np.diff(rows.mean(axis=1)) <= 1e-12).all()
    for i in range(4):
        for k in range(4):
            pairs = np.array([[i, i], [4 + k, 4 + k]], dtype=np.int32)
            episodes = Episodes(pairs, np.full(2, 3, np.uint64), np.arange(2, dtype=np.uint32))
            outcome = coevolution.problem.evaluate(
                coevolution.policy, genotypes, None, episodes, 20
            )
            cat, mouse = outcome.fitness.mean(axis=1)
            assert (fitness[i, k], fitness[4 + k, i]) == pytest.approx((cat, mouse))
            assert abs(cat + mouse - 1) > 1e-9


# algorithms


@pytest.mark.parametrize("algo", ALGORITHMS)
def test_two_returns_that_add_up_to_1_evolve_as_one(algo):
    """... and what counts is the order of returns, not their scale."""
    entry = ALGORITHMS_BY_NAME[algo]
    options = ALGORITHMS[algo] | {"samplesize": 3, "noiseStdDev": 0.1, "stepsize": 0.03}
    settings = entry.config(**options | ({"preferential": 1} if algo == "archivestar" else {}))

    def scaled(*meeting, scale=1.0):
        fitness = plain_algorithms.play(*meeting)
        return np.stack([scale * fitness, 1 - fitness])

    one = entry.make(settings, plain_algorithms.initial, 9)
    two = entry.make(settings, plain_algorithms.initial, 9, constant_sum=False)
    four = entry.make(settings, plain_algorithms.initial, 9, constant_sum=False)
    for _ in range(4):
        one.advance(plain_algorithms.play)
        two.advance(scaled)
        four.advance(partial(scaled, scale=4.0))
        for name in ("parameters",) if algo == "coevo2" else ("centres", "champions"):
            assert np.array_equal(getattr(one, name), getattr(two, name))
            assert np.array_equal(getattr(one, name), getattr(four, name))
        if algo == "coevo2" or one.generation > 1:
            both = one.summary(), four.summary()
            assert both[1]["predators"] == pytest.approx(4 * both[0]["predators"])
            assert both[1]["prey"] == pytest.approx(both[0]["prey"])
