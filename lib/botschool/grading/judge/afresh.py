"""Repeat a call in a new process, where nothing has stayed from the calls before."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.declare.checks import Wrong
from botschool.grading.judge.alike import TIE, distance
from botschool.grading.judge.looking import Failure
from botschool.grading.run.student import Student

KEPT = (
    "The same call in a new process gives the right answer: something stays from call to call. "
    "Look for a variable of the module, a default argument, an array that is changed in place, or "
    "a file."
)
Start = Callable[[], Student]


def right_afresh(request: dict[str, Any], submission: Start, ours: Start) -> bool:
    """Return whether the submission answers a request as our solution does, each in a new process.

    submission, ours: make a Student of it; its time does not count.
    """
    return _right_answer(request, submission, ours) is not None


def kept_something(failure: Failure, submission: Start, ours: Start) -> bool:
    """Return whether a wrong answer is right in a new process."""
    answer = _right_answer(failure.request, submission, ours)
    return answer is not None and distance(failure.got, answer) > TIE


def _right_answer(request: dict[str, Any], submission: Start, ours: Start) -> Any:
    """Return the answer that both give; None if they differ, or one of them gives none."""
    answers = []
    for start in (submission, ours):
        student = None
        try:
            student = start()
            answers.append(student.ask(request))
        except (BotschoolError, Wrong, OSError):  # an exception, or a fault of the machine
            return None
        finally:
            if student is not None:
                student.close()
    return answers[0] if distance(*answers) <= TIE else None
