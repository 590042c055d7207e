"""What a submission finds around it while it is graded: functions and files of the grader's."""

from functools import partial, wraps
from types import SimpleNamespace

import pytest

from botschool.grading import Exercise, expect
from botschool.grading.judge.submission import grade
from botschool.grading.run.replaced import replaced
from tiny_course import FILE, submit


def power(base, exponent=2, *, scale=1):
    return scale * base**exponent


KEPT_ELSEWHERE = [power, partial(power, exponent=3)]


def by_default(base, function=power):
    return function(base)


def counted(seen):
    def instead(function):
        def counting(*arguments, **options):
            seen.append((arguments, options))
            return function(*arguments, **options)

        return counting

    return instead


def test_all_references_to_a_function_call_the_other_one():
    module, seen = SimpleNamespace(power=power), []
    with replaced(module, "power", counted(seen)):
        assert module.power(3) == 9
        assert KEPT_ELSEWHERE[0](3, scale=2) == 18
        assert KEPT_ELSEWHERE[1](2) == 8
        assert by_default(5) == 25
    assert seen == [((3,), {}), ((3,), {"scale": 2}), ((2,), {"exponent": 3}), ((5,), {})]
    assert power(3, scale=3) == 27
    assert len(seen) == 4


def test_a_function_may_be_replaced_twice():
    module, seen = SimpleNamespace(power=power), []
    with replaced(module, "power", counted(seen)), replaced(module, "power", counted(seen)):
        assert by_default(2) == 4
    assert len(seen) == 2
    assert power(2) == 4


def test_what_is_no_plain_function_is_replaced_by_name():
    @wraps(power)
    def decorated(*arguments):
        return power(*arguments)

    for function in (decorated, partial(power, 2), abs):
        module, seen = SimpleNamespace(function=function), []
        with replaced(module, "function", counted(seen)):
            module.function(2)
        assert len(seen) == 1
        assert module.function is function


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
