"""Runs of coevo2: their files, and that workers, stops and kills do not show in them."""

import json
import random
import shutil
import signal
import sys

import numpy as np
import pytest

import running
from botschool import config, problems
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.record import STAT
from botschool.evolution.replicate import replicate
from botschool.evolution.run import Options, evolve
from botschool.policies.policy import Policy
from botschool.problems import Episodes
from running import contents, finish, run_seeds, same, start

POPSIZE = 6
MAXSTEPS = 300
POLICY = {"nrobots": 2, "heterogeneous": 1, "maxsteps": MAXSTEPS, "nhiddens": 4, "bias": 1}
POLICY |= {"architecture": 3, "winit": 2, "wrange": 2}  # bold robots, who meet
ALGORITHM = {"ngenerations": 5, "popsize": POPSIZE, "selsize": 2, "samplesize": 2, "saveeach": 2}
ALGORITHM |= {"noiseStdDev": 0.3, "stepsize": 0.3}
posix = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")


def write(folder, environment="ErPredprey", policy=None, **algorithm):
    """Writes FOLDER/own.ini, a very small experiment. Gives its path."""
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["[EXP]", f"environment = {environment}", "algo = coevo2", "[POLICY]"]
    lines += [f"{key} = {value}" for key, value in (POLICY | (policy or {})).items()]
    lines += ["[ALGO]", *(f"{key} = {value}" for key, value in (ALGORITHM | algorithm).items())]
    (folder / "own.ini").write_text("\n".join(lines) + "\n")
    return folder / "own.ini"


def experiment(folder, **options):
    """The same, read."""
    return config.load(write(folder, **options))


def run(own, folder, workers=1, resume=False, **limits):
    """A run with seed 3 in the folder; whether it was finished."""
    folder.mkdir(parents=True, exist_ok=True)
    return evolve(Coevolution(own, 3, workers), folder, resume=resume, **limits)


def same_but_for_stops(whole, parts):
    """Whether both runs left the same, but that one was stopped and kept its populations then."""
    for path in parts.glob("S3*G*.npy"):
        if not (whole / path.name).exists():
            path.unlink()
    return same(whole, parts)


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The folder of an undisturbed run."""
    folder = tmp_path_factory.mktemp("whole")
    assert run(experiment(folder.parent), folder)
    return folder


@pytest.fixture
def own(tmp_path):
    return experiment(tmp_path)


# files


def test_files_have_the_names_and_shapes_of_the_format(whole, own):
    expected = {"S3.fit", "bestgS3.npy", "statS3.npy", "checkpointS3.npz", "tensorboardS3"}
    for generation in (0, 2, 4, 5):
        expected |= {f"S3G{generation}.npy", f"S3FitG{generation}.npy"}
    assert {path.name for path in whole.iterdir()} == expected
    size = Coevolution(own, 3).policy.nparameters
    for generation in (0, 2, 4, 5):
        population = np.load(whole / f"S3G{generation}.npy")
        fitness = np.load(whole / f"S3FitG{generation}.npy")
        assert (population.shape, population.dtype) == ((2 * POPSIZE, size), np.float64)
        assert (fitness.shape, fitness.dtype) == ((2 * POPSIZE, POPSIZE), np.float64)
        # a prey's fitness is 1 - the predator's, and the best are first
        assert np.array_equal(fitness[POPSIZE:], 1 - fitness[:POPSIZE].T)
        for rows in np.split(fitness, 2):
            assert (np.diff(rows.mean(axis=1)) <= 1e-12).all()
    fit = (whole / "S3.fit").read_text().split()
    assert fit[0::2] == ["seed", "gen", "steps", "bestfit", "bestgfit"]
    assert fit[1:4:2] == ["3", "5"]


@pytest.mark.parametrize("generation", [0, 2, 5])
def test_entries_of_the_fitness_matrix_can_be_played_again(generation, whole, own):
    problem = problems.make("ErPredprey")
    policy = Policy(problem.name, problem.interface, own.policy)
    population = np.load(whole / f"S3G{generation}.npy")
    fitness = np.load(whole / f"S3FitG{generation}.npy")
    assert len(set(fitness.ravel().tolist())) > 5
    for i in range(POPSIZE):
        for k in range(POPSIZE):
            pair = np.array([[i], [POPSIZE + k]], dtype=np.int32)
            episodes = Episodes(pair, np.array([3], np.uint64), np.array([0], np.uint32))
            outcome = problem.evaluate(policy, population, None, episodes, MAXSTEPS)
            assert outcome.fitness[0] == fitness[i, k]
            assert 1 - outcome.fitness[0] == fitness[POPSIZE + k, i]


def test_the_best_of_both_are_one_genotype(whole, own):
    """... that `es -p -g` shows."""
    population, fitness = np.load(whole / "S3G5.npy"), np.load(whole / "S3FitG5.npy")
    best = np.load(whole / "bestgS3.npy")
    assert np.array_equal(best, np.concatenate([population[0], population[POPSIZE]]))
    problem = problems.make("ErPredprey")
    policy = Policy(problem.name, problem.interface, own.policy)
    outcome = problem.evaluate(policy, best[None], None, Episodes.of([3], 1), MAXSTEPS)
    assert outcome.fitness[0] == fitness[0, 0]


def test_first_populations_are_the_initial_networks(whole, own):
    policy = Coevolution(own, 3).policy
    pairs = np.array([policy.initial(3, i) for i in range(POPSIZE)])
    expected = np.concatenate(np.split(pairs, 2, axis=1))
    saved = np.load(whole / "S3G0.npy")
    for part in (slice(0, POPSIZE), slice(POPSIZE, None)):
        assert sorted(map(tuple, saved[part])) == sorted(map(tuple, expected[part]))


def test_the_stat_file_says_what_happened(tmp_path, own):
    """Checked against the populations of every generation."""
    own.algo.saveeach = 1
    steps = []
    coevolution = Coevolution(own, 3)
    evaluate = coevolution.problem.evaluate

    def spying(*arguments):
        outcome = evaluate(*arguments)
        steps.append(int(outcome.steps.sum()))
        return outcome

    coevolution.problem.evaluate = spying
    assert evolve(coevolution, tmp_path)
    assert len(steps) == 1 + 5 * 21
    stat = np.load(tmp_path / "statS3.npy").reshape(-1, 6)
    assert len(stat) == 5
    best = -np.inf
    for g, row in enumerate(stat, 1):
        fitness = np.load(tmp_path / f"S3FitG{g}.npy")[:POPSIZE]
        best = max(best, fitness.mean(axis=1).max())
        assert row[0] == sum(steps[: 1 + 21 * g])
        average = fitness.mean(axis=1).max(), fitness.mean()
        size = np.abs(np.load(tmp_path / f"S3G{g}.npy")).mean()
        assert row[1:] == pytest.approx([best, best, *average, size])
    last = coevolution.record.last
    assert last["predators"] + last["prey"] == pytest.approx(1)


def test_fitness_is_averaged_over_the_episodes(tmp_path):
    """With action noise, episodes of the same two differ."""
    noise = {"episodes": 3, "action_noise": 1, "action_noise_range": 0.5}
    own = experiment(tmp_path, policy=noise, ngenerations=1)
    assert run(own, tmp_path / "run")
    problem = problems.make("ErPredprey")
    policy = Policy(problem.name, problem.interface, own.policy)
    population = np.load(tmp_path / "run" / "S3G1.npy")
    fitness = np.load(tmp_path / "run" / "S3FitG1.npy")
    means = []
    for i in range(POPSIZE):
        pairs = np.array([[i] * 3, [POPSIZE] * 3], dtype=np.int32)
        episodes = Episodes(pairs, np.full(3, 3, np.uint64), np.arange(3, dtype=np.uint32))
        means.append(problem.evaluate(policy, population, None, episodes, MAXSTEPS).fitness.mean())
    assert fitness[:POPSIZE, 0] == pytest.approx(means)


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


def test_plotstat_draws_it(whole, command, tmp_path):
    picture = tmp_path / "curve.png"
    assert command("plotstat", whole, "-o", picture)[0] == 0
    assert picture.stat().st_size > 1000


def test_a_line_per_generation(command, tmp_path, own):
    code, out, errors = command(*arguments(tmp_path))
    assert (code, errors) == (0, "")
    lines = out.splitlines()
    assert len(lines) == 6
    for g, line in enumerate(lines[:-1]):
        who = "prey" if g % 2 else "predators"
        assert line.startswith(f"seed 3  generation {g + 1} ({20 * (g + 1)}.0%)  {who} evolved  ")
        for word in ("steps", "local progress", "predators 0.", "prey "):
            assert word in line
        assert ("time left 0:00:" in line) == (g > 0)  # both sides have had a turn
    assert "best of both" in lines[-1] and "bestgS3.npy" in lines[-1]


def test_during_a_generation_the_bar_goes_on(tmp_path, own):
    shares = []
    evolve(Coevolution(own, 3), tmp_path, report=lambda run: shares.append(run.limit.share(run)))
    assert shares == sorted(shares) and shares[-1] == 1
    assert len(set(np.round(shares, 9))) >= 5 * 21


# workers, stops and kills


def arguments(folder, *more):
    return ("es", "-f", folder / "own.ini", "-s", 3, "-o", folder / "run", *more)


@pytest.mark.parametrize("workers", [2, 5])
def test_workers_do_not_show(workers, whole, own, tmp_path):
    assert run(own, tmp_path / "run", workers)
    assert same(whole, tmp_path / "run")


def in_bands(predators, prey):
    """Four predators at a time: all of a band meet the first prey, then the second, ..."""
    bands = [predators[i : i + 4] for i in range(0, len(predators), 4)]
    pairs = [(p, q) for band in bands for q in prey for p in band]
    return [list(side) for side in zip(*pairs, strict=True)]


def test_consecutive_episodes_share_networks(own):
    coevolution = Coevolution(own, 3)
    asked = []
    evaluate = coevolution.problem.evaluate

    def spying(policy, genotypes, normalisation, episodes, *rest):
        asked.append(episodes.candidate.tolist())
        return evaluate(policy, genotypes, normalisation, episodes, *rest)

    coevolution.problem.evaluate = spying
    for _ in range(3):
        coevolution.advance()
    first, predators_evolve, prey_evolve = asked[0], asked[1:22], asked[22:]
    everybody = range(POPSIZE)
    assert first == in_bands(everybody, range(POPSIZE, 2 * POPSIZE))
    for pairs in predators_evolve[:20]:
        assert pairs == in_bands(range(8), [8, 9])
    for pairs in prey_evolve[:20]:
        assert pairs == in_bands([0, 1], range(2, 10))
    assert predators_evolve[20] == in_bands([0, 1], range(2, 2 + POPSIZE))
    assert prey_evolve[20] == in_bands(everybody, [POPSIZE, POPSIZE + 1])


def test_early_ends_do_not_show(whole, own, tmp_path):
    folder = tmp_path / "run"
    for limits in ({"generations": 1}, {"steps": 1}, {"generations": 1}, {"generations": 4}):
        assert run(own, folder, resume=True, **limits)
    assert (folder / "S3G1.npy").exists()
    assert len(np.load(folder / "statS3.npy")) == 4 * 6
    assert run(own, folder, resume=True)
    assert same_but_for_stops(whole, folder)


def test_steps_end_a_run(own, tmp_path):
    assert run(own, tmp_path / "run", steps=1)  # when everyone has met everyone
    assert len(np.load(tmp_path / "run" / "statS3.npy")) == 0
    assert (tmp_path / "run" / "S3G0.npy").exists()


def test_generations_end_runs_of_other_algorithms(tmp_path):
    other = running.experiment(tmp_path)
    assert replicate(other, [3], tmp_path / "run", Options(generations=4))
    assert len(np.load(tmp_path / "run" / "statS3.npy")) == 4 * 6
    assert replicate(other, [3], tmp_path / "run", Options(resume=True))
    assert run_seeds(other, tmp_path / "whole", [3])
    assert same(tmp_path / "whole", tmp_path / "run")


def test_going_on_with_a_longer_run_does_not_show(whole, tmp_path):
    for generations, saveeach in ((3, 1), (5, 2)):
        own = experiment(tmp_path, ngenerations=generations, saveeach=saveeach)
        assert run(own, tmp_path / "run", resume=True)
    parts, expected = contents(tmp_path / "run"), contents(whole)
    assert {name for name in parts if parts[name] != expected.get(name)} == {
        *("S3G1.npy", "S3G3.npy", "S3FitG1.npy", "S3FitG3.npy")
    }


def test_a_request_to_stop_at_any_moment_does_not_show(whole, own, tmp_path):
    """In the first meeting, in sub-generations, between generations; heard before the next call."""
    for moment in (0, 1, 9, 22, 23, 40):
        asked = 0

        def stopping(moment=moment):
            nonlocal asked
            asked += 1
            return asked > moment

        folder = tmp_path / str(moment)
        folder.mkdir()
        assert not evolve(Coevolution(own, 3, stopping=stopping), folder)
        assert asked == moment + 1
        assert evolve(Coevolution(own, 3), folder, resume=True)
        assert same_but_for_stops(whole, folder)


@posix
def test_ten_kills_do_not_show(tmp_path):
    """By kill -9, at random moments of the real command."""
    chance = random.Random(1)
    own = experiment(tmp_path, ngenerations=100_000, saveeach=3)
    for _ in range(10):
        process = start(*arguments(tmp_path, "--resume"))
        for _ in range(chance.randint(0, 4)):
            process.stdout.readline()
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


@posix
def test_ctrl_c_saves_the_last_whole_generation(tmp_path):
    own = experiment(tmp_path, ngenerations=100_000, saveeach=1000)
    process = start(*arguments(tmp_path, "-w", 2))
    for _ in range(3):
        assert process.stdout.readline().startswith("seed 3  generation")
    process.send_signal(signal.SIGINT)
    code, out, errors = finish(process)
    assert (code, errors) == (130, "")
    done = len(np.load(tmp_path / "run" / "statS3.npy")) // 6
    assert f"stopped after {done} generations; all is saved" in out
    assert (tmp_path / "run" / f"S3G{done}.npy").exists()
    assert run(own, tmp_path / "run", resume=True, generations=done + 1)
    assert run(own, tmp_path / "undisturbed", generations=done + 1)
    assert same_but_for_stops(tmp_path / "undisturbed", tmp_path / "run")


# faults


@pytest.mark.parametrize(
    ("environment", "policy", "says"),
    [
        ("CartPole-v1", {"nrobots": 1, "heterogeneous": 0}, ["two robots", "ErPredprey"]),
        ("tiny_envs:Tiny-v0", {"nrobots": 1}, ["of one robot", "PettingZoo", "algo = OpenAI-ES"]),
        ("ErPredprey", {"nrobots": 1}, ["set nrobots = 2"]),
        ("ErPredprey", {"heterogeneous": 0}, ["set heterogeneous = 1"]),
        ("ErPredprey", {"normalize": 1}, ["set normalize = 0"]),
    ],
)
def test_problems_that_are_refused(environment, policy, says, refused, tmp_path):
    write(tmp_path, environment, policy)
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


def test_damaged_checkpoints(refused, own, tmp_path):
    assert run(own, tmp_path / "run", generations=1)
    path = tmp_path / "run" / "checkpointS3.npz"
    whole, arrays = path.read_bytes(), dict(np.load(path))
    for length in (0, 10, len(whole) // 2, len(whole) - 1):
        path.write_bytes(whole[:length])
        refused(*arguments(tmp_path, "--resume"), says=["checkpointS3.npz", "--force"])
    for name in ("algorithm.fitness", "algorithm.m", "algorithm.generation", "record.stat"):
        np.savez(path, **{key: value for key, value in arrays.items() if key != name})
        refused(*arguments(tmp_path, "--resume"), says=["checkpointS3.npz", "--force"])
    np.savez(path, **arrays | {"algorithm.v": arrays["algorithm.v"][:, :-1]})
    refused(*arguments(tmp_path, "--resume"), says=["does not fit", "--force"])
    path.write_bytes(whole)
    write(tmp_path, popsize=POPSIZE + 1)
    refused(*arguments(tmp_path, "--resume"), says=[f"popsize is now {POPSIZE + 1}"])
    write(tmp_path, evolving="random")
    refused(*arguments(tmp_path, "--resume"), says=["evolving = best", "is now random"])


def test_checkpoints_of_networks_that_were_computed_otherwise(refused, tmp_path):
    """As of versions in which an LSTM's outputs were linear, whatever out_type said."""
    assert run(experiment(tmp_path, policy={"out_type": 3}), tmp_path / "run", generations=1)
    path = tmp_path / "run" / "checkpointS3.npz"
    whole = dict(np.load(path))
    header = json.loads(str(whole["botschool"]))
    header["experiment"]["policy"]["out_type"] = 2
    fitness = whole["algorithm.fitness"].copy()
    fitness[0, -1] = np.nextafter(fitness[0, -1], 2)  # the last bit of one meeting
    for changed, out_type in (
        ({"botschool": np.array(json.dumps(header))}, 2),
        ({"algorithm.fitness": fitness}, 3),
    ):
        np.savez(path, **whole | changed)
        write(tmp_path, policy={"out_type": out_type})
        says = ["checkpointS3.npz", "evaluates robots differently", "--force"]
        refused(*arguments(tmp_path, "--resume"), says=says)
