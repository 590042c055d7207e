"""Prove that each slip in a solution (slips.py) loses points of its task.

equal.txt names the slips that change no answer. `pytest -m course -k ex08` tries all slips of
an exercise, and `make test` a sample. Tasks that may take long are left out.
"""

import hashlib
import time

import pytest

import building
from botschool.grading.declare.exercise import missing_packages
from direct import SECONDS, problem
from slips import slips

pytestmark = pytest.mark.usefixtures("elsewhere")
SAMPLE = 6
"""Slips of an exercise in the sample."""
for_each_exercise = pytest.mark.parametrize("number", building.GRADED, ids="ex{:02d}".format)


def missed(exercise, most=None):
    """The labels of slips in quick tasks that lose no points; most: of a sample."""
    if missing_packages(exercise.extras):
        return set()
    solution = exercise.known.solution
    tasks = [task for task in exercise.tasks if task.seconds <= building.QUICK]
    tries = [(task, *slip) for task in tasks for slip in slips(solution, task.id)]
    tries.sort(key=lambda slip: hashlib.sha256(slip[2].encode()).digest())
    seconds = {}
    for task in {slip[0].id: slip[0] for slip in tries[:most]}.values():
        began = time.process_time()
        assert not problem(task, solution, 60)  # else each slip would seem caught
        seconds[task.id] = SECONDS + 2 * (time.process_time() - began)
    return {
        label for task, label, text in tries[:most] if not problem(task, text, seconds[task.id])
    }


def equal(number):
    """The labels of an exercise in the file of slips that change no answer."""
    lines = (building.HERE / "equal.txt").read_text(encoding="utf-8").splitlines()
    return {line for line in lines if line.startswith(f"{number}.")}


@pytest.mark.slow
@for_each_exercise
def test_some_slips_lose_points(here, number):
    assert not missed(here(number), SAMPLE) - equal(number)


@pytest.mark.course
@for_each_exercise
def test_every_slip_loses_points(here, number):
    found = missed(here(number))
    assert not found - equal(number), "\n".join(sorted(found - equal(number)))
    assert found == equal(number), "these are caught: take them out of the file"
