"""coevo against a small implementation in plain Python of docs/specification.md, "Algorithms"."""

import math

import numpy as np
import pytest

from botschool.evolution.algorithms.coevo import Coevo, CoevoConfig
from plain_algorithms import SIZE, Individual, average, climb, initial

SETTINGS = {"popsize": 7, "selsize": 3, "samplesize": 4, "noiseStdDev": 0.1, "stepsize": 0.03}


def reward(first, second, seed, number):
    """Some game of two robots in which it depends on the partner, and on chance, what is good."""
    luck = np.random.default_rng([seed % 2**32, number]).normal()
    near = sum(abs(first[k] - second[k - 1] - 0.1 * luck) for k in range(SIZE))
    return round(1 / (1 + near), 3)


def play(first, second, pairs, seed):
    """Meetings: each is an episode with the number of the second robot."""
    return np.array([reward(first[i], second[j], seed, j) for i, j in pairs.T.tolist()])


def game(**options):
    algorithm = Coevo(CoevoConfig(**SETTINGS | options), initial, seed=9)
    algorithm.advance(play)
    return algorithm


class Plain:
    """The same algorithm, individual by individual and number by number."""

    def __init__(self, config, seed):
        self.c, self.seed, self.generation = config, seed, 0
        zeros = [0.0] * SIZE
        self.all = [Individual(initial(i)[:SIZE], zeros, zeros) for i in range(config.popsize)]

    def met(self, x, seed, partners=None):
        """The rewards of a first robot with those partners, or with everyone."""
        partners = self.all if partners is None else [self.all[j] for j in partners]
        return [reward(x, one.x, seed, j) for j, one in enumerate(partners)]

    def advance(self):
        numbers = np.random.Generator(np.random.Philox(key=[self.seed, self.generation]))
        seeds = numbers.integers(2**62, size=21).tolist()
        table = [self.met(one.x, seeds[0]) for one in self.all]
        rivals = self.choose(table, int(numbers.integers(self.c.popsize)))
        chosen = numbers.permutation(self.c.popsize)[: self.c.selsize].tolist()
        copies = [Individual(self.all[i].x, self.all[i].m, self.all[i].v) for i in chosen]
        for seed in seeds[1:]:
            e = numbers.standard_normal((self.c.selsize, self.c.samplesize, SIZE))
            for one, directions in zip(copies, e.tolist(), strict=True):
                climb(
                    self.c, one, directions,
                    lambda number, x, seed=seed: average(self.met(x, seed, rivals)),
                )  # fmt: skip
        after = [self.met(one.x, seeds[0]) for one in copies]
        progress = average([row[j] for row in after for j in rivals])
        progress -= average([table[i][j] for i in chosen for j in rivals])
        ranked = [(-average(row), 0, one) for row, one in zip(after, copies, strict=True)]
        ranked += [(-average(row), 1, one) for row, one in zip(table, self.all, strict=True)]
        best = [one for *_, one in sorted(ranked, key=lambda entry: entry[:2])][: self.c.popsize]
        new = [one for one in copies if one in best]
        self.all = [one if one in best else new.pop(0) for one in self.all]
        self.generation += 1
        return progress

    def choose(self, table, first):
        columns = list(zip(*table, strict=True))
        chosen = [first]
        while len(chosen) < self.c.selsize:
            others = [j for j in range(self.c.popsize) if j not in chosen]
            gaps = [
                math.fsum(
                    abs(a - b) for k in chosen for a, b in zip(columns[j], columns[k], strict=True)
                )
                for j in others
            ]
            chosen.append(others[gaps.index(max(gaps))])
        return chosen


@pytest.mark.parametrize("wdecay", [0, 1, 2])
def test_generations_agree_with_plain_python(wdecay):
    algorithm = game(wdecay=wdecay)
    plain = Plain(CoevoConfig(**SETTINGS, wdecay=wdecay), 9)
    for _ in range(4):
        before = algorithm.parameters.copy()
        algorithm.advance(play)
        assert algorithm.progress == pytest.approx(plain.advance())
        for name, part in (("parameters", "x"), ("m", "m"), ("v", "v")):
            expected = [getattr(one, part) for one in plain.all]
            np.testing.assert_allclose(getattr(algorithm, name), expected, rtol=1e-9, atol=1e-12)
        changed = (algorithm.parameters != before).any(axis=1).sum()
        assert 1 <= changed <= 3
    assert algorithm.generation == 4
