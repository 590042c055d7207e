"""Runs against archives: their files, and that workers, stops and saves do not show in them."""

import re

import numpy as np
import pytest

from botschool import config, problems
from botschool.analysis.tournament import Contest
from botschool.evolution.algorithms.halloffame import SAVED
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.run import evolve
from botschool.policies.policy import Policy
from botschool.problems import Episodes
from running import same

ALGORITHMS = ("archive", "archivestar", "maxsolvestar")
MAXSTEPS = 250
GENERATIONS = 9
POLICY = {"nrobots": 2, "heterogeneous": 1, "maxsteps": MAXSTEPS, "nhiddens": 4, "bias": 1}
POLICY |= {"architecture": 3, "winit": 2, "wrange": 2}  # bold robots, who meet
COMMON = {"maxmsteps": 1000, "ngenerations": GENERATIONS, "samplesize": 5, "ncompetitors": 3}
COMMON |= {"noiseStdDev": 0.3, "stepsize": 0.1, "wdecay": 1, "saveeach": 4}
OWN = {
    "archive": {"addtoarchiveevery": 2},
    "archivestar": {"addtoarchiveevery": 2, "popsize": 2},
    "maxsolvestar": {"nphases": 3, "archivelen": 5},
}


def write(folder, algo="archive", policy=None, **options):
    """Writes FOLDER/own.ini, a very small experiment. Gives its path."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["[EXP]", "environment = ErPredprey", f"algo = {algo}", "[POLICY]"]
    lines += [f"{key} = {value}" for key, value in (POLICY | (policy or {})).items()]
    lines += ["[ALGO]"]
    lines += [f"{key} = {value}" for key, value in (COMMON | OWN[algo] | options).items()]
    (folder / "own.ini").write_text("\n".join(lines) + "\n")
    return folder / "own.ini"


def run(own, folder, workers=1, resume=False, **limits):
    """A run with seed 3 in the folder; whether it was finished."""
    folder.mkdir(parents=True, exist_ok=True)
    return evolve(Coevolution(own, 3, workers), folder, resume=resume, **limits)


def same_but_for_stops(whole, parts):
    """Whether both runs left the same, but that one was stopped and kept individuals then."""
    for path in parts.glob("S3*G*.npy"):
        if not (whole / path.name).exists():
            path.unlink()
    return same(whole, parts)


@pytest.fixture(scope="module", params=ALGORITHMS)
def whole(request, tmp_path_factory):
    """(the algorithm's name, the folder of an undisturbed run)."""
    folder = tmp_path_factory.mktemp(request.param)
    own = config.load(write(folder, request.param))
    assert run(own, folder / "run")
    return request.param, folder / "run"


def arguments(folder, *more):
    return ("es", "-f", folder / "own.ini", "-s", 3, "-o", folder / "run", *more)


def test_files_have_the_names_and_shapes_of_the_format(whole):
    _, folder = whole
    expected = {"S3.fit", "bestgS3.npy", "statS3.npy", "checkpointS3.npz", "tensorboardS3"}
    saved = [0, 4, 8, GENERATIONS]
    expected |= {f"S3G{g}.npy" for g in saved} | {f"S3FitG{g}.npy" for g in saved}
    assert {path.name for path in folder.iterdir()} == expected
    own = config.load(folder.parent / "own.ini")
    size = Coevolution(own, 3).policy.nparameters
    for generation in saved:
        networks = np.load(folder / f"S3G{generation}.npy")
        fitness = np.load(folder / f"S3FitG{generation}.npy")
        assert (networks.shape, networks.dtype) == ((2 * SAVED, size), np.float64)
        assert (fitness.shape, fitness.dtype) == ((2 * SAVED, SAVED), np.float64)
        assert np.array_equal(fitness[SAVED:], 1 - fitness[:SAVED].T)
    assert len(np.load(folder / "statS3.npy")) == 6 * GENERATIONS


def test_entries_of_the_fitness_matrix_can_be_played_again(whole):
    _, folder = whole
    own = config.load(folder.parent / "own.ini")
    problem = problems.make("ErPredprey")
    policy = Policy(problem.name, problem.interface, own.policy)
    different = set()
    for generation in (0, 4, GENERATIONS):
        networks = np.load(folder / f"S3G{generation}.npy")
        fitness = np.load(folder / f"S3FitG{generation}.npy")
        different |= set(fitness.ravel().tolist())
        for i in range(0, SAVED, 3):
            for k in range(SAVED):
                pair = np.array([[i], [SAVED + k]], dtype=np.int32)
                episodes = Episodes(pair, np.array([3], np.uint64), np.array([0], np.uint32))
                outcome = problem.evaluate(policy, networks, None, episodes, MAXSTEPS)
                assert outcome.fitness[0] == fitness[i, k]
    assert len(different) > 5


def test_the_stat_file_says_what_happened(whole):
    _, folder = whole
    coevolution = Coevolution(config.load(folder.parent / "own.ini"), 3)
    steps, rows = 0, []
    evaluate = coevolution.problem.evaluate

    def counting(*given):
        nonlocal steps
        outcome = evaluate(*given)
        steps += int(outcome.steps.sum())
        return outcome

    coevolution.problem.evaluate = counting
    best = -np.inf
    for _ in range(GENERATIONS):
        coevolution.advance()
        algorithm = coevolution.algorithm
        best = max(best, algorithm.fitness[0, 0])
        size = np.abs(algorithm.centres).mean()
        rows.append([steps, best, best, *algorithm.fitness[0], size])
    stat = np.load(folder / "statS3.npy").reshape(-1, 6)
    assert stat.tolist() == rows
    genotype = np.load(folder / "bestgS3.npy")
    assert np.array_equal(genotype, np.concatenate(algorithm.champions))


def test_a_line_per_generation(whole, command, tmp_path):
    algo, _ = whole
    write(tmp_path, algo)
    code, out, errors = command(*arguments(tmp_path, "--generations", 3))
    assert (code, errors) == (0, "")
    first, second, third, result = out.splitlines()
    who = ("predators", "prey", "predators")
    for g, line in enumerate((first, second, third), 1):
        said = (
            rf"seed 3  generation {g} \([0-9.]+%\)  {who[g - 1]} evolved  steps [0-9]+  predators 0"
        )
        assert re.match(said, line)
    assert "prey -  " in first and "prey -  " not in second  # they have not had a turn
    assert "best of both" in result and "bestgS3.npy" in result


@pytest.mark.parametrize("workers", [2, 5])
def test_workers_do_not_show(workers, whole, tmp_path):
    algo, folder = whole
    assert run(config.load(write(tmp_path, algo)), tmp_path / "run", workers)
    assert same(folder, tmp_path / "run")


def test_early_ends_do_not_show(whole, tmp_path):
    algo, folder = whole
    own = config.load(write(tmp_path, algo))
    for limits in ({"generations": 1}, {"steps": 1}, {"generations": 3}, {"generations": 6}):
        assert run(own, tmp_path / "run", resume=True, **limits)
    assert (tmp_path / "run" / "S3G3.npy").exists()
    assert run(own, tmp_path / "run", resume=True)
    assert same_but_for_stops(folder, tmp_path / "run")


def test_requests_to_stop_do_not_show(whole, tmp_path):
    algo, folder = whole
    own = config.load(write(tmp_path, algo))
    for moment in (0, 1, 6):
        asked = 0

        def stopping(moment=moment):
            nonlocal asked
            asked += 1
            return asked > moment

        parts = tmp_path / str(moment)
        parts.mkdir()
        assert not evolve(Coevolution(own, 3, stopping=stopping), parts)
        assert evolve(Coevolution(own, 3), parts, resume=True)
        assert same_but_for_stops(folder, parts)


def test_saving_does_not_show(whole, tmp_path):
    """Individuals meet for the files alone."""
    algo, folder = whole
    assert run(config.load(write(tmp_path, algo, saveeach=1)), tmp_path / "run")
    for name in ("statS3.npy", "bestgS3.npy", "S3G8.npy", "S3FitG8.npy"):
        assert (tmp_path / "run" / name).read_bytes() == (folder / name).read_bytes()


def test_steps_end_a_run(tmp_path):
    own = config.load(write(tmp_path, maxmsteps=0.03, ngenerations=0))
    assert run(own, tmp_path / "run")
    steps = np.load(tmp_path / "run" / "statS3.npy").reshape(-1, 6)[:, 0]
    assert len(steps) > 2 and steps[-2] < 30_000 <= steps[-1]


def test_phases_are_those_of_the_experiment(tmp_path):
    """... wherever the user has stopped it in between."""
    own = config.load(write(tmp_path, "maxsolvestar"))
    coevolution, phases = Coevolution(own, 3), []
    tmp_path.joinpath("run").mkdir()

    def report(run):
        phases.append(run.algorithm.phase)

    assert evolve(coevolution, tmp_path / "run", report=report, generations=5)
    assert phases[1:] == [0, 0, 0, 1, 1]


# what comes after


def test_individuals_take_part_in_tournaments(whole, command, tmp_path):
    _, folder = whole
    file = folder.parent / "own.ini"
    picture = tmp_path / "tournament.png"
    code, out, errors = command("tournament", folder, "-f", file, "-o", picture)
    assert (code, errors) == (0, "")
    assert "historical progress" in out and "global progress" in out
    assert picture.stat().st_size > 1000
    own = config.load(file)
    contest = Contest(own, 3)
    networks = np.load(folder / "S3G8.npy")
    expected = contest.meet(networks[:SAVED], networks[SAVED:]).mean()
    row = next(line for line in out.splitlines() if line.split()[:1] == ["8"])
    assert row.split()[3] == f"{expected:.2f}"


def test_strings_of_g(whole, command, tmp_path):
    _, folder = whole
    common = ("es", "-f", folder.parent / "own.ini", "-s", 3, "-o", folder, "-p")
    page = tmp_path / "chase.html"
    assert command(*common, "-g", "P-8-2", "--replay", page)[0] == 0
    assert page.stat().st_size > 10_000
    for text in ("p-8-10", "m-8-4", "M-8-4", f"c-{folder}/S3G0.npy-{folder}/S3G8.npy"):
        code, out, errors = command(*common, "-g", text)
        assert (code, errors) == (0, "")
        assert "0." in out
    assert command(*common, "-g", folder / "bestgS3.npy", "--render", "none")[0] == 0


def test_runs_of_two_algorithms_meet(command, tmp_path):
    for algo in ("archive", "maxsolvestar"):
        assert run(config.load(write(tmp_path / algo, algo)), tmp_path / algo, generations=2)
    one, two = (tmp_path / algo / "S3G2.npy" for algo in ("archive", "maxsolvestar"))
    file = tmp_path / "archive" / "own.ini"
    code, _, errors = command("es", "-f", file, "-p", "-g", f"c-{one}-{two}", "-o", tmp_path)
    assert (code, errors) == (0, "")


def test_plotstat_draws_it(whole, command, tmp_path):
    _, folder = whole
    picture = tmp_path / "curve.png"
    assert command("plotstat", folder, "-o", picture)[0] == 0
    assert picture.stat().st_size > 1000


# faults


@pytest.mark.parametrize(
    ("algo", "policy", "options", "says"),
    [
        ("archive", {"heterogeneous": 0}, {}, ["archive evolves", "set heterogeneous = 1"]),
        ("archivestar", {"normalize": 1}, {}, ["archivestar does not", "set normalize = 0"]),
        ("archive", {}, {"popsize": 2}, ["popsize = 2 is out of range", "1 (archivestar has more"]),
        ("maxsolvestar", {}, {"popsize": 0}, ["popsize = 0 is out of range"]),
        ("archivestar", {}, {"popsize": 0}, ["popsize = 0 is out of range", "from 1 to"]),
        ("archive", {}, {"checkoverfiteveryn": 5}, ["checkoverfiteveryn = 5", "0 (never"]),
        ("archive", {}, {"nphases": 5}, ["nphases is a hyperparameter of maxsolvestar, but"]),
        ("archivestar", {}, {"addtoarchive": 5}, ["did you mean addtoarchiveevery?"]),
        ("maxsolvestar", {}, {"archivelen": 0}, ["archivelen = 0 is out of range"]),
    ],
)
def test_experiments_that_are_refused(algo, policy, options, says, refused, tmp_path):
    write(tmp_path, algo, policy, **options)
    refused(*arguments(tmp_path), says=says)
    assert not (tmp_path / "run").exists()


def test_names_of_algorithms_are_suggested(refused, tmp_path):
    path = write(tmp_path)
    path.write_text(path.read_text().replace("algo = archive", "algo = archivstar"))
    refused(*arguments(tmp_path), says="did you mean archivestar?")


def test_other_problems_are_refused(refused, tmp_path):
    path = write(tmp_path, policy={"nrobots": 1, "heterogeneous": 0})
    path.write_text(path.read_text().replace("ErPredprey", "CartPole-v1"))
    refused(*arguments(tmp_path), says=["archive needs two robots", "ErPredprey"])


def test_damaged_checkpoints(whole, refused, tmp_path):
    algo, _ = whole
    assert run(config.load(write(tmp_path, algo)), tmp_path / "run", generations=4)
    path = tmp_path / "run" / "checkpointS3.npz"
    arrays = dict(np.load(path))
    grown = [name for name in arrays if name.startswith("algorithm.archive_p")]
    assert len(grown) >= 2
    for name in (*grown, "algorithm.saved", "algorithm.generation"):
        np.savez(path, **{key: value for key, value in arrays.items() if key != name})
        refused(*arguments(tmp_path, "--resume"), says=["checkpointS3.npz", "--force"])
    np.savez(path, **arrays | {"algorithm.archive_prey": arrays["algorithm.archive_prey"][:, 1:]})
    refused(*arguments(tmp_path, "--resume"), says=["does not fit", "--force"])
    np.savez(path, **arrays)
    write(tmp_path, algo, ncompetitors=4)
    refused(*arguments(tmp_path, "--resume"), says=["ncompetitors = 3", "is now 4"])


def test_only_runs_without_phases_may_be_lengthened(refused, tmp_path):
    for algo in ("archive", "maxsolvestar"):
        folder = tmp_path / algo
        assert run(config.load(write(folder, algo)), folder / "run", generations=2)
        write(folder, algo, maxmsteps=2000)
    assert run(config.load(tmp_path / "archive" / "own.ini"), tmp_path / "archive/run", resume=True)
    refused(*arguments(tmp_path / "maxsolvestar", "--resume"), says=["maxmsteps", "is now 2000"])


def test_large_archives_are_saved_less_often(tmp_path):
    coevolution = Coevolution(config.load(write(tmp_path)), 3)
    coevolution.advance()
    assert coevolution.due(61) and not coevolution.due(59)
    coevolution.saving = 10.0
    assert coevolution.due(201) and not coevolution.due(199)
    while coevolution.record.generation < 4:
        coevolution.advance()
    assert coevolution.due(0)
