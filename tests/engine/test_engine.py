"""Fitness is a pure function of genotype, normalisation, problem, seed and episode: the same bits
whoever computes it."""

import threading

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from botschool import _core, problems
from botschool.config import PolicyConfig
from botschool.policies.policy import Policy
from botschool.problems import Episodes
from reference_network import REPEATABLE, random_normalisation

CANDIDATES, EPISODES, LIMIT = 9, 5, 150
INFOS = {info["name"]: info for info in _core.native_problems()}
POLICIES = {
    "feed-forward": {"nhiddens": 5, "bias": 1},
    "recurrent": {"nhiddens": 5, "architecture": 1, "normalize": 1, "clip": 1},
    "fully recurrent": {"nhiddens": 5, "architecture": 2, "action_noise": 1},
    "LSTM": {"nhiddens": 5, "architecture": 3, "normalize": 1, "action_noise": 2},
    "relu": {"nhiddens": 40, "nlayers": 2, "bias": 1, "afunction": 5, "out_type": 5},
    "large actions": {"nhiddens": 3, "out_type": 3, "winit": 2, "wrange": 4},
}


def policy_of(name, kind="feed-forward"):
    """A policy; where there are several robots, with a network for each."""
    interface = problems.make(name).interface
    robots = {"nrobots": interface.robots, "heterogeneous": int(interface.robots > 1)}
    return Policy(name, interface, PolicyConfig(**POLICIES[kind], **robots))


class Batch:
    """Several candidates, each in several episodes, in some order."""

    def __init__(self, policy, seed=1, limit=LIMIT):
        rng = np.random.default_rng(seed)
        self.genotypes = np.array([policy.initial(seed, i) for i in range(CANDIDATES)])
        body = policy.interface.morphology
        if body:
            self.genotypes[:, -body:] = rng.normal(0, 0.6, (CANDIDATES, body))
        self.normalisation = None
        if policy.spec.normalize:
            self.normalisation = random_normalisation(policy.spec, rng)
        self.episodes = Episodes.of(rng.integers(2**63, size=CANDIDATES), EPISODES)
        self.episodes.collect = (rng.random(len(self.episodes)) < 0.4).astype(np.uint8)
        self.limit = limit
        self.heterogeneous = bool(policy.config.heterogeneous)

    def evaluate(self, engine, chosen=slice(None), threads=1, genotypes=None, candidate=None):
        """Fitness, steps and moments of the chosen episodes."""
        part = self.episodes.select(chosen)
        return engine.evaluate(
            self.genotypes if genotypes is None else genotypes,
            self.normalisation,
            np.atleast_2d(part.candidate if candidate is None else candidate),
            part.seed,
            part.episode,
            part.collect,
            self.limit,
            threads,
            self.heterogeneous,
        )


def same(one, other):
    """Bit for bit, NaN and signed zeros included."""
    return all(a.tobytes() == b.tobytes() and a.dtype == b.dtype for a, b in zip(one, other))  # noqa: B905


HEAVY = {"ErPredprey", "ErStaybehind", "PlanarBodyBrain-v0", "PlanarHalfCheetah-v0"}
HEAVY |= {
    "PlanarHalfCheetah-v5",
    "SpatialAnt-v0",
    "SpatialAnt-v5",
    "SpatialHumanoidStandup-v0",
    "SpatialBody-v0",
}
"""An episode of these takes long."""
CASES = [
    pytest.param(name, kind, marks=pytest.mark.slow if name in HEAVY else ())
    for i, name in enumerate(INFOS)
    for j, kind in enumerate(POLICIES)
    if (i + j) % 3 == 0
]
"""Each problem with two networks, each network with many problems."""


@pytest.mark.parametrize(("name", "kind"), CASES)
def test_results_depend_on_the_episode_alone(name, kind):
    policy = policy_of(name, kind)
    batch = Batch(policy)
    engines = {isa: _core.Engine(name, policy.spec.core(), isa) for isa in _core.instruction_sets()}
    expected = batch.evaluate(engines["baseline"])
    fitness, steps, moments = expected
    n = CANDIDATES * EPISODES
    assert fitness.shape == steps.shape == (n,)
    assert moments.shape == (n, 2 * policy.spec.inputs)
    assert 1 <= steps.min() <= steps.max() <= LIMIT
    same_start = dict.fromkeys(("ErPredprey", "ErStaybehind", "PlanarBodyBrain-v0"), CANDIDATES / 2)
    often_blind = {"ErArena": 3}  # tests/engine/test_declared_arenas.py has one that sees
    # the episodes differ, or where a start is always the same, the candidates do
    assert len(np.unique(moments, axis=0)) > (same_start | often_blind).get(name, n / 4)
    order = np.random.default_rng(2).permutation(n)
    for isa, engine in engines.items():
        for threads in (1, 2, 5, 100):
            assert same(batch.evaluate(engine, threads=threads), expected), (isa, threads)
        assert same(batch.evaluate(engine, order, 3), [x[order] for x in expected]), isa
        singles = [batch.evaluate(engine, slice(i, i + 1)) for i in range(0, n, 4)]
        for i, single in zip(range(0, n, 4), singles, strict=True):
            assert same(single, [x[i : i + 1] for x in expected]), (isa, i)
        # candidates under other numbers, among others, with something (a body) at their end
        padded = np.pad(self_reversed(batch.genotypes), ((3, 1), (0, 2)), constant_values=np.nan)
        moved = (CANDIDATES - 1 - batch.episodes.candidate + 3).astype(np.int32)
        assert same(batch.evaluate(engine, genotypes=padded, candidate=moved), expected), isa


def self_reversed(rows):
    return np.ascontiguousarray(rows[::-1])


@REPEATABLE
@given(st.lists(st.tuples(st.integers(0, 3), st.integers(0, 5)), max_size=70), st.integers(1, 4))
def test_any_batch_is_made_of_single_episodes(pairs, threads):
    """Repetitions, one candidate many times, more or fewer episodes than lanes."""
    policy, engine, alone = few_episodes()
    pairs = np.array(pairs, dtype=np.int64).reshape(-1, 2)
    fitness, steps, moments = engine.evaluate(
        np.array([policy.initial(3, i) for i in range(4)]),
        None,
        pairs[:, 0].astype(np.int32)[None],
        (pairs[:, 0] + 10).astype(np.uint64),
        pairs[:, 1].astype(np.uint32),
        None,
        60,
        threads,
    )
    assert moments is None and steps.dtype == np.int32
    assert fitness.tolist() == [alone[c, e] for c, e in pairs.tolist()]


def few_episodes(cache=[]):  # noqa: B006
    if not cache:
        policy = policy_of("ErDpole", "LSTM")
        engine = _core.Engine("ErDpole", policy.spec.core())
        alone = {
            (c, e): engine.record(policy.initial(3, c)[None], None, c + 10, e, 60)["fitness"]
            for c in range(4)
            for e in range(6)
        }
        cache.append((policy, engine, alone))
    return cache[0]


@pytest.mark.parametrize(("name", "kind"), CASES)
def test_a_recorded_episode_is_the_evaluated_one(name, kind):
    policy = policy_of(name, kind)
    batch = Batch(policy, seed=4)
    batch.episodes.collect[:] = 1
    engine = _core.Engine(name, policy.spec.core())
    fitness, steps, moments = batch.evaluate(engine)
    info = INFOS[name]
    for i in range(0, len(fitness), 4):
        episodes = batch.episodes
        tape = engine.record(
            batch.genotypes[[episodes.candidate[i]]],
            batch.normalisation,
            int(episodes.seed[i]),
            int(episodes.episode[i]),
            LIMIT,
            batch.heterogeneous,
        )
        n = len(tape["rewards"])
        assert n == steps[i]
        total = 0.0
        for reward in tape["rewards"]:
            total += reward
        assert tape["fitness"] == total == fitness[i]
        robots = info["robots"]
        assert tape["observations"].shape == (n, robots * info["observations"])
        assert tape["actions"].shape == (n, robots * (1 if info["discrete"] else info["outputs"]))
        assert tape["states"].shape == (n + 1, info["states"])
        sums, squares = np.split(moments[i], 2)
        seen = tape["observations"].reshape(robots * n, -1)
        assert sums == pytest.approx(seen.sum(axis=0), rel=1e-12, abs=1e-9)
        assert squares == pytest.approx((seen**2).sum(axis=0), rel=1e-12, abs=1e-9)
        body = batch.genotypes[episodes.candidate[i]][policy.networks * policy.nparameters :]
        replay(name, tape, int(episodes.seed[i]), int(episodes.episode[i]), body)


def replay(name, tape, seed, episode, body):
    """Each step of a tape is a step of the problem."""
    stepper = _core.make_stepper(name)
    stepper.set_body(body.copy())
    stepper.set(LIMIT)
    stepper.start(seed, episode)
    assert np.array_equal(stepper.state, tape["states"][0])
    stepper.state = tape["states"][0]
    # infrared readings fade steeply, so what single precision loses grows
    near = {"abs": 1e-4} if "plan" in INFOS[name] else {"rel": 1e-6, "abs": 1e-6}
    for t, action in enumerate(tape["actions"]):
        assert tape["observations"][t] == pytest.approx(stepper.observation, **near)
        assert stepper.step(action)[0] == tape["rewards"][t]
        assert np.array_equal(stepper.state, tape["states"][t + 1])


@pytest.mark.slow
def test_engines_work_side_by_side():
    """In Python threads too: each has memory of its own."""
    cases = [(name, kind) for name in INFOS for kind in ("recurrent", "LSTM")]
    batches = [Batch(policy_of(*case)) for case in cases]
    engines = [_core.Engine(c[0], policy_of(*c).spec.core()) for c in cases]
    expected = [b.evaluate(e) for b, e in zip(batches, engines, strict=True)]
    results = {}

    def work(i):
        results[i] = batches[i // 2].evaluate(engines[i // 2], threads=2)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(2 * len(cases))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(same(results[i], expected[i // 2]) for i in range(2 * len(cases)))


@pytest.mark.parametrize("name", INFOS)
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e300, 1e-320])
def test_wild_genotypes_end_like_others(name, value):
    """Nothing hangs or crashes, and neighbours in other lanes are not disturbed."""
    for kind in ("feed-forward", "LSTM", "large actions"):
        policy = policy_of(name, kind)
        batch = Batch(policy)
        engine = _core.Engine(name, policy.spec.core())
        expected = batch.evaluate(engine)
        batch.genotypes[4] = value
        result = batch.evaluate(engine)
        others = batch.episodes.candidate != 4
        assert same([x[others] for x in result], [x[others] for x in expected])
        assert np.all(result[1] <= LIMIT)


@pytest.mark.slow
@pytest.mark.parametrize("isa", _core.instruction_sets())
def test_a_block_of_pairs_is_made_of_single_episodes(isa):
    """One competitor after another for all candidates, when lanes share its weights, or mixed."""
    policy = policy_of("ErPredprey", "LSTM")
    engine = _core.Engine("ErPredprey", policy.spec.core(), isa)
    # initial weights are too cautious: nobody would meet anybody
    genotypes = 3 * np.array([policy.initial(3, i)[: policy.nparameters] for i in range(23)])
    pairs = np.array([(c, k) for k in (20, 21, 22) for c in range(20)], dtype=np.int32).T

    def fitness(pairs, threads=1):
        n = pairs.shape[1]
        ones = np.ones(n, dtype=np.uint64), np.zeros(n, dtype=np.uint32)
        return engine.evaluate(genotypes, None, pairs, *ones, None, 400, threads)[:2]

    alone = [fitness(pairs[:, i : i + 1].copy()) for i in range(pairs.shape[1])]
    expected = [np.concatenate(part) for part in zip(*alone, strict=True)]
    assert len(set(expected[1].tolist())) > 1  # episodes end at different times
    order = np.random.default_rng(1).permutation(pairs.shape[1])
    for threads in (1, 3):
        assert same(fitness(pairs, threads), expected)
        assert same(
            fitness(np.ascontiguousarray(pairs[:, order]), threads), [x[order] for x in expected]
        )
