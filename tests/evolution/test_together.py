"""What makes runs fast does not show in their files: a post-evaluation that waits for the next
generation's candidates, and runs side by side."""

import os
import signal
import sys
import time

import numpy as np
import psutil
import pytest

from botschool.errors import BotschoolError
from botschool.evolution.progress import messages
from botschool.evolution.run import Run, evolve
from running import (
    ALGORITHMS,
    call,
    contents,
    experiment,
    finish,
    run_seeds,
    same,
    start,
    write_experiment,
)

POLICY = ({"normalize": 0}, {"normalize": 1, "clip": 1, "pepisodes": 2})
each = pytest.mark.parametrize("policy", POLICY, ids=("plain", "normalised"))
algorithms = pytest.mark.parametrize("algo", ALGORITHMS)


def evolved(own, folder, together=True, limit=None, resume=False, **more):
    """Evolves seed 1 and gives the run."""
    folder.mkdir(parents=True, exist_ok=True)
    run = Run(own, 1)
    run.together = together
    evolve(run, folder, generations=limit, resume=resume, **more)
    return run


def calls(run):
    """Counts the calls of a run's problem, in a list of one number."""
    count, evaluate = [0], run.problem.evaluate

    def counting(*arguments):
        count[0] += 1
        return evaluate(*arguments)

    run.problem.evaluate = counting
    return count


# post-evaluations that wait


@each
@algorithms
def test_together_is_as_apart(algo, policy, tmp_path):
    own = experiment(tmp_path, "CartPole-v1", algo, policy, maxmsteps=0.02)
    lines = {True: [], False: []}
    for together in lines:
        with messages(False, lines[together].extend) as report:
            evolved(own, tmp_path / str(together), together, report=report)
    assert same(tmp_path / "True", tmp_path / "False")
    assert lines[True] == lines[False]
    assert len(lines[True]) == len(np.load(tmp_path / "True" / "statS1.npy")) / 6 > 5


@each
def test_most_generations_take_one_evaluation(policy, tmp_path):
    """Else the tests above would compare equal with equal."""
    own = experiment(tmp_path, "CartPole-v1", "SSS", policy, maxmsteps=0.02)
    run = Run(own, 1)
    count = calls(run)
    evolve(run, tmp_path)
    generations = run.record.generation
    # of normalised runs, those that collect nothing wait: 1 % of 12 episodes in each
    assert generations < count[0] < 1.3 * generations


def test_generations_that_are_saved_one_by_one_do_not_wait(tmp_path):
    own = experiment(tmp_path, saveeach=0)
    run = Run(own, 1)
    count = calls(run)
    evolve(run, tmp_path)
    assert count[0] == 2 * run.record.generation + 1  # fresh episodes at the end


@pytest.mark.slow
@each
@algorithms
def test_stops_after_every_generation_do_not_show(algo, policy, tmp_path):
    own = experiment(tmp_path, "CartPole-v1", algo, policy, maxmsteps=0.01)
    whole = evolved(own, tmp_path / "whole", together=False).record.generation
    for generation in range(1, whole + 2):
        run = evolved(own, tmp_path / "parts", limit=generation, resume=True)
        assert run.record.generation == min(generation, whole)
    assert same(tmp_path / "whole", tmp_path / "parts")


@pytest.mark.slow
@each
def test_requests_to_stop_at_any_moment_do_not_show(policy, tmp_path):
    own = experiment(tmp_path, "CartPole-v1", "OpenAI-ES", policy, maxmsteps=0.005)
    evolved(own, tmp_path / "whole", together=False)
    for moment in range(20):
        asked = 0

        def stopping(moment=moment):
            nonlocal asked
            asked += 1
            return asked > moment

        folder = tmp_path / str(moment)
        folder.mkdir()
        run = Run(own, 1, stopping=stopping)
        evolve(run, folder)
        assert np.load(folder / "statS1.npy").size == 6 * run.record.generation
        evolved(own, folder, resume=True)
        assert same(tmp_path / "whole", folder)


@each
@pytest.mark.parametrize("broken", range(2, 9))
def test_an_evaluation_that_fails_leaves_the_generations_before(policy, broken, tmp_path):
    """Once, or whatever is evaluated from then on."""
    own = experiment(tmp_path, "CartPole-v1", "OpenAI-ES", policy, maxmsteps=0.01)
    evolved(own, tmp_path / "whole", together=False)
    for once in (True, False):
        folder = tmp_path / str(once)
        folder.mkdir()
        run = Run(own, 1)
        evaluate, count = run.problem.evaluate, 0

        def failing(*arguments, evaluate=evaluate, once=once):
            nonlocal count
            count += 1
            if count == broken or (count > broken and not once):
                raise BotschoolError("It is broken.")
            return evaluate(*arguments)

        run.problem.evaluate = failing
        with pytest.raises(BotschoolError, match="broken"):
            evolve(run, folder)
        assert np.load(folder / "statS1.npy").size == 6 * run.record.generation
        evolved(own, folder, resume=True)
        assert same(tmp_path / "whole", folder)


def test_a_generation_asked_for_by_itself_is_whole(tmp_path):
    run = Run(experiment(tmp_path), 1)
    for generation in range(1, 4):
        run.advance()
        assert run.record.generation == generation


# runs side by side


@pytest.mark.slow
@pytest.mark.parametrize("workers", [2, 3, 7])
def test_runs_side_by_side_are_as_one_after_another(workers, tmp_path, capsys):
    own = experiment(tmp_path, "CartPole-v1", "OpenAI-ES", maxmsteps=0.02)
    assert run_seeds(own, tmp_path / "1", range(3, 6))
    alone = capsys.readouterr().out.splitlines()
    assert run_seeds(own, tmp_path / "2", range(3, 6), workers)
    beside = capsys.readouterr().out.replace(str(tmp_path / "2"), str(tmp_path / "1")).splitlines()
    assert same(tmp_path / "1", tmp_path / "2")
    assert sorted(alone) == sorted(beside)
    for seed in range(3, 6):  # of each in order
        assert [line for line in alone if line.startswith(f"seed {seed}")] == [
            line for line in beside if line.startswith(f"seed {seed}")
        ]


@pytest.mark.slow
def test_a_run_that_fails_stops_the_others_and_all_is_saved(tmp_path):
    ini = write_experiment(tmp_path, "CartPole-v1", "OpenAI-ES", maxmsteps=1000)
    (tmp_path / "results").mkdir()
    (tmp_path / "results" / "checkpointS2.npz").write_text("no checkpoint")
    arguments = ["-n", 3, "-w", 2, "-o", tmp_path / "results", "--resume"]
    code, out, errors = call("es", "-f", ini, *arguments)
    assert code == 2
    assert errors.count("\n") == 1 and "checkpointS2.npz is not a complete checkpoint" in errors
    assert "seed 1: stopped after" in out and "seed 3" not in out
    assert np.load(tmp_path / "results" / "statS1.npy").size % 6 == 0
    assert not (tmp_path / "results" / "statS3.npy").exists()


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_runs_side_by_side_that_are_stopped_go_on(number, tmp_path):
    results = tmp_path / "results"
    ini = write_experiment(tmp_path, "CartPole-v1", "OpenAI-ES", maxmsteps=1000)
    arguments = ["es", "-f", ini, "-n", 2, "-w", 2, "-o", results]
    process = start(*arguments, start_new_session=True)
    begun = set()
    while len(begun) < 2:  # one of them may be slow to begin
        assert process.poll() is None
        line = process.stdout.readline()
        if "generation 20 " in line:
            begun.add(line.partition("generation")[0])
    # a terminal sends it to all processes at once
    os.killpg(process.pid, number)
    code, out, errors = finish(process)
    assert (code, errors) == (130, "")
    assert out.count("stopped after") == 2
    before = contents(results)
    steps = max(np.load(results / f"statS{seed}.npy")[-6] for seed in (1, 2))
    length = {"maxmsteps": steps / 1e6 + 0.05}
    write_experiment(tmp_path, "CartPole-v1", "OpenAI-ES", **length)
    assert call(*arguments, "--resume")[0] == 0
    assert contents(results) != before
    own = experiment(tmp_path, "CartPole-v1", "OpenAI-ES", **length)
    assert run_seeds(own, tmp_path / "whole", [1, 2])
    assert same(tmp_path / "whole", results)


@pytest.mark.slow
def test_a_process_that_dies_is_told_in_a_sentence(tmp_path):
    ini = write_experiment(tmp_path, "CartPole-v1", "OpenAI-ES", maxmsteps=1000)
    process = start("es", "-f", ini, "-n", 2, "-w", 2, "-o", tmp_path / "results")
    while "generation 20 " not in (line := process.stdout.readline()):
        assert process.poll() is None
    # the eldest of those that evolve: its command line is that of multiprocessing
    children = psutil.Process(process.pid).children()
    workers = [child for child in children if "spawn_main" in " ".join(child.cmdline())]
    assert len(workers) == 2 and line.startswith("seed")
    workers[0].kill()
    code, out, errors = finish(process)
    assert code == 2
    assert errors.count("\n") == 1 and "seed 1 ended unexpectedly" in errors
    assert "seed 2: stopped after" in out


@pytest.mark.slow
def test_a_killed_command_leaves_no_processes(tmp_path):
    ini = write_experiment(tmp_path, "CartPole-v1", "OpenAI-ES", maxmsteps=1000)
    process = start("es", "-f", ini, "-n", 2, "-w", 2, "-o", tmp_path / "results")
    while "generation 20 " not in process.stdout.readline():
        assert process.poll() is None
    children = psutil.Process(process.pid).children()
    process.kill()
    process.communicate()
    deadline = time.monotonic() + 30
    while any(child.is_running() and child.status() != "zombie" for child in children):
        assert time.monotonic() < deadline
        time.sleep(0.05)
