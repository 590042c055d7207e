"""coevo against a small implementation in plain Python of docs/specification.md, "Algorithms"; its
runs, their files, and that workers, stops and the cluster's shortcut do not show in them."""

import math

import numpy as np
import pytest

from botschool import config, problems
from botschool.evolution.algorithms.coevo import Coevo, CoevoConfig
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.run import evolve
from botschool.problems import Episodes
from plain_algorithms import SIZE, Individual, average, climb, initial
from running import contents, same

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


def test_a_generation_that_breaks_off_leaves_no_trace():
    algorithm = game()
    algorithm.advance(play)
    before = {name: value.copy() for name, value in algorithm.state().items()}
    for calls in range(22):
        done = 0

        def breaking(*meetings, calls=calls):
            nonlocal done
            if done == calls:
                raise InterruptedError
            done += 1
            return play(*meetings)

        with pytest.raises(InterruptedError):
            algorithm.advance(breaking)
        after = algorithm.state()
        assert all(np.array_equal(before[name], after[name]) for name in before)


def test_a_state_that_is_restored_goes_on_alike():
    one, two = game(), Coevo(CoevoConfig(**SETTINGS), lambda index: initial(index + 1), 9)
    one.advance(play)
    two.restore({name: value.copy() for name, value in one.state().items()})
    for _ in range(3):
        one.advance(play)
        two.advance(play)
        assert one.summary() == two.summary()
    assert all(np.array_equal(one.state()[name], two.state()[name]) for name in one.state())


def test_the_best_pair_is_the_best_first_and_the_best_second_robot():
    algorithm = game()
    pair, fitness = algorithm.best()
    rows, columns = algorithm.fitness.mean(axis=1), algorithm.fitness.mean(axis=0)
    assert pair[:SIZE].tolist() == algorithm.parameters[rows.argmax()].tolist()
    assert pair[SIZE:].tolist() == algorithm.parameters[columns.argmax()].tolist()
    assert fitness == pytest.approx(rows.max())


# runs

POPSIZE = 5
POLICY = {"nrobots": 2, "heterogeneous": 1, "maxsteps": 120, "nhiddens": 4, "bias": 1}
POLICY |= {"architecture": 3, "winit": 2, "wrange": 2, "episodes": 2}
ALGORITHM = {"ngenerations": 5, "popsize": POPSIZE, "selsize": 2, "samplesize": 2, "saveeach": 2}
ALGORITHM |= {"noiseStdDev": 0.3, "stepsize": 0.3}


def write(folder, **algorithm):
    """Writes FOLDER/own.ini, a very small experiment. Gives its path."""
    lines = ["[EXP]", "environment = ErStaybehind", "algo = coevo", "[POLICY]"]
    lines += [f"{key} = {value}" for key, value in POLICY.items()]
    lines += ["[ALGO]", *(f"{key} = {value}" for key, value in (ALGORITHM | algorithm).items())]
    (folder / "own.ini").write_text("\n".join(lines) + "\n")
    return folder / "own.ini"


def run(folder, workers=1, resume=False, **limits):
    """A run with seed 3 of the experiment in the folder above; whether it was finished."""
    folder.mkdir(exist_ok=True)
    own = config.load(write(folder.parent))
    return evolve(Coevolution(own, 3, workers), folder, resume=resume, **limits)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The folder of an undisturbed run."""
    folder = tmp_path_factory.mktemp("whole") / "run"
    assert run(folder)
    return folder


def test_files_have_the_names_and_shapes_of_the_format(whole):
    expected = {"S3.fit", "bestgS3.npy", "statS3.npy", "checkpointS3.npz", "tensorboardS3"}
    for generation in (0, 2, 4, 5):
        expected |= {f"S3G{generation}.npy", f"S3FitG{generation}.npy"}
        size = Coevolution(config.load(whole.parent / "own.ini"), 3).policy.nparameters
        assert np.load(whole / f"S3G{generation}.npy").shape == (POPSIZE, size)
        assert np.load(whole / f"S3FitG{generation}.npy").shape == (POPSIZE, POPSIZE)
    assert {path.name for path in whole.iterdir()} == expected
    stat = np.load(whole / "statS3.npy").reshape(-1, 6)
    assert len(stat) == 5
    fitness = np.load(whole / "S3FitG5.npy")
    assert stat[-1, 3:5] == pytest.approx([fitness.mean(axis=1).max(), fitness.mean()])
    assert len(np.load(whole / "bestgS3.npy")) == 2 * size


@pytest.mark.parametrize("generation", [0, 4, 5])
def test_entries_of_the_fitness_matrix_can_be_played_again(generation, whole):
    """Under the conditions of their generation: its seed, and two episodes for each column."""
    own = config.load(whole.parent / "own.ini")
    problem = problems.of(own)
    policy = problem.policy(own.policy)
    population = np.load(whole / f"S3G{generation}.npy")
    fitness = np.load(whole / f"S3FitG{generation}.npy")
    numbers = np.random.Generator(np.random.Philox(key=[3, generation]))
    seed = numbers.integers(2**62, size=21)[0]
    for i in range(POPSIZE):
        for j in range(POPSIZE):
            pair = np.array([[i, i], [j, j]], dtype=np.int32)
            episodes = np.array([2 * j, 2 * j + 1], np.uint32)
            chosen = Episodes(pair, np.array([seed, seed], np.uint64), episodes)
            outcome = problem.evaluate(policy, population, None, chosen, POLICY["maxsteps"])
            assert outcome.fitness.mean() == fitness[i, j]


def test_workers_do_not_show(whole, tmp_path):
    for workers in (2, 5):
        assert run(tmp_path / str(workers), workers)
        assert same(whole, tmp_path / str(workers))


def test_stops_do_not_show(whole, tmp_path):
    for limits in ({"steps": 1}, {"generations": 1}, {"generations": 4}, {}):
        assert run(tmp_path / "run", resume=True, **limits)
    for extra in set(contents(tmp_path / "run")) - set(contents(whole)):
        assert extra in ("S3G1.npy", "S3FitG1.npy")
        (tmp_path / "run" / extra).unlink()
    assert same(whole, tmp_path / "run")


def test_a_checkpoint_of_other_meetings_is_refused(tmp_path, refused):
    assert run(tmp_path / "run", generations=1)
    path = tmp_path / "run" / "checkpointS3.npz"
    arrays = dict(np.load(path))
    arrays["algorithm.fitness"] = arrays["algorithm.fitness"] + 0.5
    np.savez(path, **arrays)
    refused(
        *("es", "-f", tmp_path / "own.ini", "-s", 3, "-o", tmp_path / "run", "--resume"),
        says=["checkpointS3.npz", "evaluates robots differently", "--force"],
    )


def test_the_line_and_the_end_name_one_population(tmp_path, command):
    write(tmp_path)
    code, out, errors = command("es", "-f", tmp_path / "own.ini", "-s", 3, "-o", tmp_path / "run")
    assert (code, errors) == (0, "")
    lines = out.splitlines()
    assert len(lines) == 6 and all("  population evolved  " in line for line in lines[:-1])
    assert "population 0." in lines[-1] and "(follower, then leader)" in lines[-1]


def test_populations_are_shown_and_measured(whole, command, tmp_path):
    """As in coevo2: P-, p-, m-, M- and c- and the tournament."""
    own = whole.parent / "own.ini"
    base = ("es", "-f", own, "-s", 3, "-o", whole, "-p", "-g")
    code, out, _ = command(*base, "p-4-3")
    assert code == 0
    assert (
        "one population: its predators are its individuals as follower, its prey those as leader"
        in out
    )
    means = [line for line in out.splitlines() if line.startswith("mean fitness of the ")]
    assert len(means) == 2 and means[0].split(":")[1] == means[1].split(":")[1]
    page = tmp_path / "replay.html"
    code, out, errors = command(*base, "P-4-1", "--replay", page, "--episodes", 1)
    assert (code, errors) == (0, "") and page.stat().st_size > 1000
    for text in ("m-4-2", "M-4-2", f"c-{whole / 'S3G2.npy'}-{whole / 'S3G4.npy'}"):
        assert command(*base, text)[0] == 0
    code, out, _ = command("tournament", whole, "-f", own, "--best", 3)
    assert code == 0 and "historical progress" in out


def test_what_cannot_be_is_refused(tmp_path, refused):
    write(tmp_path, popsize=4, selsize=5)
    refused("es", "-f", tmp_path / "own.ini", says=["selsize = 5 is more than popsize = 4"])
