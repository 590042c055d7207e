"""Faults of the user and of experiment files: one sentence and exit code 2, and nothing is lost."""

import itertools
import multiprocessing
import shutil
import subprocess
import sys
import threading

import numpy as np
import pytest

from botschool.evolution.run import Run
from botschool.problems.base import Interrupted
from running import (
    TESTS,
    contents,
    environment_of_command,
    experiment,
    finish,
    finished_run,
    start,
    write_experiment,
)
from tiny_envs import FAULTY_SEED

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
        ("rl trian", ["'trian'; did you mean 'train'? See ", "botschool rl --help."]),
        ("es --stepz 3", ["; did you mean ", "'--steps'? See ", "botschool es --help."]),
        ("es -f own.ini --resume --force", ["--resume", "--force"]),
        ("es -f own.ini -p --render cinema", ["cinema", "human", "none"]),
    ],
)
def test_wrong_arguments(arguments, says, refused, tmp_path, monkeypatch):
    write_experiment(tmp_path)
    monkeypatch.chdir(tmp_path)
    refused(*arguments.split(), says=says)
    assert [path.name for path in tmp_path.iterdir()] == ["own.ini"]


@pytest.mark.slow
def test_help_loads_nothing_heavy():
    heavy = {"matplotlib", "gymnasium", "torch", "pybullet", "numpy", "tensorboard", "pygame"}
    program = (
        "import sys\nsys.argv = ['botschool', 'es', '--help']\n"
        "from botschool.cli import main\n"
        "try:\n    main()\n"
        "except SystemExit as end:\n    assert not end.code\n"
        "print(*sys.modules, file=sys.stderr)\n"
    )
    process = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert "Example: botschool es -f" in process.stdout
    assert not heavy & set(process.stderr.split())


# experiment files


@pytest.mark.parametrize(
    ("line", "changed", "says"),
    [
        ("nhiddens = 3", "nhiddens = -1", ["line 8", "nhiddens = -1", "0 to 10000"]),
        ("[POLICY]", "", ["[POLICY]"]),
        ("[ALGO]", "[ALGOS]", ["[ALGOS]", "[ALGO]"]),
        ("nhiddens = 3", "nhiddens = 3\nnrobots = 2", ["nrobots"]),
        ("nhiddens = 3", "nhiddens = 3\nnbins = 5", ["nbins = 1"]),
    ],
)
def test_wrong_experiments(line, changed, says, refused, tmp_path):
    """Every other sentence: test_config.py."""
    ini = write_experiment(tmp_path)
    text = ini.read_text()
    assert line in text
    ini.write_text(text.replace(line, changed))
    refused("es", "-f", ini, "-o", tmp_path / "results", says=says)
    assert not (tmp_path / "results").exists()


@pytest.mark.parametrize(
    ("environment", "says"),
    [
        ("CartPol-v1", "did you mean CartPole-v1?"),
        ("ErDpol", "did you mean ErDpole?"),
        ("Walk-on-water-v0", "is the package that has it installed?"),
        ("tiny_envs:Tyny-v0", "did you mean tiny_envs:Tiny-v0?"),
        ("tyny_envs:Tiny-v0", "tyny_envs"),
        ("ErPredprey", "set nrobots = 2"),
        ("a/b/c-v0", "Malformed"),
        ("LunarLander-v2", "LunarLander-v3"),
        ("tiny_envs:Tinypackage-v0", "a_package_that_is_not_there"),
        ("tiny_envs:Tinymakes-v0", "no licence"),
        ("tiny_envs:Tinywords-v0", ["observations are a Text space", "policies read numbers"]),
        ("tiny_envs:Tinylarge-v0", ["30603 values", "at most 30000", "ResizeObservation"]),
        ("tiny_envs:Tinysequence-v0", ["actions are a Sequence space", "MultiBinary"]),
    ],
)
@pytest.mark.filterwarnings("ignore")
def test_environments_that_cannot_be_evolved(environment, says, refused, tmp_path):
    ini = write_experiment(tmp_path, environment)
    refused("es", "-f", ini, "-o", tmp_path / "new", says=says)
    assert not (tmp_path / "new").exists()


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


# --- Environments that break in the middle of a run: one sentence, and what was finished is there.


BROKEN = {
    "nan": ["a reward of nan at step 1"],
    "inf": ["an observation with NaN or infinity"],
    "none": ["a reward of None (NoneType, not a number) at step 1"],
    "vector": ["a reward of [0. 0.] (ndarray, not a number) at step 1"],
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
    says = [*BROKEN[fault], f"episode 1 of seed {FAULTY_SEED - 1}"]
    breaks_in_the_middle(fault, says, refused, tmp_path, workers=1)


@pytest.mark.slow
@pytest.mark.parametrize("fault", ["nan", "exits"])
def test_an_environment_that_breaks_in_a_worker_process(fault, refused, tmp_path):
    breaks_in_the_middle(fault, BROKEN[fault], refused, tmp_path, workers=2)


@pytest.mark.slow
def test_workers_that_always_die(refused, tmp_path):
    breaks_in_the_middle("dies", ["died 3 times", "-w 1", "memory"], refused, tmp_path, workers=2)


def test_a_stopped_batch_leaves_no_process_and_no_thread(tmp_path):
    """A thread of the pool that is just ending makes CPython's own ending fail, now and then."""
    own = experiment(tmp_path, "tiny_envs:Tiny-v0")
    before = threading.active_count()
    asked = itertools.count()
    run = Run(own, 1, workers=2, stopping=lambda: next(asked) > 0)
    with pytest.raises(Interrupted):
        for _ in range(1000):
            run.advance()
    assert threading.active_count() == before
    assert not multiprocessing.active_children()


@pytest.mark.slow
def test_a_module_in_the_present_folder_is_named(tmp_path):
    """Once, whatever number of environments and worker processes; not one from elsewhere."""
    (tmp_path / "own_envs.py").write_text("from tiny_envs import *\n")
    (tmp_path / "own_package").mkdir()
    (tmp_path / "own_package" / "__init__.py").write_text("")
    (tmp_path / "own_package" / "envs.py").write_text("from tiny_envs import *\n")
    environment = environment_of_command() | {"PYTHONPATH": str(TESTS)}
    for module, place in (("own_envs", "own_envs.py"), ("own_package.envs", "own_package"),
                          ("tiny_envs", None)):  # fmt: skip
        ini = write_experiment(tmp_path / module, f"{module}:Tiny-v0")
        arguments = "es", "-f", ini, "-o", tmp_path / module, "-w", "2"
        code, _, errors = finish(start(*arguments, cwd=tmp_path, env=environment))
        said = [line for line in errors.splitlines() if "present folder" in line]
        assert code == 0
        assert [line.partition(":")[0] for line in said] == (
            [f"{module} is taken from the present folder"] if place else []
        )
        assert all(str(tmp_path / place) in line for line in said)


def test_a_module_of_pythons_own_is_not_called_one_of_the_present_folder(refused, tmp_path):
    for module in ("os", "sys", "zipimport"):  # frozen, built in, both
        said = refused("es", "-f", write_experiment(tmp_path / module, f"{module}:system"), "-s", 1)
        assert "present folder" not in said
