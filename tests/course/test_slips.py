"""Prove that each slip in a solution (slips.py) loses points of its task.

equal.txt names the slips that change no answer. `pytest -m course -k ex08` tries all slips of
an exercise, and `make test` a sample. Tasks that may take long are left out.
"""

import hashlib
import importlib
import time
import warnings

import pytest

import building
from botschool.grading.declare.exercise import missing_packages
from direct import SECONDS, DirectOurs, problem
from slips import slips

SAMPLE = 6
"""Slips of an exercise in the sample."""


def tries(number):
    """(task, label, text, processor seconds to try it) of all slips in quick tasks."""
    loaded = building.exercise(number)
    if missing_packages(loaded.extras):
        return []
    for name in loaded.imports:  # an alarm must not cut an import short
        importlib.import_module(name)
    solution = loaded.known.solution
    loaded.ours = DirectOurs(solution)
    found = []
    for task in loaded.tasks:
        if task.seconds <= building.QUICK:
            began = time.process_time()
            assert not problem(task, solution, 60)  # else each slip would seem caught
            seconds = SECONDS + 2 * (time.process_time() - began)
            found += [(task, *slip, seconds) for slip in slips(solution, task.id)]
    return found


def equal(number):
    """The lines of an exercise in the file of slips that change no answer."""
    lines = (building.HERE / "equal.txt").read_text(encoding="utf-8").splitlines()
    return {line for line in lines if line.startswith(f"{number}.")}


def missed(number, chosen):
    """The labels of slips that lose no points."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return {label for task, label, text, seconds in chosen if not problem(task, text, seconds)}


@pytest.fixture(autouse=True)
def elsewhere(monkeypatch, tmp_path):
    """Let drivers write their files in a folder of their own."""
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(building.ROOT))
    monkeypatch.chdir(tmp_path)


def order(slip):
    return hashlib.sha256(slip[2].encode()).digest()


@pytest.mark.parametrize("number", building.GRADED, ids="ex{:02d}".format)
def test_some_slips_lose_points(number):
    chosen = sorted(tries(number), key=order)[:SAMPLE]
    assert not missed(number, chosen) - equal(number)


@pytest.mark.course
@pytest.mark.parametrize("number", building.GRADED, ids="ex{:02d}".format)
def test_every_slip_loses_points(number):
    found = missed(number, tries(number))
    assert not found - equal(number), "\n".join(sorted(found - equal(number)))
    assert found == equal(number), "these are caught: take them out of the file"
