"""coevo2 against a small implementation in plain Python of docs/specification.md, "Algorithms"."""

import itertools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from botschool.config import Coevo2Config
from botschool.evolution.algorithms.coevo2 import Coevo2, differing
from botschool.evolution.algorithms.sides import means, ranking, seen_by
from plain_algorithms import SIZE, Individual, average, climb, initial, meeting, meetings, play

SETTINGS = {"popsize": 7, "selsize": 3, "samplesize": 4, "noiseStdDev": 0.1, "stepsize": 0.03}


def game(**options):
    algorithm = Coevo2(Coevo2Config(**SETTINGS | options), initial, seed=9)
    algorithm.advance(play)
    return algorithm


def differences(one, other):
    """Sum of the absolute differences of two rows."""
    return math.fsum(abs(a - b) for a, b in zip(one, other, strict=True))


class Plain:
    """The same algorithm, individual by individual and number by number."""

    def __init__(self, config, seed):
        self.c, self.seed, self.generation = config, seed, 0
        zeros = [0.0] * SIZE
        self.sides = [
            [
                Individual(initial(i)[side * SIZE :][:SIZE], zeros, zeros)
                for i in range(config.popsize)
            ]
            for side in (0, 1)
        ]
        self.sort()

    def against_all(self, side, one):
        return average([meeting(side, one.x, rival.x) for rival in self.sides[1 - side]])

    def sort(self):
        orders = [
            sorted(population, key=lambda one: -self.against_all(side, one))
            for side, population in enumerate(self.sides)
        ]
        self.sides = orders

    def advance(self):
        side = self.generation % 2
        ours, theirs = self.sides[side], self.sides[1 - side]
        numbers = np.random.Generator(np.random.Philox(key=[self.seed, self.generation]))
        rivals = self.choose(side, int(numbers.integers(self.c.popsize)))
        opponents = [theirs[i].x for i in rivals]

        def fitness(x):
            return average([meeting(side, x, opponent) for opponent in opponents])

        if self.c.evolving == "best":
            chosen = sorted(ours, key=lambda one: -fitness(one.x))[: self.c.selsize]
        else:
            drawn = numbers.permutation(self.c.popsize).tolist()
            chosen = [ours[i] for i in drawn[: self.c.selsize]]
        copies = [Individual(one.x, one.m, one.v) for one in chosen]
        for _ in range(20):
            e = numbers.standard_normal((self.c.selsize, self.c.samplesize, SIZE))
            for one, directions in zip(copies, e.tolist(), strict=True):
                climb(self.c, one, directions, lambda number, x: fitness(x))
        progress = average([fitness(one.x) for one in copies]) - average(
            [fitness(one.x) for one in chosen]
        )
        everyone = copies + ours
        everyone.sort(key=lambda one: -self.against_all(side, one))
        self.sides[side] = everyone[: self.c.popsize]
        self.sort()
        self.generation += 1
        return progress

    def choose(self, side, first):
        ours, theirs = self.sides[side], self.sides[1 - side]
        profiles = [[meeting(1 - side, one.x, other.x) for other in ours] for one in theirs]
        chosen = [first]
        while len(chosen) < self.c.selsize:
            others = [i for i in range(len(theirs)) if i not in chosen]
            gaps = [sum(differences(profiles[i], profiles[k]) for k in chosen) for i in others]
            chosen.append(others[gaps.index(max(gaps))])
        return chosen


@pytest.mark.parametrize("wdecay", [0, 1, 2])
@pytest.mark.parametrize("evolving", ["random", "best"])
def test_generations_agree_with_plain_python(evolving, wdecay):
    algorithm = game(evolving=evolving, wdecay=wdecay)
    plain = Plain(Coevo2Config(**SETTINGS, evolving=evolving, wdecay=wdecay), 9)
    for generation in range(3):
        before = algorithm.parameters.copy()
        algorithm.advance(play)
        assert algorithm.progress == pytest.approx(plain.advance(), abs=1e-12)
        for name, part in (("parameters", "x"), ("m", "m"), ("v", "v")):
            expected = [[getattr(one, part) for one in side] for side in plain.sides]
            found = getattr(algorithm, name)
            np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12)
        assert np.array_equal(algorithm.fitness, meetings(*algorithm.parameters))
        same = [
            np.array_equal(*(np.sort(a[side], axis=0) for a in (before, algorithm.parameters)))
            for side in (0, 1)
        ]
        assert same[1 - generation % 2] and not same[generation % 2]


def test_before_the_first_meeting_there_is_no_fitness():
    algorithm = Coevo2(Coevo2Config(**SETTINGS), initial, seed=9)
    assert not algorithm.met
    for i in range(7):
        assert np.array_equal(np.concatenate(algorithm.parameters[:, i]), initial(i))
    algorithm.advance(play)
    assert algorithm.met and algorithm.generation == 0
    assert not algorithm.m.any() and not algorithm.v.any()


def test_both_populations_are_sorted():
    algorithm = game()
    for _ in range(6):
        for side in (0, 1):
            assert (np.diff(means(seen_by(side, algorithm.fitness))) <= 0).all()
        algorithm.advance(play)


def test_what_happens_in_a_sub_generation_is_one_call():
    asked = []

    def spying(predators, prey, pairs):
        assert len(set(zip(*pairs.tolist(), strict=True))) == len(predators) * len(prey)
        asked.append((len(predators), len(prey)))
        return play(predators, prey, pairs)

    algorithm = game()
    algorithm.advance(spying)
    assert asked == [(3 * 2 * 4, 3)] * 20 + [(3, 7)]
    asked.clear()
    algorithm.advance(spying)
    assert asked == [(3, 3 * 2 * 4)] * 20 + [(7, 3)]


def test_momentum_is_kept_with_the_individual():
    algorithm = game()
    for _ in range(8):
        kept = {
            (side, algorithm.parameters[side, i].tobytes()): (
                algorithm.m[side, i].copy(),
                algorithm.v[side, i].copy(),
            )
            for side, i in itertools.product((0, 1), range(7))
        }
        algorithm.advance(play)
        new = 0
        for side, i in itertools.product((0, 1), range(7)):
            before = kept.get((side, algorithm.parameters[side, i].tobytes()))
            if before is None:
                new += 1
                assert algorithm.v[side, i].any()
                continue
            assert np.array_equal(before[0], algorithm.m[side, i])
            assert np.array_equal(before[1], algorithm.v[side, i])
        assert new <= 3


@given(
    st.integers(0, 2**32), st.integers(1, 9), st.integers(1, 5), st.integers(1, 9), st.booleans()
)
def test_competitors_by_brute_force(seed, rows, columns, count, coarse):
    numbers = np.random.default_rng(seed)
    fitness = numbers.random((rows, columns)).round(1 if coarse else 15)
    count, first = min(count, rows), int(numbers.integers(rows))
    chosen = differing(fitness, count, first).tolist()
    assert chosen[0] == first and len(set(chosen)) == len(chosen) == count
    for k in range(1, count):

        def gap(row, k=k):
            return sum(differences(fitness[row], fitness[i]) for i in chosen[:k])

        farthest = max(gap(row) for row in range(rows) if row not in chosen[:k])
        assert gap(chosen[k]) == pytest.approx(farthest, abs=1e-12)


@settings(max_examples=25, deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 6), st.integers(1, 6), st.integers(1, 3))
def test_who_is_dropped_is_the_worst(seed, popsize, selsize, generations):
    """None of those who have to go is better than one who stays."""
    selsize = min(selsize, popsize)
    config = Coevo2Config(popsize=popsize, selsize=selsize, samplesize=2, noiseStdDev=0.5)
    algorithm = Coevo2(config, lambda index: initial([seed, index]), seed)
    algorithm.advance(play)
    for _ in range(generations):
        side, played = algorithm.side, []

        def spying(predators, prey, pairs, played=played):
            played.append((predators.copy(), prey.copy()))
            return play(predators, prey, pairs)

        before, rivals = algorithm.parameters[side].copy(), algorithm.parameters[1 - side].copy()
        algorithm.advance(spying)
        candidates = np.concatenate([played[-1][side], before])

        def fitness(individuals, side=side, rivals=rivals):
            ours, theirs = (individuals, rivals) if side == 0 else (rivals, individuals)
            met = meetings(ours, theirs)
            return means(seen_by(side, met))

        best = np.sort(fitness(candidates))[::-1][:popsize]
        assert np.array_equal(fitness(algorithm.parameters[side]), best)
        known = {row.tobytes() for row in candidates}
        assert {row.tobytes() for row in algorithm.parameters[side]} <= known


def test_of_equals_the_newcomers_stay():
    """Else populations in which nobody ever wins could not change."""
    config = Coevo2Config(**SETTINGS)
    algorithm = Coevo2(config, initial, seed=9)

    def nobody(predators, prey, pairs):
        return np.zeros(pairs.shape[1])

    algorithm.advance(nobody)
    before = algorithm.parameters.copy()
    algorithm.advance(nobody)
    assert np.array_equal(algorithm.parameters[0, 3:], before[0, :4])
    assert not (algorithm.parameters[0, :3] == before[0, :3]).any()


def test_the_best_evolve_or_anyone():
    """Who evolves: the rows of the population whose momentum the newcomers have taken over."""
    found = {}
    for evolving in ("best", "random"):
        algorithm = game(evolving=evolving)
        asked = []

        def spying(predators, prey, pairs, asked=asked):
            asked.append((predators.copy(), prey.copy()))
            return play(predators, prey, pairs)

        before, fitness = algorithm.parameters[0].copy(), algorithm.fitness.copy()
        rivals = {row.tobytes(): i for i, row in enumerate(algorithm.parameters[1])}
        algorithm.advance(spying)
        offspring, competitors = asked[0]
        centres = offspring.reshape(3, -1, SIZE).mean(axis=1)  # + and - cancel out
        chosen = [int(np.abs(before - centre).sum(axis=1).argmin()) for centre in centres]
        met = fitness[:, [rivals[row.tobytes()] for row in competitors]]
        found[evolving] = chosen, ranking(met)[:3].tolist()
    assert found["best"][0] == found["best"][1]
    chosen, best = found["random"]
    assert len(set(chosen)) == 3 and set(chosen) != set(best)


def test_ranking_is_stable():
    fitness = np.array([[0.5, 0.5], [1, 0], [0.25, 1], [0, 1]])
    assert ranking(fitness).tolist() == [2, 0, 1, 3]
