"""SSS, OpenAI-ES and ARS against small implementations in plain Python of docs/specification.md,
"Algorithms".
"""

import math
from dataclasses import fields

import numpy as np
import pytest

import botschool.evolution.algorithms  # noqa: F401  (fills DECLARED)
from botschool.config import OpenAIESConfig, SSSConfig
from botschool.evolution.algorithm import ALGORITHMS as DECLARED
from botschool.evolution.algorithms.ars import ARS, ARSConfig
from botschool.evolution.algorithms.openaies import OpenAIES
from botschool.evolution.algorithms.sss import SSS
from running import experiment, run_seeds, same
from test_mapelites import SMALL as MAP

SIZE = 7


def initial(index):
    return np.random.default_rng(index).normal(size=SIZE)


def numbers(seed, generation, shape):
    """Gaussian numbers of a generation: Philox keyed by (seed, generation)."""
    philox = np.random.Philox(key=np.array([seed, generation], dtype=np.uint64))
    return np.random.Generator(philox).standard_normal(shape)


def fitness_of(candidates, ties=False):
    """Some fitness: nearness to a point, in steps if there are to be ties."""
    values = -np.abs(np.asarray(candidates) - 0.3).sum(axis=1)
    return np.round(values) if ties else values


@pytest.mark.parametrize("ties", [False, True])
def test_sss_overwrites_the_worst_half_with_mutants_of_the_best(ties):
    sss = SSS(SSSConfig(popsize=8, mutrate=0.1), initial, seed=5)
    expected = [initial(i) for i in range(8)]
    for generation in range(4):
        population, seeds = sss.ask()
        assert np.array_equal(population, expected)
        assert seeds.tolist() == [5 + generation] * 8
        fitness = fitness_of(population, ties)
        ranking = sorted(range(8), key=lambda i: -fitness[i])
        noise = numbers(5, generation, (4, SIZE))
        for k in range(4):
            expected[ranking[4 + k]] = expected[ranking[k]] + 0.1 * noise[k]
        before = population.copy()
        sss.tell(fitness)
        assert np.array_equal(population, before), "what ask() gave has been overwritten"
    assert sss.average_parameter() == pytest.approx(
        sum(abs(x) for row in expected for x in row) / (8 * SIZE)
    )


class PlainOpenAIES:
    """The same algorithm, number by number."""

    def __init__(self, config, centre, seed):
        self.c, self.centre, self.seed = config, list(centre), seed
        self.m, self.v, self.t = [0.0] * SIZE, [0.0] * SIZE, 0

    def candidates(self):
        self.e = numbers(self.seed, self.t, (self.c.samplesize, SIZE))
        for e in self.e:
            for sign in (1, -1):
                yield [
                    x + sign * self.c.noiseStdDev * d for x, d in zip(self.centre, e, strict=True)
                ]

    def learn(self, fitness):
        n = len(fitness)
        utility = [0.0] * n
        for rank, i in enumerate(sorted(range(n), key=lambda i: fitness[i])):
            utility[i] = rank / (n - 1) - 0.5
        self.t += 1
        for j in range(SIZE):
            g = sum((utility[2 * b] - utility[2 * b + 1]) * self.e[b][j] for b in range(n // 2)) / n
            g = -g
            if self.c.wdecay == 1:
                g += 0.005 * self.centre[j]
            if self.c.wdecay == 2:
                g += 0.005 * math.copysign(1, self.centre[j])
            self.m[j] = 0.9 * self.m[j] + 0.1 * g
            self.v[j] = 0.999 * self.v[j] + 0.001 * g * g
            m, v = self.m[j] / (1 - 0.9**self.t), self.v[j] / (1 - 0.999**self.t)
            # epsilon belongs to the uncorrected v, as in section 2 of Kingma and Ba
            epsilon = 1e-8 / math.sqrt(1 - 0.999**self.t)
            self.centre[j] -= self.c.stepsize * m / (math.sqrt(v) + epsilon)


@pytest.mark.parametrize("symseed", [0, 1, 2])
@pytest.mark.parametrize("wdecay", [0, 1, 2])
def test_openai_es_agrees_with_plain_python(wdecay, symseed):
    config = OpenAIESConfig(
        samplesize=5, stepsize=0.03, noiseStdDev=0.2, wdecay=wdecay, symseed=symseed
    )
    es, plain = OpenAIES(config, initial, seed=9), PlainOpenAIES(config, initial(0), 9)
    used = set()
    for generation in range(5):
        candidates, seeds = es.ask()
        np.testing.assert_allclose(candidates, list(plain.candidates()), rtol=1e-12, atol=1e-14)
        assert np.array_equal(seeds[0::2], seeds[1::2]) == bool(symseed)
        assert len(set(seeds.tolist())) == (10, 5, 1)[symseed]
        assert not used & set(seeds.tolist()), "generations meet the same conditions"
        used |= set(seeds.tolist())
        fitness = fitness_of(candidates, ties=generation % 2)
        es.tell(fitness)
        plain.learn(fitness.tolist())
        np.testing.assert_allclose(es.centre, plain.centre, rtol=1e-11)
        assert es.average_parameter() == pytest.approx(np.mean(np.abs(plain.centre)))


@pytest.mark.parametrize("symseed", [0, 1, 2])
@pytest.mark.parametrize("ntop", [0, 3])
def test_ars_moves_the_centre_by_the_best_directions(ntop, symseed):
    config = ARSConfig(samplesize=5, ntop=ntop, noiseStdDev=0.1, stepsize=0.3, symseed=symseed)
    ars, centre = ARS(config, initial, seed=9), initial(0)
    for generation in range(4):
        noise = numbers(9, generation, (5, SIZE))
        expected = [centre + sign * 0.1 * e for e in noise for sign in (1, -1)]
        candidates, seeds = ars.ask()
        np.testing.assert_allclose(candidates, expected, rtol=1e-12)
        each = [9 + 5 * generation + b for b in range(5) for _ in "+-"]
        alone = [9 + 10 * generation + i for i in range(10)]
        assert seeds.tolist() == (alone, each, [9 + generation] * 10)[symseed]
        fitness = fitness_of(candidates)
        pairs = sorted(range(5), key=lambda b: -max(fitness[2 * b], fitness[2 * b + 1]))
        pairs = pairs[: ntop or 5]
        counted = [fitness[2 * b + side] for b in pairs for side in (0, 1)]
        step = sum((fitness[2 * b] - fitness[2 * b + 1]) * noise[b] for b in pairs)
        centre = centre + 0.3 / (len(pairs) * np.std(counted)) * step
        ars.tell(fitness)
        np.testing.assert_allclose(ars.centre, centre, rtol=1e-9)
    assert ars.average_parameter() == pytest.approx(np.abs(centre).mean())


SOLVING = [
    ("SSS", {"popsize": 20, "mutrate": 0.1, "maxmsteps": 3}),
    ("OpenAI-ES", {"samplesize": 20, "stepsize": 0.05, "noiseStdDev": 0.1, "maxmsteps": 3}),
    ("ARS", {"samplesize": 20, "stepsize": 0.1, "noiseStdDev": 0.1, "maxmsteps": 3}),
    *[("CMA-ES", own | {"maxmsteps": 1}) for own in ({}, {"active": 0}, {"diagonal": 1})],
    *[(algo, {"maxmsteps": 1}) for algo in ("xNES", "sNES")],
]


@pytest.mark.parametrize(("algo", "options"), SOLVING)
def test_all_solve_cartpole(algo, options, tmp_path):
    """A trivial task; 500 is the best that CartPole-v1 gives."""
    policy = {"episodes": 3, "pepisodes": 20, "maxsteps": 500, "nhiddens": 5, "bias": 1}
    own = experiment(tmp_path, "CartPole-v1", algo, policy, **options)
    seeds = (1, 2) if options["maxmsteps"] == 3 else (1,)
    assert run_seeds(own, tmp_path, seeds)
    for seed in seeds:
        words = (tmp_path / f"S{seed}.fit").read_text().split()
        assert float(words[words.index("bestgfit") + 1]) == 500


RUNS = [
    ("ARS", {}),
    *[("CMA-ES", own | {"popsize": 6}) for own in ({}, {"active": 0}, {"diagonal": 1})],
    *[(algo, {"popsize": 6}) for algo in ("xNES", "sNES")],
    ("GA", {"popsize": 6, "selsize": 3}),
    ("(1+1)-ES", {}),
    ("PGPE", {"samplesize": 3}),
    ("MAP-Elites", MAP | {"maxmsteps": 0.02}),
]
"""Of the algorithms that test_determinism.py does not run."""


@pytest.mark.slow
@pytest.mark.parametrize(("algo", "options"), RUNS)
def test_workers_and_stops_do_not_show(algo, options, tmp_path):
    own = experiment(
        tmp_path, algo=algo, policy={"normalize": int(algo != "MAP-Elites")}, **options
    )
    assert run_seeds(own, tmp_path / "whole", [1, 2])
    assert run_seeds(own, tmp_path / "workers", [1, 2], workers=3)
    for steps in (1, 1500, 1501, 3000, None):
        assert run_seeds(own, tmp_path / "parts", [1, 2], steps=steps, resume=True)
    assert same(tmp_path / "whole", tmp_path / "workers")
    assert same(tmp_path / "whole", tmp_path / "parts")


# --- A checkpoint holds everything of an algorithm that changes: no attribute can be forgotten.


SMALL = {"samplesize": 3, "selsize": 2, "ncompetitors": 3, "popsize": 6, "addtoarchiveevery": 1}
PLAIN = {"archive": {"popsize": 1}, "maxsolvestar": {"popsize": 1, "archivelen": 4}}
NUMBERS = 4

HALL = ["centres", "m", "v", "saved", "champions", "fitness", "archive_predators", "archive_prey"]
SAVED = {
    "ARS": ["centre"],
    "CMA-ES": ["mean", "sigma", "path_sigma", "path_c", "covariance", "root"],
    "OpenAI-ES": ["centre", "m", "v"],
    "SSS": ["population"],
    "archive": HALL,
    "archivestar": [
        *HALL,
        *(
            f"archive_{side}_{of}"
            for side in ("predators", "prey")
            for of in ("lineages", "strengths")
        ),
    ],
    "coevo2": ["parameters", "m", "v", "fitness"],
    "maxsolvestar": [*HALL, "archive_predators_solved", "archive_prey_solved"],
    "sNES": ["mean", "sigma"],
    "xNES": ["mean", "sigma", "shape"],
}
"""Names of the arrays in checkpoints that exist."""


def made(name):
    entry = DECLARED[name]
    known = {field.name for field in fields(entry.config)}
    own = {key: value for key, value in SMALL.items() if key in known} | PLAIN.get(name, {})
    size = 2 * NUMBERS if entry.competitive else NUMBERS
    initial = lambda index: np.random.default_rng(index).normal(size=size)  # noqa: E731
    return entry.make(entry.config(**own), initial, 3)


def win(one, other, pairs, seed=None):
    """Meetings in which the first of a pair wins the more, the larger its numbers are."""
    return 1 / (1 + np.exp(-(one[pairs[0]] - other[pairs[1]]).sum(axis=1)))


def step(algorithm, meet=win):
    if hasattr(algorithm, "advance"):
        algorithm.advance(meet)
    else:
        candidates, _ = algorithm.ask()
        told = [-(np.asarray(candidates) ** 2).sum(axis=1)]
        if getattr(algorithm, "behaves", False):
            told.append(np.asarray(candidates)[:, None, :2].repeat(2, axis=1))
        algorithm.tell(*told)


def equal(one, other):
    if isinstance(one, np.ndarray):
        return one.dtype == other.dtype and np.array_equal(one, other, equal_nan=True)
    if isinstance(one, list | tuple):
        return len(one) == len(other) and all(map(equal, one, other))
    if hasattr(one, "__dict__"):
        return vars(one).keys() == vars(other).keys() and all(
            equal(value, vars(other)[name]) for name, value in vars(one).items()
        )
    return type(one) is type(other) and (one == other or one != one)


@pytest.mark.parametrize("name", DECLARED)
def test_what_changes_in_a_generation_is_in_the_checkpoint(name):
    one, two = made(name), made(name)
    for _ in range(7):
        step(one)
    two.restore({key: value.copy() for key, value in one.state().items()})
    forgotten = [key for key, value in vars(two).items() if not equal(vars(one)[key], value)]
    assert not forgotten, f"{name}: the next generation depends on {forgotten}; add to `evolves`"
    for _ in range(3):
        step(one)
        step(two)
    one, two = (sorted(each.state().items()) for each in (one, two))
    assert equal(one, two)


@pytest.mark.parametrize("name", [name for name in DECLARED if hasattr(made(name), "advance")])
def test_a_generation_that_breaks_off_leaves_no_trace(name):
    one, two = made(name), made(name)
    for _ in range(6):
        step(one)
        step(two)
    before, met = {key: value.copy() for key, value in one.state().items()}, 0
    last = None

    def meet(*meeting):
        nonlocal met
        if met == last:
            raise InterruptedError
        met += 1
        return win(*meeting)

    step(two, meet)
    assert met > 0
    for last in range(met):  # noqa: B007 (`meet` reads it)
        met = 0
        with pytest.raises(InterruptedError):
            step(one, meet)
        after = one.state()
        assert all(np.array_equal(before[key], after[key], equal_nan=True) for key in before)


@pytest.mark.parametrize("name", SAVED)
def test_checkpoints_keep_the_names_of_their_arrays(name):
    assert set(made(name).state()) == {"generation", *SAVED[name]}
