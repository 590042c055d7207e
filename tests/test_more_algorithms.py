"""GA, (1+1)-ES and PGPE against small implementations in plain Python of docs/specification.md,
"Algorithms"; what all have in common."""

import math

import numpy as np
import pytest

from botschool.errors import BotschoolError
from botschool.evolution.algorithm import ALGORITHMS
from botschool.evolution.algorithms.ga import GA, GAConfig
from botschool.evolution.algorithms.oneplusone import OnePlusOne, OnePlusOneConfig
from botschool.evolution.algorithms.pgpe import PGPE, PGPEConfig
from running import experiment, run_seeds, same

SIZE = 7
NEW = ("GA", "(1+1)-ES", "PGPE")


def initial(index):
    return np.random.default_rng(index).normal(size=SIZE)


def stream(seed, generation):
    return np.random.Generator(np.random.Philox(key=[seed, generation]))


def fitness_of(candidates):
    return -np.abs(np.asarray(candidates) - 0.3).sum(axis=1)


@pytest.mark.parametrize("crossrate", [0.0, 0.5])
def test_ga_agrees_with_plain_python(crossrate):
    config = GAConfig(popsize=6, selsize=3, mutrate=0.1, crossrate=crossrate)
    ga, expected = GA(config, initial, 5), [initial(i).tolist() for i in range(6)]
    for generation in range(4):
        population, seeds = ga.ask()
        assert population.tolist() == expected and seeds.tolist() == [5 + generation] * 6
        fitness = fitness_of(population)
        parents = [expected[i] for i in sorted(range(6), key=lambda i: -fitness[i])[:3]]
        numbers = stream(5, generation)
        first, second = numbers.integers(3, size=(2, 5)).tolist()
        crossed = (numbers.random(5) < crossrate).tolist()
        other = (numbers.random((5, SIZE)) < 0.5).tolist()
        noise = numbers.standard_normal((5, SIZE)).tolist()
        expected = [parents[0]] + [
            [
                parents[second[k] if crossed[k] and other[k][j] else first[k]][j]
                + 0.1 * noise[k][j]
                for j in range(SIZE)
            ]
            for k in range(5)
        ]
        before = population.copy()
        ga.tell(fitness)
        assert np.array_equal(population, before), "what ask() gave has been overwritten"
        np.testing.assert_allclose(ga.population, expected, rtol=1e-12)
        expected = ga.population.tolist()


def test_ga_mixes_two_parents_if_asked_to():
    mixed = GA(GAConfig(popsize=30, selsize=2, mutrate=0.0, crossrate=1.0), initial, 5)
    fitness = np.zeros(30)
    fitness[:2] = 2, 1
    mixed.tell(fitness)
    parents = np.array([initial(0), initial(1)])
    assert np.isin(mixed.population, parents).all()
    assert len({row.tobytes() for row in mixed.population}) > 10
    assert np.array_equal(mixed.population[0], parents[0])


def test_one_plus_one_agrees_with_plain_python():
    config = OnePlusOneConfig(sigma=0.5, growth=0.4)
    es, parent, sigma, won = OnePlusOne(config, initial, 9), initial(0), 0.5, 0
    for generation in range(60):
        both, seeds = es.ask()
        child = parent + sigma * stream(9, generation).standard_normal(SIZE)
        np.testing.assert_allclose(both, [parent, child], rtol=1e-12)
        assert seeds.tolist() == [9 + generation] * 2
        fitness = fitness_of(both)
        es.tell(fitness)
        success = fitness[1] >= fitness[0]
        parent, won = (child if success else parent), won + success
        sigma *= math.exp(0.4 if success else -0.1)
        assert es.sigma == pytest.approx(sigma)
    assert 5 < won < 30
    assert fitness_of(parent[None])[0] > fitness_of(initial(0)[None])[0]


def test_one_plus_one_keeps_a_child_that_is_as_good():
    es = OnePlusOne(OnePlusOneConfig(), initial, 1)
    both, _ = es.ask()
    es.tell(np.zeros(2))
    assert np.array_equal(es.parent, both[1])


def test_pgpe_agrees_with_plain_python():
    config = PGPEConfig(samplesize=5, sigma=0.4, etamu=2.0, etasigma=1.5)
    pgpe, mean, sigma = PGPE(config, initial, 3), initial(0).tolist(), [0.4] * SIZE
    clipped = 0
    for generation in range(5):
        candidates, seeds = pgpe.ask()
        z = stream(3, generation).standard_normal((5, SIZE)).tolist()
        for b in range(5):
            for k, sign in enumerate((1, -1)):
                expected = [mean[j] + sign * sigma[j] * z[b][j] for j in range(SIZE)]
                assert candidates[2 * b + k] == pytest.approx(expected)
        assert seeds.tolist() == [3 + generation] * 10
        fitness = fitness_of(candidates)
        pgpe.tell(fitness)
        place = {i: r for r, i in enumerate(sorted(range(10), key=lambda i: fitness[i]))}
        reward = [-1 + 2 * place[i] / 9 for i in range(10)]
        for j in range(SIZE):
            towards = sum((reward[2 * b] - reward[2 * b + 1]) / 2 * z[b][j] for b in range(5)) / 5
            wider = sum(
                (reward[2 * b] + reward[2 * b + 1]) / 2 * (z[b][j] ** 2 - 1) for b in range(5)
            )
            change = 1.5 * wider / 5
            clipped += abs(change) > 0.2
            mean[j] += 2.0 * sigma[j] * towards
            sigma[j] *= 1 + min(max(change, -0.2), 0.2)
        assert pgpe.mean == pytest.approx(mean) and pgpe.sigma == pytest.approx(sigma)
    assert 0 < clipped < 5 * SIZE


@pytest.mark.parametrize("algo", NEW)
def test_it_climbs(algo):
    """To the point where all parameters are 0.3."""
    entry = ALGORITHMS[algo]
    made = entry.make(entry.config(), initial, 2)
    start = fitness_of(initial(0)[None])[0]
    for _ in range(400):
        candidates, _ = made.ask()
        fitness = fitness_of(candidates)
        made.tell(fitness)
    assert fitness.max() > start / 10


@pytest.mark.parametrize("algo", NEW)
def test_workers_and_stops_do_not_show(algo, tmp_path):
    sizes = {"GA": {"popsize": 6, "selsize": 3}, "PGPE": {"samplesize": 3}}.get(algo, {})
    own = experiment(tmp_path, "CartPole-v1", algo, {"normalize": 1}, **sizes)
    assert run_seeds(own, tmp_path / "whole")
    assert run_seeds(own, tmp_path / "three", workers=3)
    assert same(tmp_path / "whole", tmp_path / "three")
    for steps in (1000, 2500, None):
        assert run_seeds(own, tmp_path / "parts", steps=steps, resume=True)
    assert same(tmp_path / "whole", tmp_path / "parts")


def test_more_parents_than_individuals_are_refused(tmp_path):
    with pytest.raises(BotschoolError, match="selsize = 9 is more than popsize = 6"):
        experiment(tmp_path, "CartPole-v1", "GA", popsize=6, selsize=9)
