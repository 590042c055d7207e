"""What stops runs, and runs side by side, do not show in their files."""

import os
import signal
import sys
import time

import numpy as np
import psutil
import pytest

from botschool.evolution.run import Run, evolve
from running import (
    call,
    contents,
    experiment,
    finish,
    run_seeds,
    same,
    start,
    write_experiment,
)


@pytest.mark.parametrize("policy", [{"normalize": 0}, {"normalize": 1, "pepisodes": 2}])
def test_requests_to_stop_at_any_moment_do_not_show(policy, tmp_path):
    own = experiment(tmp_path, "CartPole-v1", "OpenAI-ES", policy, maxmsteps=0.003)
    assert run_seeds(own, tmp_path / "whole")
    for moment in range(12):
        asked = iter(range(moment))
        run = Run(own, 1, stopping=lambda asked=asked: next(asked, None) is None)
        evolve(run, tmp_path / str(moment))
        stat = np.load(tmp_path / str(moment) / "statS1.npy")
        assert stat.size == 6 * run.record.generation
        assert run_seeds(own, tmp_path / str(moment), resume=True)
        assert same(tmp_path / "whole", tmp_path / str(moment))


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
