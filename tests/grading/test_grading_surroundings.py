"""What a submission finds around it while it is graded: functions and files of the grader's."""

import pytest

from botschool.grading import Exercise, expect
from botschool.grading.judge.submission import grade
from tiny_course import FILE, submit


@pytest.mark.slow
def test_the_course_is_found_while_a_file_is_loaded(messages):
    """A path of the course may stand at the top of a submission; the graders stay closed."""
    exercise = Exercise(3, "Three", FILE)
    first = exercise.task("3.1", "First", seconds=5)

    @first.check(100)
    def sizes(student):
        body, grader = student.call("sizes")
        expect(body > 0 and grader == "PermissionError", f"{body} {grader}")

    text = """from botschool.course.files import experiment_file, robot_file
from botschool.paths import course_root
EXPERIMENT, BODY = experiment_file("acrobot.ini"), robot_file("balance_bot.urdf")


def sizes():
    grader = course_root() / "exercises/ex01_gymnasium/test_gymnasium_basics.py"
    try:
        grader.read_text()
    except OSError as error:
        return len(EXPERIMENT.read_text()) * len(BODY.read_text()), type(error).__name__
"""
    assert messages(text, exercise) == [""]


@pytest.mark.slow
def test_what_the_server_has_imported_is_refused(tmp_path):
    """Also a module that another one needs."""
    exercise = Exercise(3, "Halves", FILE, imports=("statistics",))

    @exercise.task("3.1", "A half", refused=("fractions",)).check(100)
    def halves(student):
        expect(student.call("half", 3) == 1.5, "not the half")

    text = "import sys\n\ndef half(n): return float(sys.modules['fractions'].Fraction(n, 2))\n"
    (task,) = grade(exercise, submit(tmp_path, text)).tasks
    assert "write it yourself: fractions.Fraction.__new__ is not to be used" in task.message
