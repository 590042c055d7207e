"""The instructor's secret cannot be found by trying, and inputs follow from it."""

import time

import pytest

from botschool.errors import BotschoolError
from botschool.grading.declare.exercise import exercise_numbers, load_exercise
from botschool.grading.declare.same import Same
from botschool.grading.declare.state import VARIABLE, slow_key
from botschool.paths import course_root
from botschool.sandbox.protocol import pack
from tiny_course import make_course

NUMBERS = exercise_numbers(course_root())


@pytest.mark.slow
@pytest.mark.parametrize("secret", ["robotics26", "x", "exactly 15 long"])
def test_a_secret_that_can_be_guessed_is_refused(tmp_path, monkeypatch, refused, secret):
    root = make_course(tmp_path / "course")
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(root))
    monkeypatch.setenv(VARIABLE, secret)
    monkeypatch.chdir(root)
    refused("grade", "3", "--submission", "solutions", says=["token_hex(16)", VARIABLE])
    with pytest.raises(BotschoolError, match="it can be found by trying"):
        load_exercise(3, root).seed(1)


def test_each_try_to_guess_a_secret_costs_and_each_seed_does_not():
    before = time.process_time()
    one, other = slow_key("sixteen letters, one"), slow_key("sixteen letters, two")
    first = time.process_time() - before
    again = slow_key("sixteen letters, one")
    assert one == again != other and first > 10 * (time.process_time() - before - first)


@pytest.mark.slow
@pytest.mark.parametrize("number", NUMBERS)
def test_inputs_are_drawn_or_a_reason_says_why_not(number):
    exercise = load_exercise(number)
    for task in exercise.tasks:
        for check in (each for *_, each in task.checks if isinstance(each, Same)):
            drawn = []
            for exercise.secret in ("one secret of sixteen", "another of sixteen"):
                drawn.append([pack([*arguments]) for arguments in check.inputs()])
            assert (drawn[0] == drawn[1]) == bool(check.fixed), f"{task.id} {check.__name__}"
