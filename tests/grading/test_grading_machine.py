"""Grading on a machine that is short of memory or disk, or kills: it costs no points."""

import errno
import os
import signal

import pytest

from botschool.grading.classes import batch
from botschool.grading.declare.exercise import load_exercise
from botschool.grading.judge.submission import grade, grade_task
from botschool.grading.run import student as students
from botschool.grading.run.confined import MachineFault, fork_server
from botschool.sandbox import usage
from tiny_course import SOLUTION, make_course, submit

pytestmark = pytest.mark.slow


@pytest.fixture
def course(tmp_path, monkeypatch):
    root = make_course(tmp_path / "course")
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(root))
    return root


@pytest.fixture
def outside(monkeypatch):
    """Kills children before they can answer: gives the list of how often that is still to be."""
    left = []
    start = students.start_child

    def start_and_kill(*arguments):
        child = start(*arguments)
        if left:
            left.pop()
            os.kill(child._pid, signal.SIGKILL)
        return child

    monkeypatch.setattr(students, "start_child", start_and_kill)
    return left


def judged(course, file, alone=True):
    exercise = load_exercise(3, course)
    with fork_server() as server:
        return grade_task(exercise.tasks[0], file, server, alone)


def test_a_kill_from_outside_costs_no_points(course, tmp_path, outside):
    file = submit(tmp_path, SOLUTION)
    outside.append(1)
    assert judged(course, file).points == 60
    outside.append(1)
    with pytest.raises(MachineFault, match="was killed from outside while double"):
        judged(course, file, alone=False)


def test_who_is_killed_again_when_alone_has_done_it_himself(course, tmp_path, monkeypatch):
    file = submit(
        tmp_path, "import os, signal\ndef double(x): os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    result = judged(course, file)
    assert result.points == 0 and "it was killed, by itself or for lack of memory" in result.message
    kills = iter(range(100))  # as if Linux counted one more each time
    monkeypatch.setattr(usage, "memory_kills", lambda: next(kills))
    with pytest.raises(MachineFault, match="killed for lack of memory while double"):
        judged(course, file)


def test_a_disk_that_others_have_filled_costs_no_points(course, tmp_path, monkeypatch):
    file = submit(tmp_path, "def double(x): raise OSError(28, 'No space left on device')\n")
    assert "No space left on device" in judged(course, file).message  # he only says so
    monkeypatch.setattr(students, "is_full", lambda folder: True)
    with pytest.raises(MachineFault, match="The disk was full while double"):
        judged(course, file)


@pytest.mark.parametrize("error", [OSError(errno.ENOSPC, "disk full"), OSError(errno.ENOMEM, "no")])
def test_what_the_grader_itself_lacks_is_no_fault_of_the_submission(course, tmp_path, error):
    def lacks(student):
        student.call("double", 1)
        raise error

    exercise = load_exercise(3, course)
    exercise.tasks[0].checks[0] = (40, "check", lacks)
    with pytest.raises(MachineFault, match="The grader could not go on"):
        grade(exercise, submit(tmp_path, SOLUTION))


@pytest.mark.parametrize("how", ["exit 75", "kill -9 $$"])
def test_what_the_machine_has_ended_is_graded_again_alone(course, tmp_path, monkeypatch, how):
    """With a grader that is ended so unless it is alone, and then with one that always is."""
    jobs = [batch.Job(3, submit(tmp_path / str(n), f"N = {n}\n{SOLUTION}")) for n in range(2)]
    real, running, alone = batch.interpreter, [], []

    def interpreter(module, *arguments):
        if arguments[-2] == "alone":
            alone.append(len([one for one in grades._running if one.poll() is None]))
            return real(module, *arguments)
        running.append(arguments)
        return ["sh", "-c", how]

    monkeypatch.setattr(batch, "interpreter", interpreter)
    grades = batch.Grades(course)
    assert [result["points"] for result in grades.of(jobs, 2).values()] == [100, 100]
    assert len(running) == 2 and alone == [0, 0]
    monkeypatch.setattr(batch, "interpreter", lambda *a: ["sh", "-c", f"echo no disk. >&2; {how}"])
    results = batch.Grades(course, fresh=True).of(jobs, 2)
    assert all("no disk." in result["problem"] for result in results.values())
    monkeypatch.setattr(batch, "interpreter", real)
    kept = batch.Grades(course).of(jobs, 2)  # not what came of a fault
    assert [result["points"] for result in kept.values()] == [100, 100]
