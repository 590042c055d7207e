"""coevo2 against a small implementation in plain Python of docs/specification.md, "Algorithms"."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from botschool.config import Coevo2Config
from botschool.evolution.algorithms.coevo2 import Coevo2, differing
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
