"""Faults of files, environments and the user: one sentence and exit code 2, or survived."""

import json
import pickle
import re
import shutil
import sys

import numpy as np
import pytest

import running
from botschool import cli
from botschool.evolution.run import Run, evolve
from running import TESTS, contents, experiment, run_seeds, same, write_experiment
from tiny_envs import FAULTY_SEED

SENTENCE = re.compile(r"error: \S[^\n]*[.?]\n")


@pytest.fixture
def command(capfd, monkeypatch):
    """Calls the command in this process: (exit code, standard output, standard error)."""

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["botschool", *map(str, arguments)])
        capfd.readouterr()
        with pytest.raises(SystemExit) as end:
            cli.main()
        code = 0 if end.value.code is None else end.value.code
        return (code, *capfd.readouterr())

    monkeypatch.syspath_prepend(TESTS)
    return call


@pytest.fixture
def refused(command):
    """Calls the command, which must refuse in a sentence that holds the given words. Gives it."""

    def call(*arguments, says=()):
        code, _, errors = command(*arguments)
        one_sentence(code, errors, says)
        return errors

    return call


def one_sentence(code, errors, says=()):
    assert code == 2, errors
    assert SENTENCE.fullmatch(errors), errors
    for word in [says] if isinstance(says, str) else says:
        assert str(word) in errors


def finished_run(folder, environment="CartPole-v1", algo="SSS", normalize=1, **options):
    """A run with seed 1 in FOLDER/results, of FOLDER/own.ini."""
    own = experiment(folder, environment, algo, {"normalize": normalize}, **options)
    assert run_seeds(own, folder / "results")
    return folder / "own.ini", folder / "results"


# the command line


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ("es --sed 3", ["--sed", "--seed", "botschool es --help"]),
        ("es -f own.ini -s -1", ["--seed", "0"]),
        ("es -f own.ini -s eleven", ["--seed", "integer"]),
        ("es -f own.ini -s 99999999999999999999", ["--seed"]),
        ("es -f own.ini -w 0", ["--workers", "1"]),
        ("es -f own.ini -w 1000000", ["--workers", "1024"]),
        ("es -f own.ini -n 0", ["--replications", "1"]),
        ("es -f own.ini -n 1000000000", ["--replications"]),
        ("es -f own.ini --steps 0", ["--steps", "1"]),
        ("es -f own.ini -p --episodes 0", ["--episodes", "1"]),
        ("es -f", ["-f", "argument"]),
        ("es own.ini", ["own.ini"]),
        ("evolve", ["evolve", "botschool --help"]),
        ("es -f own.ini --resume --force", ["--resume", "--force"]),
        ("es -f own.ini -p --render cinema", ["cinema", "human", "none"]),
    ],
)
def test_wrong_arguments(arguments, says, refused, tmp_path, monkeypatch):
    write_experiment(tmp_path)
    monkeypatch.chdir(tmp_path)
    refused(*arguments.split(), says=says)
    assert [path.name for path in tmp_path.iterdir()] == ["own.ini"]


def test_without_arguments_there_is_help(command):
    code, out, errors = command()
    assert code in (0, 2)  # as Typer likes it
    assert "es" in out + errors and "error" not in errors


def test_help_loads_nothing_heavy():
    heavy = {"matplotlib", "gymnasium", "torch", "pybullet", "numpy", "tensorboard", "pygame"}
    program = (
        "import sys\nsys.argv = ['botschool', 'es', '--help']\n"
        "from botschool.cli import main\n"
        "try:\n    main()\n"
        "except SystemExit as end:\n    assert not end.code\n"
        "print(*sys.modules, file=sys.stderr)\n"
    )
    process = running.subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert "Example: botschool es -f" in process.stdout
    assert not heavy & set(process.stderr.split())


# experiment files


@pytest.mark.parametrize(
    ("line", "changed", "says"),
    [
        ("nhiddens = 3", "nhidens = 3", ["line 8", "nhidens", "did you mean nhiddens?"]),
        ("nhiddens = 3", "nhiddens = three", ["line 8", "three", "not a number"]),
        ("nhiddens = 3", "nhiddens = -1", ["line 8", "nhiddens = -1", "0 to 10000"]),
        ("[POLICY]", "", ["[POLICY]"]),
        ("[ALGO]", "[ALGOS]", ["[ALGOS]", "[ALGO]"]),
        ("algo = SSS", "algo = CMA-ES", ["line 3", "CMA-ES", "OpenAI-ES, SSS, coevo2"]),
        ("algo = SSS", "algo = SSSS", ["line 3", "did you mean SSS?"]),
        ("popsize = 6", "popsize = 7", ["popsize = 7", "popsize = 8"]),
        ("nhiddens = 3", "nhiddens = 3\nnrobots = 2", ["nrobots"]),
        ("nhiddens = 3", "nhiddens = 3\nnbins = 5", ["nbins = 1"]),
    ],
)
def test_wrong_experiments(line, changed, says, refused, tmp_path):
    ini = write_experiment(tmp_path)
    text = ini.read_text()
    assert line in text
    ini.write_text(text.replace(line, changed))
    refused("es", "-f", ini, "-o", tmp_path / "results", says=says)
    assert not (tmp_path / "results").exists()


def test_missing_experiment(refused, tmp_path):
    write_experiment(tmp_path)
    refused("es", "-f", tmp_path / "ovn.ini", says=["ovn.ini", "did you mean own.ini"])
    refused("es", "-f", tmp_path, says=["folder"])


def test_coevo2_is_not_there_yet(refused, tmp_path):
    ini = tmp_path / "own.ini"
    ini.write_text("[EXP]\nenvironment = CartPole-v1\nalgo = coevo2\n[POLICY]\n[ALGO]\n")
    refused("es", "-f", ini, "-o", tmp_path / "new", says=["coevo2", "OpenAI-ES or SSS"])
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize(
    ("environment", "says"),
    [
        ("CartPol-v1", "did you mean CartPole-v1?"),
        ("ErDpol", "did you mean ErDpole?"),
        ("Walk-on-water-v0", "is the package that has it installed?"),
        ("tiny_envs:Tyny-v0", "did you mean tiny_envs:Tiny-v0?"),
        ("tyny_envs:Tiny-v0", "tyny_envs"),
        ("ErPredprey", "not in this version of botschool yet"),
        ("a/b/c-v0", "Malformed"),
        ("LunarLander-v2", "LunarLander-v3"),
        ("tiny_envs:Tinypackage-v0", "a_package_that_is_not_there"),
        ("tiny_envs:Tinymakes-v0", "no licence"),
        ("tiny_envs:Tinyimages-v0", ["images of shape (8, 8, 3)", "Box of one dimension"]),
        ("tiny_envs:Tinynested-v0", ["nested Dict", "Box of one dimension"]),
        ("tiny_envs:Tinysequence-v0", ["MultiBinary(3)", "Discrete actions"]),
        ("Blackjack-v1", "nested Tuple"),
    ],
)
@pytest.mark.filterwarnings("ignore")
def test_environments_that_cannot_be_evolved(environment, says, refused, tmp_path):
    ini = write_experiment(tmp_path, environment)
    refused("es", "-f", ini, "-o", tmp_path / "new", says=says)
    assert not (tmp_path / "new").exists()


# genotypes


def test_genotypes_that_do_not_fit(refused, tmp_path):
    ini, results = finished_run(tmp_path)
    saved = np.load(results / "bestgS1.npy")
    wrong = {
        "short": (saved[:-1], [f"needs {len(saved)} values", f"({len(saved) - 1},)"]),
        "long": (np.append(saved, 0.0), [f"needs {len(saved)} values"]),
        "unnormalised": (saved[:-8], [f"needs {len(saved)} values", "8 for normalisation"]),
        "matrix": (saved[None], [f"needs {len(saved)} values"]),
        "empty": (saved[:0], [f"needs {len(saved)} values"]),
        "number": (np.array(3.0), [f"needs {len(saved)} values"]),
        "text": (saved.astype(str), [f"needs {len(saved)} values"]),
        "complex": (saved.astype(complex), [f"needs {len(saved)} values"]),
        "nan": (np.where(np.arange(len(saved)) == 2, np.nan, saved), ["finite"]),
        "std": (np.append(saved[:-1], 0.0), ["standard deviations"]),
    }
    for name, (values, says) in wrong.items():
        np.save(tmp_path / f"{name}.npy", values)
        refused("es", "-f", ini, "-p", "-g", tmp_path / f"{name}.npy", says=says)


def test_files_that_are_no_genotypes(refused, tmp_path):
    ini, results = finished_run(tmp_path)
    whole = (results / "bestgS1.npy").read_bytes()
    other = {
        "notes.npy": b"I am the very model of a modern major genotype\n",
        "empty.npy": b"",
        "zip.npy": b"PK\x03\x04 and no more",
        "half.npy": whole[: len(whole) // 2],
        "head.npy": whole[:9],
        "shape.npy": whole.replace(b"(26,)", b"(9**9,)"),
        "huge.npy": whole.replace(b"(26,), }         ", b"(26000000000,), }"),
    }
    assert other["huge.npy"] != whole != other["shape.npy"]
    for name, data in other.items():
        (tmp_path / name).write_bytes(data)
        refused("es", "-f", ini, "-p", "-g", tmp_path / name, says=["no genotype", name])
    for path in (results / "checkpointS1.npz", results / "S1.fit", results):
        refused("es", "-f", ini, "-p", "-g", path, says="genotype")
    refused("es", "-f", ini, "-g", tmp_path / "bestgS2.npy", says=["bestgS2.npy", "bestgS11.npy"])


class Trap:
    """Unpickling this is an attack."""

    def __reduce__(self):
        return (exec, ("raise SystemExit('unpickled')",))


def test_pickles_are_never_opened(refused, tmp_path):
    ini, results = finished_run(tmp_path)
    np.save(tmp_path / "trap.npy", np.array([Trap()], dtype=object), allow_pickle=True)
    (tmp_path / "bare.npy").write_bytes(pickle.dumps(Trap()))
    for name in ("trap.npy", "bare.npy"):
        refused("es", "-f", ini, "-p", "-g", tmp_path / name, says=["no genotype"])
    whole = dict(np.load(results / "checkpointS1.npz"))
    for name in ("botschool", "algorithm.population", "more"):
        trapped = whole | {name: np.array([Trap()], dtype=object)}
        np.savez(results / "checkpointS1.npz", **trapped)
        refused("es", "-f", ini, "-o", results, "--resume", says=["checkpointS1.npz", "--force"])


# checkpoints


def test_truncated_checkpoints(refused, tmp_path):
    """Cut at every length, in steps; finished work stays as it was."""
    ini, results = finished_run(tmp_path, maxmsteps=0.001)
    whole = (results / "checkpointS1.npz").read_bytes()
    before = {path.name: path.read_bytes() for path in results.glob("*S1.*") if path.is_file()}
    lengths = [0, 1, 2, 3, 4, *range(5, len(whole), 97), len(whole) - 22, len(whole) - 1]
    for length in lengths:
        (results / "checkpointS1.npz").write_bytes(whole[:length])
        refused("es", "-f", ini, "-o", results, "--resume", says=["checkpointS1.npz", "--force"])
        before["checkpointS1.npz"] = whole[:length]
        after = {path.name: path.read_bytes() for path in results.glob("*S1.*") if path.is_file()}
        assert after == before


def test_damaged_checkpoints(refused, command, tmp_path):
    """Bytes that have changed: refused, or where they mean nothing the run is as before."""
    ini, results = finished_run(tmp_path, maxmsteps=0.0005)
    whole = (results / "checkpointS1.npz").read_bytes()
    before = contents(results)
    numbers = np.random.default_rng(1)
    refusals = 0
    for place in numbers.choice(len(whole), 150, replace=False):
        damaged = bytearray(whole)
        damaged[place] ^= int(numbers.integers(1, 256))
        (results / "checkpointS1.npz").write_bytes(damaged)
        code, _, errors = command("es", "-f", ini, "-o", results, "--resume")
        if code:
            refusals += 1
            one_sentence(code, errors, ["checkpointS1.npz", "--force"])
            (results / "checkpointS1.npz").write_bytes(whole)
        assert contents(results) == before
    assert refusals > 75


def test_foreign_checkpoints(refused, tmp_path):
    ini, results = finished_run(tmp_path)
    path = results / "checkpointS1.npz"
    whole = dict(np.load(path))
    header = json.loads(str(whole["botschool"]))

    def rewritten(**changes):
        np.savez(path, **{**whole, "botschool": np.array(json.dumps(header | changes))})

    def without(*names):
        np.savez(path, **{name: value for name, value in whole.items() if name not in names})

    def resized(name):
        np.savez(path, **{**whole, name: whole[name][..., :-1]})

    files = {
        "another seed": (lambda: shutil.copy(path, results / "checkpointS2.npz"), ["of seed 1"]),
        "other arrays": (lambda: np.savez(path, steps=np.arange(3)), []),
        "one array": (lambda: np.save(path.open("wb"), np.arange(3)), []),
        "text": (lambda: path.write_text("checkpoint"), []),
        "nothing": (lambda: path.write_bytes(b""), []),
        "a folder": (lambda: (path.unlink(), path.mkdir()), []),
        "newer": (lambda: rewritten(format=99), ["another version"]),
        "no seed": (lambda: np.savez(path, **whole | {"botschool": np.array("{}")}), []),
        "a list": (lambda: np.savez(path, **whole | {"botschool": np.array("[1]")}), []),
        "no json": (lambda: np.savez(path, **whole | {"botschool": np.array("{")}), []),
        "no words": (lambda: np.savez(path, **whole | {"botschool": np.zeros(3)}), []),
        "strange experiment": (lambda: rewritten(experiment="CartPole"), []),
        "stranger experiment": (lambda: rewritten(experiment={"exp": 3}), []),
        "no population": (lambda: without("algorithm.population"), []),
        "no statistics": (lambda: without("evaluator.moments"), []),
        "no curve": (lambda: without("record.stat"), []),
        "small population": (lambda: resized("algorithm.population"), []),
        "few vectors": (lambda: resized("evaluator.normalisation"), []),
        "narrow curve": (lambda: resized("record.stat"), []),
        "curve of text": (lambda: np.savez(path, **whole | {"record.stat": np.array("x")}), []),
    }
    for name, (make, says) in files.items():
        if path.is_dir():
            path.rmdir()
        np.savez(path, **whole)
        make()
        seed = 2 if name == "another seed" else 1
        says = [f"checkpointS{seed}.npz", "--force", *says]
        refused("es", "-f", ini, "-o", results, "-s", seed, "--resume", says=says)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        *[("environment", "CartPole-v0"), ("algo", "OpenAI-ES"), ("popsize", 8), ("mutrate", 0.3)],
        *[("episodes", 3), ("nhiddens", 4), ("maxsteps", 61), ("normalize", 0), ("clip", 1)],
    ],
)
def test_checkpoints_of_other_experiments(key, value, refused, tmp_path):
    ini, results = finished_run(tmp_path)
    before = contents(results)
    parts = {"environment": "CartPole-v1", "algo": "SSS"}
    policy, algorithm = {"normalize": 1}, {}
    if key in parts:
        parts[key] = value
    elif key in ("popsize", "mutrate"):
        algorithm[key] = value
    else:
        policy[key] = value
    write_experiment(tmp_path, **parts, policy=policy, **algorithm)
    refused("es", "-f", ini, "-o", results, "--resume", says=[f"{key} is now {value}", "--force"])
    assert contents(results) == before


def test_an_environment_that_has_changed(refused, tmp_path):
    """The same experiment file, but the environment's observations have become more."""
    ini, results = finished_run(tmp_path, "tiny_envs:Tiny-v0")
    finished_run(tmp_path / "other", "CartPole-v1")
    header = np.load(results / "checkpointS1.npz")["botschool"]
    other = dict(np.load(tmp_path / "other" / "results" / "checkpointS1.npz"))
    np.savez(results / "checkpointS1.npz", **other | {"botschool": header})
    says = ["checkpointS1.npz", "environment has changed"]
    refused("es", "-f", ini, "-o", results, "--resume", says=says)


# earlier results


def test_earlier_results_are_not_overwritten(refused, command, tmp_path):
    ini, results = finished_run(tmp_path)
    before = contents(results)
    says = ["S1.npy exists", "--resume", "--force", "-s", "-o"]
    refused("es", "-f", ini, "-o", results, says=says)
    # also if it is one of several seeds, or only a part of a run
    refused("es", "-f", ini, "-o", results, "-s", 0, "-n", 3, says=says)
    assert contents(results) == before
    for path in results.iterdir():
        if path.name != "bestgS1.npy":
            shutil.rmtree(path) if path.is_dir() else path.unlink()
    refused("es", "-f", ini, "-o", results, says="bestgS1.npy exists")
    refused("es", "-f", ini, "-o", results, "--resume", says=["bestgS1.npy", "cannot be resumed"])
    assert command("es", "-f", ini, "-o", results, "--force")[0] == 0
    assert contents(results) == before


def test_force_overwrites_these_seeds_only(command, tmp_path):
    ini, results = finished_run(tmp_path)
    assert command("es", "-f", ini, "-o", results, "-s", 2)[0] == 0
    (results / "notes.txt").write_text("keep")
    (results / ".bestS1.123.npy").write_text("left by a process that was killed")
    (results / "statS1.npy").write_bytes(b"broken")
    before = contents(results)
    assert command("es", "-f", ini, "-o", results, "--force")[0] == 0
    after = contents(results)
    assert {name for name in before if before[name] != after.get(name)} == {
        "statS1.npy",
        ".bestS1.123.npy",
    }


def test_force_with_a_wrong_experiment_removes_nothing(refused, tmp_path):
    ini, results = finished_run(tmp_path)
    before = contents(results)
    for wrong in ("tiny_envs:Tinymakes-v0", "CartPole-v7"):
        write_experiment(tmp_path, wrong)
        refused("es", "-f", ini, "-o", results, "--force")
        assert contents(results) == before


def test_resume_without_anything_to_resume_starts_anew(command, tmp_path):
    ini, results = finished_run(tmp_path)
    assert command("es", "-f", ini, "-o", tmp_path / "new", "--resume")[0] == 0
    assert same(results, tmp_path / "new")


def test_resume_removes_what_a_killed_process_left(command, tmp_path):
    ini, results = finished_run(tmp_path)
    before = contents(results)
    for name in (".statS1.7.npy", ".checkpointS1.12.npz", ".S1.3.fit"):
        (results / name).write_text("half")
    (results / ".statS11.7.npy").write_text("of another run")
    assert command("es", "-f", ini, "-o", results, "--resume")[0] == 0
    (results / ".statS11.7.npy").unlink()
    assert contents(results) == before


# environments that break


BROKEN = {
    "nan": ["a reward of nan at step 1"],
    "inf": ["an observation with NaN or infinity"],
    "none": ["a reward of None at step 1"],
    "vector": ["a reward of [0. 0.] at step 1"],
    "shape": ["an observation [0. 0. 0.]", "observation_space"],
    "text": ["an observation left", "observation_space"],
    "old": ["step 1", "expected 5, got 4", "mend"],
    "raises": ["RuntimeError", "step 1", "the motor is broken", "mend"],
    "exits": ["SystemExit", "step 1", "good bye", "mend"],
    "resets": ["ValueError", "reset", "cannot start", "mend"],
}


def breaks_in_the_middle(fault, says, refused, folder, workers):
    """A run that breaks in generation 4; what was finished before is there, and can go on."""
    ini = write_experiment(folder, f"tiny_envs:Tiny{fault}-v0", saveeach=60)
    name = f"tiny_envs:Tiny{fault}-v0"
    refused("es", "-f", ini, "-o", folder / "r", "-w", workers, says=[name, *says])
    assert np.load(folder / "r" / "statS1.npy").size == 6 * (FAULTY_SEED - 2)
    assert float((folder / "r" / "S1.fit").read_text().split()[-1]) > 0
    np.load(folder / "r" / "bestgS1.npy")
    refused("es", "-f", ini, "-o", folder / "r", "--resume", "-w", workers, says=[name, *says])
    assert np.load(folder / "r" / "statS1.npy").size == 6 * (FAULTY_SEED - 2)


@pytest.mark.parametrize("fault", BROKEN)
def test_an_environment_that_breaks(fault, refused, tmp_path):
    where = [f"of seed {FAULTY_SEED - 1}" if fault == "none" else "of seed"]
    breaks_in_the_middle(fault, BROKEN[fault] + where, refused, tmp_path, workers=1)


@pytest.mark.parametrize("fault", ["nan", "exits"])
def test_an_environment_that_breaks_in_a_worker_process(fault, refused, tmp_path):
    breaks_in_the_middle(fault, BROKEN[fault], refused, tmp_path, workers=2)


def test_workers_that_always_die(refused, tmp_path):
    breaks_in_the_middle("dies", ["died 3 times", "-w 1", "memory"], refused, tmp_path, workers=2)


def test_an_environment_that_breaks_while_it_is_watched(refused, tmp_path):
    ini = write_experiment(tmp_path, "tiny_envs:Tinyresets-v0")
    own = write_experiment(tmp_path / "blind", "tiny_envs:Blind-v0")
    for flags in (["--video", tmp_path / "film.gif"], ["--render", "human"]):
        refused("es", "-f", own, "-p", *flags, says=["draws no pictures", "--render none"])
    assert not list(tmp_path.glob("*film*"))
    assert ini.exists()


def test_discrete_actions_may_start_below_zero(tmp_path):
    assert run_seeds(experiment(tmp_path, "tiny_envs:Tinydiscrete-v0"), tmp_path)


@pytest.mark.parametrize("environment", ["Acrobot-v1", "Pendulum-v1", "ErDpole"])
def test_parameters_without_bound(environment, command, tmp_path):
    """Activations overflow; the run goes on, or stops in a sentence."""
    policy = {"nlayers": 16, "nhiddens": 10, "afunction": 3, "out_type": 3}
    ini = write_experiment(
        tmp_path, environment, "OpenAI-ES", policy, stepsize=1000, noiseStdDev=1000
    )
    code, _, errors = command("es", "-f", ini, "-o", tmp_path / "results")
    if code:
        one_sentence(code, errors, ["seed", "stepsize"])


# watching


def test_watching_without_a_display_prints(command, tmp_path, monkeypatch):
    ini, results = finished_run(tmp_path)
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    code, out, errors = command("es", "-f", ini, "-p", "-g", results / "bestgS1.npy")
    assert (code, errors) == (0, "")
    assert out.count("episode ") == 3
    best = np.load(results / "statS1.npy")[-4]
    assert f"mean {best:.2f}  standard deviation" in out


@pytest.mark.skipif(sys.platform != "linux", reason="other systems always have a display")
def test_a_window_without_a_display(refused, tmp_path, monkeypatch):
    ini = write_experiment(tmp_path)
    for name in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER"):
        monkeypatch.delenv(name, raising=False)
    refused("es", "-f", ini, "-p", "--render", "human", says=["display", "--video"])


def test_videos_that_cannot_be_written(refused, tmp_path):
    ini = write_experiment(tmp_path)
    (tmp_path / "file").touch()
    (tmp_path / "folder.mp4").mkdir()
    for path, says in {
        "film.avi": [".mp4, .webm, .gif"],
        "film": [".mp4, .webm, .gif"],
        "missing/film.mp4": ["there is no folder"],
        "file/film.mp4": ["there is no folder"],
        "folder.mp4": ["is a folder"],
    }.items():
        refused("es", "-f", ini, "-p", "--video", tmp_path / path, says=[tmp_path / path, *says])


# a folder that goes away


def test_a_folder_that_vanishes_in_the_middle(tmp_path):
    own = experiment(tmp_path, saveeach=0)
    folder = tmp_path / "results"
    folder.mkdir()

    def vanish(run):
        if run.record.generation == 3:
            shutil.rmtree(folder)

    with pytest.raises(Exception, match=r"results.* cannot be written .*choose another folder\."):
        evolve(Run(own, 1), folder, report=vanish)
