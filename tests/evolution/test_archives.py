"""archive, archivestar and maxsolvestar against plain Python of docs/specification.md."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from botschool.evolution.algorithm import ALGORITHMS
from botschool.evolution.algorithms.halloffame import SAVED
from botschool.evolution.algorithms.maxsolvestar import dominated
from plain_algorithms import SIZE, Individual, average, climb, initial, meeting, play

SETTINGS = {"samplesize": 5, "noiseStdDev": 0.1, "stepsize": 0.03, "ncompetitors": 5}
ARCHIVE = {"addtoarchiveevery": 2}
VARIANTS = {
    "archive": ("archive", ARCHIVE),
    "archive, decay": ("archive", ARCHIVE | {"wdecay": 1}),
    "archivestar": ("archivestar", ARCHIVE | {"popsize": 3}),
    "archivestar, one lineage": ("archivestar", ARCHIVE | {"popsize": 1}),
    "archivestar, uniform": ("archivestar", ARCHIVE | {"popsize": 3, "seldifferentiated": 0}),
    "archivestar, strongest": (
        "archivestar",
        ARCHIVE | {"popsize": 2, "seldifferentiated": 0, "preferential": 3},
    ),
    "maxsolvestar": ("maxsolvestar", {"nphases": 3, "archivelen": 8}),
    "maxsolvestar, decay": ("maxsolvestar", {"nphases": 2, "archivelen": 6, "wdecay": 2}),
}
GENERATIONS = 14


def game(name, **options):
    """An algorithm and its hyperparameters, with seed 9."""
    algo, own = VARIANTS[name]
    entry = ALGORITHMS[algo]
    config = entry.config(**SETTINGS | own | options)
    return entry.make(config, initial, 9), config


class Member:
    """Of an archive of the plain implementation, in single precision."""

    def __init__(self, x, lineage):
        self.x = [float(np.float32(value)) for value in x]
        self.lineage, self.strength = lineage, 0.5
        self.solved = {}  # phase -> fitness of those who met it


class Plain:
    """The same algorithms, meeting by meeting and number by number."""

    def __init__(self, algo, config, seed):
        self.algo, self.c, self.seed, self.generation = algo, config, seed, 0

        def network(side, index):
            return initial(index)[side * SIZE :][:SIZE]

        zeros = [0.0] * SIZE
        lineages, first = range(config.popsize), range(config.ncompetitors)
        self.centres = [[Individual(network(s, i), zeros, zeros) for i in lineages] for s in (0, 1)]
        self.archives = [
            [Member(network(s, config.popsize + i), i % config.popsize) for i in first]
            for s in (0, 1)
        ]
        count = max(SAVED, config.popsize)
        self.saved = [[network(s, i).tolist() for i in range(count)] for s in (0, 1)]
        self.average = [None, None]

    def advance(self, share):
        side = self.generation % 2
        numbers = np.random.Generator(np.random.Philox(key=[self.seed, self.generation]))
        shape = (self.c.popsize, self.c.samplesize)
        e = numbers.standard_normal((*shape, SIZE)).tolist()
        rivals = self.archives[1 - side]
        drawn = self.draw(numbers, rivals, (*shape, self.c.ncompetitors))
        met = {}
        ranked, everybody = [], []
        for lineage, one in enumerate(self.centres[side]):

            def fitness(number, x, lineage=lineage):
                own = []
                for place in drawn[lineage][number // 2]:
                    own.append(meeting(side, x, rivals[place].x))
                    met.setdefault(place, []).append(own[-1])
                return average(own)

            before = list(one.x)
            scores = climb(self.c, one, e[lineage], fitness)
            everybody += scores
            order = sorted(range(len(scores)), key=lambda i: -scores[i])
            ranked.append([(scores[i], self.sample(before, e[lineage], i)) for i in order])
        self.average[side] = average(everybody)
        self.champion = max((own[0] for own in ranked), key=lambda pair: pair[0])
        self.show(side, ranked)
        self.remember(rivals, met, min(int(share * getattr(self.c, "nphases", 1)), 99))
        self.enter(side, ranked, numbers)
        self.generation += 1

    def sample(self, x, directions, number):
        sign = self.c.noiseStdDev * (1 if number % 2 == 0 else -1)
        return [a + sign * b for a, b in zip(x, directions[number // 2], strict=True)]

    def draw(self, numbers, rivals, shape):
        if self.algo != "archivestar":
            return numbers.integers(len(rivals), size=shape).tolist()
        if not self.c.seldifferentiated:
            some = numbers.integers(len(rivals), size=(*shape, self.c.preferential)).tolist()
            return [
                [[max(group, key=lambda i: rivals[i].strength) for group in pair] for pair in own]
                for own in some
            ]
        members = [
            [i for i, member in enumerate(rivals) if member.lineage == slot % self.c.popsize]
            for slot in range(self.c.ncompetitors)
        ]
        some = numbers.integers([len(own) for own in members], size=shape).tolist()
        return [[[members[slot][i] for slot, i in enumerate(pair)] for pair in own] for own in some]

    def show(self, side, ranked):
        rows = [list(one.x) for one in self.centres[side]]
        for rank in range(len(ranked[0])):
            rows += [own[rank][1] for own in ranked]
        self.saved[side] = rows[: max(SAVED, self.c.popsize)]

    def remember(self, rivals, met, phase):
        for place, values in met.items():
            member = rivals[place]
            member.strength = 0.9 * member.strength + 0.1 * (1 - average(values))
            member.solved.setdefault(phase, []).extend(values)

    def enter(self, side, ranked, numbers):
        archive, turn = self.archives[side], self.generation // 2 + 1
        if self.algo == "maxsolvestar":
            if len(archive) >= self.c.archivelen:
                for place in numbers.permutation(len(archive))[:10].tolist():
                    if self.teaches_nothing(archive, place):
                        del archive[place]
                        break
            archive.append(Member(self.centres[side][0].x, 0))
        elif turn % self.c.addtoarchiveevery == 0:
            archive += [Member(own[0][1], lineage) for lineage, own in enumerate(ranked)]

    def teaches_nothing(self, archive, place):
        mine = {phase: average(values) for phase, values in archive[place].solved.items()}
        return bool(mine) and any(
            all(p in other.solved and average(other.solved[p]) <= mine[p] for p in mine)
            for i, other in enumerate(archive)
            if i != place
        )


@pytest.mark.parametrize("name", VARIANTS)
def test_generations_agree_with_plain_python(name):
    algorithm, config = game(name)
    plain = Plain(VARIANTS[name][0], config, 9)
    for generation in range(GENERATIONS):
        algorithm.share = share = generation / GENERATIONS
        algorithm.advance(play)
        plain.advance(share)
        side = generation % 2
        for attribute, part in (("centres", "x"), ("m", "m"), ("v", "v")):
            expected = [[getattr(one, part) for one in own] for own in plain.centres]
            found = getattr(algorithm, attribute)
            np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(algorithm.saved, plain.saved, rtol=1e-9, atol=1e-12)
        score, champion = plain.champion
        np.testing.assert_allclose(algorithm.champions[side], champion, rtol=1e-9)
        assert algorithm.fitness[side] == pytest.approx([score, plain.average[side]])
        for archive, expected in zip(algorithm.archives, plain.archives, strict=True):
            assert len(archive) == len(expected)
            assert all(row.dtype == np.float32 for row in archive)
            np.testing.assert_allclose(archive, [member.x for member in expected], rtol=1e-6)
        if VARIANTS[name][0] == "archivestar":
            for own, known, expected in zip(
                algorithm.lineages, algorithm.strengths, plain.archives, strict=True
            ):
                assert own == [member.lineage for member in expected]
                assert known == pytest.approx([member.strength for member in expected])
    last = [len(archive) for archive in algorithm.archives]
    if name.startswith("archive"):  # each of 7 turns of a side, every second one
        assert last == [config.ncompetitors + 3 * config.popsize] * 2
    else:  # some were dropped, at most one a turn
        assert max(last) < config.ncompetitors + GENERATIONS // 2


def test_archivestar_with_one_lineage_is_archive():
    one, _ = game("archive")
    other, _ = game("archivestar, one lineage")
    for _ in range(GENERATIONS):
        one.advance(play)
        other.advance(play)
    assert np.array_equal(one.centres, other.centres) and np.array_equal(one.saved, other.saved)
    assert np.array_equal(one.archives, other.archives)


def test_phases_are_equal_parts_of_the_evolution():
    algorithm, _ = game("maxsolvestar", nphases=4)
    shares = (0, 0.24, 0.25, 0.5, 0.74, 0.99, 1)
    found = []
    for algorithm.share in shares:
        found.append(algorithm.phase)
    assert found == [0, 0, 1, 2, 2, 3, 3]


@settings(max_examples=200, deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 6), st.integers(1, 3))
def test_domination_by_brute_force(seed, archived, phases):
    numbers = np.random.default_rng(seed)
    counts = numbers.integers(0, 3, size=(archived, phases)).astype(float)
    sums = counts * numbers.integers(0, 3, size=(archived, phases)) / 4
    for place in range(archived):
        known = [p for p in range(phases) if counts[place, p]]
        expected = bool(known) and any(
            all(
                counts[i, p] and sums[i, p] / counts[i, p] <= sums[place, p] / counts[place, p]
                for p in known
            )
            for i in range(archived)
            if i != place
        )
        assert dominated(sums, counts, place) == expected
