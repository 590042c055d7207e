"""A run is a pure function of experiment and seed: workers, instruction sets, stops and kills do
not show in its files. Compared are all files, bit for bit, but for TensorBoard's event files."""

import os
import random
import signal
import sys

import numpy as np
import psutil
import pytest

from botschool import _core
from botschool.evolution.run import Run, evolve
from botschool.problems import native
from running import (
    ALGORITHMS,
    contents,
    environment_of_command,
    experiment,
    finish,
    run_seeds,
    same,
    start,
    write_experiment,
)
from tiny_envs import DIE_ONCE

NATIVE = ("CartPole-v1", "Pendulum-v1", "Acrobot-v1", "ErDpole", "ErDiscrim", "ErPredprey")
TINY = "tiny_envs:Tiny-v0"
SLOW_TINY = pytest.param(TINY, marks=pytest.mark.slow)  # another process tries whether it repeats
EVERY = pytest.mark.parametrize("step", [4, pytest.param(1, marks=pytest.mark.long)])
"""Each fourth moment, or all of them."""
NORMALISED = {"normalize": 1, "clip": 1, "bias": 1, "action_noise": 1}
posix = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")


def small(folder, environment, algo, **options):
    """A very small experiment; two robots have an LSTM each."""
    two = {"nrobots": 2, "heterogeneous": 1, "architecture": 3}
    policy = NORMALISED | (two if environment == "ErPredprey" else {})
    return experiment(folder, environment, algo, policy, **options)


# workers and instruction sets


@pytest.mark.parametrize("algo", ALGORITHMS)
@pytest.mark.parametrize("environment", NATIVE)
def test_threads_do_not_show(environment, algo, tmp_path):
    own = small(tmp_path, environment, algo, maxmsteps=0.03)
    for workers in (1, 2, 5):
        assert run_seeds(own, tmp_path / str(workers), workers=workers)
    assert same(tmp_path / "1", tmp_path / "2")
    assert same(tmp_path / "1", tmp_path / "5")


@pytest.mark.slow
def test_worker_processes_do_not_show(tmp_path):
    """SSS with 2 processes, OpenAI-ES with 5; both against none."""
    for algo, workers in (("SSS", 2), ("OpenAI-ES", 5)):
        own = small(tmp_path, TINY, algo, maxmsteps=0.003)
        assert run_seeds(own, tmp_path / f"{algo}-1")
        assert run_seeds(own, tmp_path / f"{algo}-{workers}", workers=workers)
        assert same(tmp_path / f"{algo}-1", tmp_path / f"{algo}-{workers}")


@pytest.mark.parametrize("algo", ALGORITHMS)
@pytest.mark.parametrize("environment", NATIVE)
def test_instruction_sets_do_not_show(environment, algo, tmp_path):
    sets = _core.instruction_sets()
    for chosen in sets:
        run = Run(small(tmp_path, environment, algo, maxmsteps=0.02), 1)
        run.problem = native.NativeProblem(environment, instruction_set=chosen)
        run.evaluator.problem = run.problem
        (tmp_path / chosen).mkdir()
        assert evolve(run, tmp_path / chosen)
    for chosen in sets[1:]:
        assert same(tmp_path / sets[0], tmp_path / chosen)


@pytest.mark.slow
def test_a_worker_killed_in_the_middle_does_not_show(tmp_path, monkeypatch):
    own = small(tmp_path, TINY, "OpenAI-ES", maxmsteps=0.002)
    assert run_seeds(own, tmp_path / "undisturbed")
    for worker_deaths in range(1, 3):
        mark = tmp_path / "die"
        mark.touch()
        monkeypatch.setenv(DIE_ONCE, str(mark))
        folder = tmp_path / f"disturbed {worker_deaths}"
        assert run_seeds(own, folder, workers=2)
        assert not mark.exists(), "no worker has died"
        assert same(tmp_path / "undisturbed", folder)


# stops that were asked for


@pytest.mark.parametrize("algo", ALGORITHMS)
@pytest.mark.parametrize("environment", ["CartPole-v1", "ErDiscrim", "ErPredprey", SLOW_TINY])
def test_stopping_after_some_steps_does_not_show(environment, algo, tmp_path):
    own = small(tmp_path, environment, algo, maxmsteps=0.004)
    assert run_seeds(own, tmp_path / "whole")
    for steps in (1, 700, 1500, 1500, 1501, 2500):
        assert run_seeds(own, tmp_path / "parts", steps=steps, resume=True)
    assert contents(tmp_path / "parts") != contents(tmp_path / "whole")
    assert run_seeds(own, tmp_path / "parts", resume=True)
    assert same(tmp_path / "whole", tmp_path / "parts")
    assert run_seeds(own, tmp_path / "parts", resume=True)
    assert same(tmp_path / "whole", tmp_path / "parts")


@pytest.mark.parametrize("algo", ALGORITHMS)
def test_going_on_with_a_longer_run_does_not_show(algo, tmp_path):
    for maxmsteps in (0.002, 0.004):
        own = small(tmp_path, "CartPole-v1", algo, maxmsteps=maxmsteps)
        assert run_seeds(own, tmp_path / "parts", resume=True)
    assert run_seeds(own, tmp_path / "whole")
    assert same(tmp_path / "whole", tmp_path / "parts")


@pytest.mark.slow
@EVERY
@pytest.mark.parametrize("algo", ALGORITHMS)
def test_a_request_to_stop_at_any_moment_does_not_show(algo, step, tmp_path):
    """Before each episode, in evaluations and in post-evaluations."""
    own = small(tmp_path, TINY, algo, maxmsteps=0.001)
    assert run_seeds(own, tmp_path / "whole")
    # what is collected in the first generation makes the second one differ if it is lost
    for moment in range(1, 45, 2 * step):
        asked = 0

        def stopping(moment=moment):
            nonlocal asked
            asked += 1
            return asked > moment

        folder = tmp_path / str(moment)
        folder.mkdir()
        assert not evolve(Run(own, 1, stopping=stopping), folder)
        assert evolve(Run(own, 1), folder, resume=True)
        assert same(tmp_path / "whole", folder)


# stops that were not


class Killed(BaseException):
    """Stands for a kill: nothing handles it."""


@pytest.mark.slow
@EVERY
@pytest.mark.parametrize("algo", ALGORITHMS)
def test_a_kill_at_any_file_operation_does_not_show(algo, step, tmp_path, monkeypatch):
    own = small(tmp_path, "CartPole-v1", algo, maxmsteps=0.001, saveeach=0)
    assert run_seeds(own, tmp_path / "whole")
    operations = {name: getattr(os, name) for name in ("replace", "fsync", "unlink")}
    for deadly in range(ALGORITHMS.index(algo), 40, step):
        done = 0

        def patched(name):
            def operation(*arguments, **options):
                nonlocal done
                done += 1
                if done > deadly:  # noqa: B023
                    raise Killed
                return operations[name](*arguments, **options)

            return operation

        with monkeypatch.context() as patch:
            for name in operations:
                patch.setattr(os, name, patched(name))
            with pytest.raises(Killed):
                run_seeds(own, tmp_path / str(deadly))
        assert run_seeds(own, tmp_path / str(deadly), resume=True)
        assert same(tmp_path / "whole", tmp_path / str(deadly))


def command_of(ini, folder, *more):
    return ("es", "-f", ini, "-s", 3, "-o", folder, "--resume", *more)


def steps_done(folder):
    return int(np.load(folder / "statS3.npy")[-6])


@pytest.mark.slow
@posix
@EVERY
@pytest.mark.parametrize("algo", ALGORITHMS)
def test_many_kills_do_not_show(algo, step, tmp_path):
    """A few, or ten of each algorithm, by kill -9, at random moments of the real command."""
    chance = random.Random(algo)
    own = experiment(tmp_path, "CartPole-v1", algo, NORMALISED, maxmsteps=1000, saveeach=0)
    command = command_of(tmp_path / "own.ini", tmp_path / "killed")
    for _ in range(0, 10, step):
        process = start(*command)
        for _ in range(chance.randint(0, 5)):
            process.stdout.readline()
        for _ in range(chance.randint(0, 200)):
            process.poll()
        process.kill()
        code, _, errors = finish(process)
        assert (code, errors) == (-signal.SIGKILL, "")
    steps = steps_done(tmp_path / "killed") + 500
    code, _, errors = finish(start(*command, "--steps", steps))
    assert (code, errors) == (0, "")
    assert run_seeds(own, tmp_path / "undisturbed", [3], steps=steps)
    assert same(tmp_path / "undisturbed", tmp_path / "killed")


@pytest.mark.slow
@posix
def test_kills_with_worker_processes_do_not_show_and_leave_none_behind(tmp_path):
    own = experiment(tmp_path, TINY, "OpenAI-ES", NORMALISED, maxmsteps=1, saveeach=0)
    for generations in (2, 5):
        process = start(*command_of(tmp_path / "own.ini", tmp_path / "killed", "-w", 2))
        for _ in range(generations):
            assert process.stdout.readline()
        workers = psutil.Process(process.pid).children(recursive=True)
        assert len(workers) >= 2
        process.kill()
        assert finish(process)[0] == -signal.SIGKILL
        alive = psutil.wait_procs(workers, timeout=30)[1]
        assert not [w for w in alive if w.status() != psutil.STATUS_ZOMBIE]
    steps = steps_done(tmp_path / "killed") + 500
    assert run_seeds(own, tmp_path / "killed", [3], steps=steps, resume=True)
    assert run_seeds(own, tmp_path / "undisturbed", [3], steps=steps)
    assert same(tmp_path / "undisturbed", tmp_path / "killed")


@pytest.mark.slow
@posix
@pytest.mark.parametrize("whom", ["the command", "all its processes"])
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=["Ctrl-C", "SIGTERM"])
@pytest.mark.parametrize(("environment", "workers"), [("CartPole-v1", 2), (TINY, 2)])
def test_ctrl_c_saves_and_does_not_show(environment, workers, number, whom, tmp_path):
    """The checkpoint is only written when it stops: saveeach is an hour."""
    if environment == "CartPole-v1" and whom != "the command":
        pytest.skip("it has one process")
    own = experiment(tmp_path, environment, "SSS", NORMALISED, maxmsteps=1000)
    process = start(
        *command_of(tmp_path / "own.ini", tmp_path / "stopped", "-w", workers),
        start_new_session=True,
    )
    for _ in range(4):
        assert process.stdout.readline().startswith("seed 3  generation")
    if whom == "the command":
        process.send_signal(number)
    else:
        os.killpg(process.pid, number)
    code, out, errors = finish(process)
    assert (code, errors) == (130, "")
    assert "all is saved, add --resume to the same command to continue" in out
    stat = np.load(tmp_path / "stopped" / "statS3.npy").reshape(-1, 6)
    assert len(stat) >= 4 and stat[-1, 0] < 1e9
    assert f"stopped after {len(stat)} generations" in out
    steps = int(stat[-1, 0]) + 500
    assert run_seeds(own, tmp_path / "stopped", [3], steps=steps, resume=True)
    assert run_seeds(own, tmp_path / "undisturbed", [3], steps=steps)
    assert same(tmp_path / "undisturbed", tmp_path / "stopped")


@pytest.mark.slow
@posix
def test_workers_never_hear_ctrl_c(tmp_path):
    """Not even while they start, when Python's own handler would end them with a traceback."""
    write_experiment(tmp_path, TINY, "SSS", maxmsteps=0.005)
    process = start(*command_of(tmp_path / "own.ini", tmp_path / "results", "-w", 2))
    main = psutil.Process(process.pid)
    while len(main.children()) < 3:
        assert process.poll() is None
    workers = main.children()
    for _ in range(20):
        for worker in workers:
            worker.send_signal(signal.SIGINT)
    assert process.stdout.readline().startswith("seed 3  generation 1")
    assert all(worker.is_running() for worker in workers)
    code, _, errors = finish(process)
    assert (code, errors) == (0, "")


@pytest.mark.slow
@posix
def test_a_second_ctrl_c_ends_at_once_and_harms_nothing(tmp_path):
    own = experiment(tmp_path, TINY, "SSS", NORMALISED, maxmsteps=1, saveeach=0)
    process = start(*command_of(tmp_path / "own.ini", tmp_path / "stopped"))
    for _ in range(3):
        process.stdout.readline()
    for _ in range(20):
        process.send_signal(signal.SIGINT)
    code, _, errors = finish(process)
    assert code == 130
    assert "Traceback" not in errors
    steps = steps_done(tmp_path / "stopped") + 500
    assert run_seeds(own, tmp_path / "stopped", [3], steps=steps, resume=True)
    assert run_seeds(own, tmp_path / "undisturbed", [3], steps=steps)
    assert same(tmp_path / "undisturbed", tmp_path / "stopped")


@pytest.mark.slow
@posix
def test_a_run_whose_reader_has_gone_is_saved(tmp_path):
    """botschool es ... | head -2"""
    own = experiment(tmp_path, "CartPole-v1", "SSS", NORMALISED, maxmsteps=0.5)
    process = start(*command_of(tmp_path / "own.ini", tmp_path / "piped"))
    process.stdout.readline()
    process.stdout.close()
    errors = process.stderr.read()
    assert process.wait() == 1
    assert errors == ""
    assert run_seeds(own, tmp_path / "piped", [3], resume=True)
    assert run_seeds(own, tmp_path / "undisturbed", [3])
    assert same(tmp_path / "undisturbed", tmp_path / "piped")


@pytest.mark.slow
def test_the_working_folder_and_the_environment_do_not_show(tmp_path):
    """Hash seeds, thread counts of libraries and locales are the machine's affair."""
    own = experiment(tmp_path, "Pendulum-v1", "OpenAI-ES", NORMALISED, maxmsteps=0.01)
    assert run_seeds(own, tmp_path / "here", [3])
    variables = environment_of_command(PYTHONHASHSEED="5", OMP_NUM_THREADS="1", LC_ALL="C")
    process = start("es", "-f", "own.ini", "-s", 3, "-o", "there", cwd=tmp_path, env=variables)
    assert finish(process)[0] == 0
    assert same(tmp_path / "here", tmp_path / "there")
