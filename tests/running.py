"""Helpers for tests of whole runs: experiment files, the command, and the files of a run."""

import atexit
import multiprocessing
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from botschool import cli, config
from botschool.evolution.replicate import replicate
from botschool.evolution.run import Options

SENTENCE = re.compile(r"error: \S[^\n]*[.?]\n")
TESTS = Path(__file__).parent
FORKS = multiprocessing.get_context("forkserver") if sys.platform == "linux" else None
if FORKS is not None:
    FORKS.set_forkserver_preload(
        ["botschool.cli.app", "botschool.grading.commands", "botschool.evolution.run"]
    )
ALGORITHMS = ("SSS", "OpenAI-ES")
POPULATION = {
    "SSS": {"popsize": 6, "mutrate": 0.2},
    "OpenAI-ES": {"samplesize": 3},
    "ARS": {"samplesize": 3},
}


def write_experiment(folder, environment="CartPole-v1", algo="SSS", policy=None, **algorithm):
    """Write FOLDER/own.ini, a very small experiment changed by the arguments; return its path."""
    policy = {"episodes": 2, "pepisodes": 3, "maxsteps": 60, "nhiddens": 3} | (policy or {})
    algorithm = {"maxmsteps": 0.005, "saveeach": 60} | POPULATION.get(algo, {}) | algorithm
    lines = ["[EXP]", f"environment = {environment}", f"algo = {algo}", "[POLICY]"]
    lines += [f"{key} = {value}" for key, value in policy.items()]
    lines += ["[ALGO]", *(f"{key} = {value}" for key, value in algorithm.items())]
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "own.ini"
    path.write_text("\n".join(lines) + "\n")
    return path


def experiment(folder, *arguments, **options):
    """Return the experiment of write_experiment."""
    return config.load(write_experiment(folder, *arguments, **options))


def run_seeds(experiment, folder, seeds=(1,), workers=1, steps=None, resume=False, force=False):
    """Run the seeds as `botschool es` does; return whether all runs finished."""
    folder.mkdir(parents=True, exist_ok=True)
    options = Options(workers=workers, steps=steps, resume=resume, force=force)
    return replicate(experiment, list(seeds), folder, options)


def finished_run(folder, environment="CartPole-v1", algo="SSS", normalize=1, **options):
    """Make a run with seed 1 of FOLDER/own.ini in FOLDER/results."""
    own = experiment(folder, environment, algo, {"normalize": normalize}, **options)
    assert run_seeds(own, folder / "results")
    return folder / "own.ini", folder / "results"


def contents(folder):
    """Return the files of runs in a folder without event files: {name: bytes}.

    A checkpoint gives an entry for each of its arrays.
    """
    found = {}
    for path in sorted(folder.iterdir()):
        if path.name.startswith("tensorboard") or path.suffix in (".ini", ".npz", ".html"):
            continue
        found[path.name] = path.read_bytes()
    for path in folder.glob("*.npz"):
        with np.load(path, allow_pickle=False) as arrays:
            for name, array in arrays.items():
                found[f"{path.name}:{name}"] = array.tobytes() + str(array.dtype).encode()
    return found


def same(folder, other):
    """Return whether two folders hold the same results, bit for bit; print the
    files that differ.
    """
    one, two = contents(folder), contents(other)
    differing = [name for name in sorted(one.keys() | two.keys()) if one.get(name) != two.get(name)]
    assert one and not differing, f"{differing} differ between {folder} and {other}"
    return True


def environment_of_command(**variables):
    """Return the variables of the command's process, which finds tiny_envs from every folder."""
    paths = [str(TESTS), *filter(None, [os.environ.get("PYTHONPATH")])]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(paths), **variables}


def start(*arguments, **options):
    """Start `python -m botschool ARGUMENTS` as a process with its outputs as text pipes."""
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True} | options
    options.setdefault("env", environment_of_command())
    command = [sys.executable, "-m", "botschool", *map(str, arguments)]
    return subprocess.Popen(command, **options)


def finish(process, timeout=120):
    """Wait for the process; return (exit code, standard output, standard error)."""
    out, errors = process.communicate(timeout=timeout)
    return process.returncode, out, errors


def call(*arguments, cwd=None, env=None):
    """Run the command; return (exit code, standard output, standard error).

    The process is a fork of one that has imported the command: an import takes a second.
    """
    if FORKS is None:
        return finish(start(*arguments, cwd=cwd, env=env or environment_of_command()))
    with tempfile.TemporaryDirectory() as folder:
        places = [Path(folder) / name for name in ("out", "errors")]
        given = [*map(str, arguments)], cwd or os.getcwd(), env or environment_of_command(), places
        process = FORKS.Process(target=_command, args=given)
        process.start()
        process.join(120)
        if process.exitcode is None:
            process.kill()
            raise TimeoutError(f"botschool {' '.join(given[0])} has not ended")
        return process.exitcode, *(place.read_text(encoding="utf-8") for place in places)


def _command(arguments, folder, variables, places):
    """Run the command in this process, which is new."""
    os.environ.clear()
    os.environ.update(variables)
    sys.path[:0] = variables["PYTHONPATH"].split(os.pathsep)
    os.chdir(folder)
    for number, place in enumerate(places, start=1):
        os.dup2(os.open(place, os.O_WRONLY | os.O_CREAT | os.O_APPEND), number)
    sys.stdout, sys.stderr = (os.fdopen(number, "w", encoding="utf-8") for number in (1, 2))
    sys.argv = ["botschool", *arguments]
    try:
        cli.main()
    finally:
        atexit._run_exitfuncs()


def one_sentence(code, errors, says=()):
    """Assert that the command refused in one sentence on stderr that contains these words."""
    assert code == 2, errors
    assert SENTENCE.fullmatch(errors), errors
    for word in [says] if isinstance(says, str) else says:
        assert str(word) in errors
