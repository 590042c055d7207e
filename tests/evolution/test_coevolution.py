"""Runs of two sides, and of one population that meets itself: their files, and that workers, stops
and kills do not show in them."""

import random
import shutil
import signal
import sys
from types import SimpleNamespace

import numpy as np
import pytest

from botschool import config, problems
from botschool.analysis.tournament import Contest
from botschool.evolution.algorithms.halloffame import SAVED
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.record import STAT
from botschool.evolution.run import evolve
from botschool.problems import Episodes
from running import contents, finish, same, start

POLICY = {"nrobots": 2, "heterogeneous": 1, "maxsteps": 250, "nhiddens": 4, "bias": 1}
POLICY |= {"architecture": 3, "winit": 2, "wrange": 2}  # bold robots, who meet
POPULATIONS = {"ngenerations": 5, "popsize": 6, "selsize": 2, "samplesize": 2, "saveeach": 2}
POPULATIONS |= {"noiseStdDev": 0.3, "stepsize": 0.3}
CENTRES = {"maxmsteps": 1000, "ngenerations": 9, "samplesize": 5, "ncompetitors": 3}
CENTRES |= {"noiseStdDev": 0.3, "stepsize": 0.1, "wdecay": 1, "saveeach": 4}
ALGORITHMS = {
    "coevo2": POPULATIONS,
    "coevo": POPULATIONS,
    "archive": CENTRES | {"addtoarchiveevery": 2},
    "archivestar": CENTRES | {"addtoarchiveevery": 2, "popsize": 2},
    "maxsolvestar": CENTRES | {"nphases": 3, "archivelen": 5},
}
posix = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")


def write(folder, algo="coevo2", environment=None, policy=None, **options):
    """Writes FOLDER/own.ini, a very small experiment. Gives its path."""
    policy = POLICY | ({"episodes": 2} if algo == "coevo" else {}) | (policy or {})
    environment = environment or ("ErStaybehind" if algo == "coevo" else "ErPredprey")
    lines = ["[EXP]", f"environment = {environment}", f"algo = {algo}", "[POLICY]"]
    lines += [f"{key} = {value}" for key, value in policy.items()]
    lines += ["[ALGO]", *(f"{k} = {v}" for k, v in (ALGORITHMS[algo] | options).items())]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "own.ini").write_text("\n".join(lines) + "\n")
    return folder / "own.ini"


def experiment(folder, *arguments, **options):
    """The same, read."""
    return config.load(write(folder, *arguments, **options))


def run(own, folder, workers=1, resume=False, **limits):
    """A run with seed 3 in the folder; whether it was finished."""
    folder.mkdir(parents=True, exist_ok=True)
    return evolve(Coevolution(own, 3, workers), folder, resume=resume, **limits)


def arguments(folder, *more):
    return ("es", "-f", folder / "own.ini", "-s", 3, "-o", folder / "run", *more)


def same_but_for_stops(whole, parts):
    """Whether both runs left the same, but that one was stopped and kept its populations then."""
    for path in parts.glob("S3*G*.npy"):
        if not (whole / path.name).exists():
            path.unlink()
    return same(whole, parts)


@pytest.fixture(scope="module", params=ALGORITHMS)
def whole(request, tmp_path_factory):
    """An undisturbed run: its algorithm, experiment, file and folder, the generations that it has
    saved, and how many robots of a side meet."""
    folder = tmp_path_factory.mktemp(request.param)
    own = experiment(folder, request.param)
    assert run(own, folder / "run")
    last, every = own.algo.ngenerations, own.algo.saveeach
    return SimpleNamespace(
        algo=request.param, own=own, file=folder / "own.ini", folder=folder / "run",
        saved=[g for g in range(last + 1) if g % every == 0 or g == last],
        count=own.algo.popsize if "coevo" in request.param else SAVED,
    )  # fmt: skip


@pytest.fixture
def own(tmp_path):
    return experiment(tmp_path)


# files


def test_files_have_the_names_and_shapes_of_the_format(whole):
    expected = {"S3.fit", "bestgS3.npy", "statS3.npy", "checkpointS3.npz", "tensorboardS3"}
    expected |= {f"S3{fit}G{g}.npy" for g in whole.saved for fit in ("", "Fit")}
    assert {path.name for path in whole.folder.iterdir()} == expected
    size, count = Coevolution(whole.own, 3).policy.nparameters, whole.count
    rows = count if whole.algo == "coevo" else 2 * count
    for generation in whole.saved:
        networks = np.load(whole.folder / f"S3G{generation}.npy")
        fitness = np.load(whole.folder / f"S3FitG{generation}.npy")
        assert (networks.shape, networks.dtype) == ((rows, size), np.float64)
        assert (fitness.shape, fitness.dtype) == ((rows, count), np.float64)
        if whole.algo != "coevo":  # a prey's fitness is 1 - the predator's
            assert np.array_equal(fitness[count:], 1 - fitness[:count].T)
        if whole.algo == "coevo2":  # and the best are first
            for side in np.split(fitness, 2):
                assert (np.diff(side.mean(axis=1)) <= 1e-12).all()
    assert len(np.load(whole.folder / "statS3.npy")) == 6 * whole.own.algo.ngenerations
    fit = (whole.folder / "S3.fit").read_text().split()
    assert fit[0::2] == ["seed", "gen", "steps", "bestfit", "bestgfit"]
    assert fit[1:4:2] == ["3", str(whole.own.algo.ngenerations)]


def test_entries_of_the_fitness_matrix_can_be_played_again(whole):
    """Those of coevo under the conditions of their generation: its seed, and two episodes for each
    column."""
    problem = problems.of(whole.own)
    policy, different = problem.policy(whole.own.policy), set()
    for generation in whole.saved:
        networks = np.load(whole.folder / f"S3G{generation}.npy")
        fitness = np.load(whole.folder / f"S3FitG{generation}.npy")
        different |= set(fitness.ravel().tolist())
        numbers = np.random.Generator(np.random.Philox(key=[3, generation]))
        drawn = numbers.integers(2**62, size=21)[0]
        for i in range(0, whole.count, 1 + whole.count // 9):
            for k in range(whole.count):
                if whole.algo == "coevo":
                    meeting = [[i, i], [k, k]], [drawn, drawn], [2 * k, 2 * k + 1]
                else:
                    meeting = [[i], [whole.count + k]], [3], [0]
                types = (np.int32, np.uint64, np.uint32)
                episodes = Episodes(*map(np.array, meeting, types))
                maxsteps = whole.own.policy.maxsteps
                outcome = problem.evaluate(policy, networks, None, episodes, maxsteps)
                assert outcome.fitness.mean() == fitness[i, k]
    assert len(different) > 5


@pytest.mark.slow
def test_event_files_hold_local_progress_and_both_sides(tmp_path, own):
    from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

    assert run(own, tmp_path / "run", generations=2)
    assert run(own, tmp_path / "run", resume=True)
    (file,) = (tmp_path / "run" / "tensorboardS3").iterdir()
    events = EventAccumulator(str(file)).Reload()
    more = {"local progress", "predators", "prey", "generation"}
    assert set(events.Tags()["scalars"]) == {*STAT[1:], *more}
    stat = np.load(tmp_path / "run" / "statS3.npy").reshape(-1, 6).astype(np.float32)
    points = events.Scalars("predators")
    assert [point.step for point in points] == stat[:, 0].tolist()
    assert [np.float32(point.value) for point in points] == stat[:, 4].tolist()


# workers, stops and kills


@pytest.mark.slow
@pytest.mark.parametrize("workers", [2, 5])
def test_workers_do_not_show(workers, whole, tmp_path):
    assert run(whole.own, tmp_path / "run", workers)
    assert same(whole.folder, tmp_path / "run")


@pytest.mark.slow
def test_early_ends_do_not_show(whole, tmp_path):
    folder = tmp_path / "run"
    for limits in ({"generations": 1}, {"steps": 1}, {"generations": 1}, {"generations": 3}):
        assert run(whole.own, folder, resume=True, **limits)
    assert (folder / "S3G1.npy").exists() and (folder / "S3G3.npy").exists()
    assert len(np.load(folder / "statS3.npy")) == 3 * 6
    assert run(whole.own, folder, resume=True)
    assert same_but_for_stops(whole.folder, folder)


def test_steps_end_a_run(tmp_path):
    own = experiment(tmp_path, "archive", maxmsteps=0.03, ngenerations=0)
    assert run(own, tmp_path / "run")
    steps = np.load(tmp_path / "run" / "statS3.npy").reshape(-1, 6)[:, 0]
    assert len(steps) > 2 and steps[-2] < 30_000 <= steps[-1]


def test_going_on_with_a_longer_run_does_not_show(own, tmp_path):
    assert run(own, tmp_path / "whole")
    for generations, saveeach in ((3, 1), (5, 2)):
        own = experiment(tmp_path, ngenerations=generations, saveeach=saveeach)
        assert run(own, tmp_path / "run", resume=True)
    parts, expected = contents(tmp_path / "run"), contents(tmp_path / "whole")
    assert {name for name in parts if parts[name] != expected.get(name)} == {
        *("S3G1.npy", "S3G3.npy", "S3FitG1.npy", "S3FitG3.npy")
    }


@pytest.mark.slow
def test_a_request_to_stop_at_any_moment_does_not_show(whole, tmp_path):
    """In the first meeting, in sub-generations, between generations; heard before the next call."""
    for moment in (0, 1, 9, 22, 23, 40) if "coevo" in whole.algo else (0, 1, 6):
        asked = 0

        def stopping(moment=moment):
            nonlocal asked
            asked += 1
            return asked > moment

        folder = tmp_path / str(moment)
        folder.mkdir()
        assert not evolve(Coevolution(whole.own, 3, stopping=stopping), folder)
        assert asked == moment + 1
        assert evolve(Coevolution(whole.own, 3), folder, resume=True)
        assert same_but_for_stops(whole.folder, folder)


def told(process, generations):
    """Wait until a run has told of so many generations."""
    while generations:
        line = process.stdout.readline()
        assert line
        generations -= line.startswith("seed 3  generation")


@pytest.mark.slow
@posix
def test_ten_kills_do_not_show(tmp_path):
    """By kill -9, at random moments of the real command."""
    chance = random.Random(1)
    own = experiment(tmp_path, ngenerations=100_000, saveeach=3)
    for _ in range(10):
        process = start(*arguments(tmp_path, "--resume"))
        told(process, chance.randint(0, 4))
        for _ in range(chance.randint(0, 2000)):
            process.poll()
        process.kill()
        assert finish(process)[0] == -signal.SIGKILL
    done = len(np.load(tmp_path / "run" / "statS3.npy")) // 6
    assert done >= 3
    code, _, errors = finish(start(*arguments(tmp_path, "--resume", "--generations", done + 2)))
    assert (code, errors) == (0, "")
    assert run(own, tmp_path / "undisturbed", generations=done + 2)
    assert same(tmp_path / "undisturbed", tmp_path / "run")


# what comes after


@pytest.mark.slow
def test_populations_take_part_in_tournaments(whole, command, tmp_path):
    picture = tmp_path / "tournament.png"
    code, out, errors = command("tournament", whole.folder, "-f", whole.file, "-o", picture)
    assert (code, errors) == (0, "")
    assert "historical progress" in out and "global progress" in out
    assert picture.stat().st_size > 1000
    if whole.algo != "coevo":
        generation = whole.saved[-2]
        networks = np.load(whole.folder / f"S3G{generation}.npy")
        expected = Contest(whole.own, 3).meet(*np.split(networks, 2)).mean()
        rows = map(str.split, out.splitlines())
        row = next(row for row in rows if row[:1] == [str(generation)])  # of the predators' table
        assert row[1 + whole.saved.index(generation)] == f"{expected:.2f}"


@pytest.mark.slow
def test_populations_are_shown_and_measured(whole, command, tmp_path):
    g, step, page = whole.saved[-2], whole.own.algo.saveeach, tmp_path / "chase.html"
    common = ("es", "-f", whole.file, "-s", 3, "-o", whole.folder, "-p", "-g")
    files = "-".join(str(whole.folder / f"S3G{generation}.npy") for generation in (0, g))
    for text in (f"p-{g}-3", f"m-{g}-{step}", f"M-{g}-{step}", f"c-{files}"):
        code, out, errors = command(*common, text)
        assert (code, errors) == (0, "") and "0." in out
        if text[0] == "p" and whole.algo == "coevo":
            assert "one population: its predators are its individuals as follower, its prey" in out
            means = [line for line in out.splitlines() if line.startswith("mean fitness of the ")]
            assert len(means) == 2 and means[0].split(":")[1] == means[1].split(":")[1]
    assert command(*common, f"P-{g}-2", "--replay", page, "--episodes", 1)[0] == 0
    assert page.stat().st_size > 10_000
    assert command(*common, whole.folder / "bestgS3.npy", "--render", "none")[0] == 0


def test_plotstat_draws_it(whole, command, tmp_path):
    picture = tmp_path / "curve.png"
    assert command("plotstat", whole.folder, "-o", picture)[0] == 0
    assert picture.stat().st_size > 1000


# faults

ONE = {"nrobots": 1, "heterogeneous": 0}


@pytest.mark.parametrize(
    ("algo", "changes", "says"),
    [
        ("coevo2", {"environment": "CartPole-v1", "policy": ONE}, ["two robots", "ErPredprey"]),
        ("coevo2", {"environment": "tiny_envs:Tiny-v0", "policy": ONE},
         ["of one robot", "PettingZoo", "algo = OpenAI-ES"]),
        ("coevo2", {"policy": {"nrobots": 1}}, ["set nrobots = 2"]),
        ("coevo2", {"policy": {"heterogeneous": 0}}, ["set heterogeneous = 1"]),
        ("coevo2", {"policy": {"normalize": 1}}, ["set normalize = 0"]),
        ("coevo", {"popsize": 4, "selsize": 5}, ["selsize = 5 is more than popsize = 4"]),
        ("archive", {"environment": "CartPole-v1", "policy": ONE},
         ["archive needs two robots", "ErPredprey"]),
        ("archive", {"policy": {"heterogeneous": 0}}, ["archive evolves", "set heterogeneous = 1"]),
        ("archivestar", {"policy": {"normalize": 1}},
         ["archivestar does not", "set normalize = 0"]),
        ("archive", {"popsize": 2}, ["popsize = 2 is out of range", "1 (archivestar has more"]),
        ("maxsolvestar", {"popsize": 0}, ["popsize = 0 is out of range"]),
        ("archivestar", {"popsize": 0}, ["popsize = 0 is out of range", "from 1 to"]),
        ("archive", {"checkoverfiteveryn": 5}, ["checkoverfiteveryn = 5", "0 (never"]),
        ("archive", {"nphases": 5}, ["nphases is a hyperparameter of maxsolvestar, but"]),
        ("archivestar", {"addtoarchive": 5}, ["did you mean addtoarchiveevery?"]),
        ("maxsolvestar", {"archivelen": 0}, ["archivelen = 0 is out of range"]),
    ],
)  # fmt: skip
def test_experiments_that_are_refused(algo, changes, says, refused, tmp_path):
    write(tmp_path, algo, **changes)
    refused(*arguments(tmp_path), says=says)
    assert not (tmp_path / "run").exists()


def test_populations_are_not_overwritten(refused, command, own, tmp_path):
    assert run(own, tmp_path / "run")
    before = contents(tmp_path / "run")
    refused(*arguments(tmp_path), says=["S3", "exists", "--resume", "--force"])
    (tmp_path / "run" / "S33G5.npy").write_text("of another run")
    for path in (tmp_path / "run").iterdir():
        if path.name.endswith(("S3.npy", "S3.npz", "S3.fit")):
            path.unlink()
    shutil.rmtree(tmp_path / "run" / "tensorboardS3")
    refused(*arguments(tmp_path), says=["S3G0.npy exists", "--force"])
    refused(*arguments(tmp_path), "--resume", says=["S3G0.npy exists", "cannot be resumed"])
    (tmp_path / "run" / "S3G77.npy").write_text("of a longer run")
    (tmp_path / "run" / ".S3G4.123.npy").write_text("left by a process that was killed")
    assert command(*arguments(tmp_path, "--force"))[0] == 0
    (tmp_path / "run" / "S33G5.npy").unlink()
    assert contents(tmp_path / "run") == before


def test_damaged_checkpoints(whole, refused, tmp_path):
    """Without any of their arrays; files cut short: test_faults_files.py."""
    write(tmp_path, whole.algo)
    shutil.copytree(whole.folder, tmp_path / "run")
    path = tmp_path / "run" / "checkpointS3.npz"
    arrays = dict(np.load(path))
    needed = [name for name in arrays if name.startswith("algorithm.")]
    assert len(needed) >= 5
    for name in (*needed, "record.stat"):
        np.savez(path, **{key: value for key, value in arrays.items() if key != name})
        refused(*arguments(tmp_path, "--resume"), says=["checkpointS3.npz", "--force"])
    for name in ("algorithm.v", "algorithm.archive_prey"):
        if name in arrays:
            np.savez(path, **arrays | {name: arrays[name][..., :-1]})
            refused(*arguments(tmp_path, "--resume"), says=["does not fit", "--force"])
    np.savez(path, **arrays)
    key, value = {"coevo": ("selsize", 3), "coevo2": ("evolving", "random")}.get(
        whole.algo, ("ncompetitors", 4)
    )
    write(tmp_path, whole.algo, **{key: value})
    refused(*arguments(tmp_path, "--resume"), says=[key, f"is now {value}"])
