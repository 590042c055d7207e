"""Environments that break in the middle of a run: one sentence, and what was finished is there."""

import itertools
import multiprocessing
import threading

import numpy as np
import pytest

from botschool.evolution.run import Run
from botschool.problems.base import Interrupted
from running import (
    TESTS,
    call,
    environment_of_command,
    experiment,
    one_sentence,
    run_seeds,
    write_experiment,
)
from tiny_envs import FAULTY_SEED

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
    says = [*BROKEN[fault], f"episode 1 of seed {FAULTY_SEED - 1}"]
    breaks_in_the_middle(fault, says, refused, tmp_path, workers=1)


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
        code, _, errors = call(
            "es", "-f", ini, "-o", tmp_path / module, "-w", "2", cwd=tmp_path, env=environment
        )
        said = [line for line in errors.splitlines() if "present folder" in line]
        assert code == 0
        assert [line.partition(":")[0] for line in said] == (
            [f"{module} is taken from the present folder"] if place else []
        )
        assert all(str(tmp_path / place) in line for line in said)
