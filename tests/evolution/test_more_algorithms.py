"""GA, (1+1)-ES and PGPE against small implementations in plain Python of docs/specification.md,
"Algorithms"; what all have in common.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

import botschool.evolution.algorithms  # noqa: F401  (fills ALGORITHMS)
from botschool.evolution.algorithm import ALGORITHMS
from botschool.evolution.algorithms.ga import GA, GAConfig
from botschool.evolution.algorithms.oneplusone import OnePlusOne, OnePlusOneConfig
from botschool.evolution.algorithms.pgpe import PGPE, PGPEConfig

SIZE = 7


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


# --- CMA-ES and xNES beside pycma, Hansen's own CMA-ES: the same steps, and the same optima.


N = 6


def sphere(x):
    return (x**2).sum(axis=-1)


def ellipsoid(x):
    return (np.geomspace(1, 1e6, x.shape[-1]) * x**2).sum(axis=-1)


def cigar(x):
    return x[..., 0] ** 2 + 1e6 * (x[..., 1:] ** 2).sum(axis=-1)


def rosenbrock(x):
    first, second = x[..., :-1], x[..., 1:]
    return (100 * (second - first**2) ** 2 + (1 - first) ** 2).sum(axis=-1)


def rotated(x):
    """The ellipsoid along axes that no coordinate has."""
    q, _ = np.linalg.qr(np.random.default_rng(1).standard_normal((N, N)))
    return ellipsoid(x @ q)


def ours(algo, start, sigma, seed=1, **options):
    entry = ALGORITHMS[algo]
    return entry.make(entry.config(sigma=sigma, **options), lambda index: start, seed)


def theirs(start, sigma, seed=1, **options):
    cma = pytest.importorskip("cma")  # takes seconds to import
    return cma.CMAEvolutionStrategy(start, sigma, {"seed": seed, "verbose": -9} | options)


@pytest.mark.slow
@pytest.mark.parametrize("popsize", [9, 30])
@pytest.mark.parametrize("f", [ellipsoid, rotated])
def test_the_same_samples_give_the_same_mean_sigma_and_covariance(f, popsize):
    start = np.full(N, 0.7)
    one = ours("CMA-ES", start, 0.5, popsize=popsize, active=0)
    two = theirs(start, 0.5, popsize=popsize, CMA_active=False)
    two.adapt_sigma.initialize(two)
    # where pycma and the tutorial differ: n + mueff + 3 instead of 5, and the exact length of a
    # normal vector instead of the tutorial's formula
    two.adapt_sigma.cs = one.settings.csigma
    two.adapt_sigma.damps = one.settings.dsigma
    cma = pytest.importorskip("cma")
    exact = cma.utilities.math.Mh.chiN(N)
    assert one.settings.length == pytest.approx(exact, rel=1e-3)
    one.settings = replace(one.settings, length=exact)
    # pycma's first matrix is not quite 1
    np.testing.assert_allclose(two.sm.C, np.eye(N), atol=1e-3)
    one.matrix.covariance = np.array(two.sm.C)
    one.matrix.decompose()
    assert two.sp.c1 == pytest.approx(one.settings.c1)
    assert two.sp.cmu == pytest.approx(one.settings.cmu)
    assert two.sp.cc == pytest.approx(one.settings.cc)
    for _ in range(40):
        candidates = two.ask()
        one.ask()
        one.y = (np.array(candidates) - one.mean) / one.sigma
        one.z = np.linalg.solve(one.matrix.root, one.y.T).T
        fitness = f(np.array(candidates))
        one.tell(-fitness)
        two.tell(candidates, fitness.tolist())
        np.testing.assert_allclose(one.mean, two.mean, rtol=1e-7, atol=1e-10)
        assert one.sigma == pytest.approx(two.sigma, rel=1e-7)
        covariance = one.matrix.covariance
        np.testing.assert_allclose(covariance, two.sm.C, atol=1e-7 * np.abs(covariance).max())


def evaluations(algorithm, f, budget, target=1e-8):
    """Evaluations until a candidate is that good; None if none of the budget is."""
    used = 0
    while used < budget:
        candidates, _ = algorithm.ask()
        values = f(candidates)
        used += len(values)
        if values.min() < target:
            return used
        algorithm.tell(-values)
    return None


def evaluations_of_pycma(strategy, f, budget, target=1e-8):
    while strategy.countevals < budget:
        candidates = strategy.ask()
        values = f(np.array(candidates))
        strategy.tell(candidates, values.tolist())
        if values.min() < target:
            return strategy.countevals
    return None


@pytest.mark.slow
@pytest.mark.parametrize("f", [sphere, ellipsoid, cigar, rosenbrock, rotated])
def test_they_reach_the_optimum_that_pycma_reaches(f):
    """Within 1e-8: CMA-ES as fast, xNES several times slower, as its learning rates are.

    Rosenbrock's function has a second optimum, so that one starts between both."""
    start = np.full(N, 0.0 if f is rosenbrock else 2.0)
    needed = evaluations_of_pycma(theirs(start, 0.5), f, 20000)
    own = [evaluations(ours("CMA-ES", start, 0.5, seed), f, 20000) for seed in (1, 2)]
    assert all(own) and 0.6 * needed < np.mean(own) < 1.6 * needed
    assert evaluations(ours("xNES", start, 0.5), f, 60000)
