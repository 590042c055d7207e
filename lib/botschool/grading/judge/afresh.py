"""Repeat a call in a new process, where nothing has stayed from the calls before."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.declare.checks import Wrong
from botschool.grading.judge.alike import TIE, distance
from botschool.grading.judge.looking import (
    MAX_SECONDS,
    Failure,
    TookTooLong,
    processor_time_limit,
)
from botschool.grading.run.student import Student

KEPT = (
    "The same call in a new process gives the right answer: something stays from call to call. "
    "Look for a variable of the module, a default argument, an array that is changed in place, or "
    "a file."
)
AGAIN = 6
"""Right answers in new processes that show this: a random one of few values is right by chance."""
Start = Callable[[], Student]


def answers_afresh(
    request: dict[str, Any], submission: Start, ours: Start
) -> tuple[Any, Any] | None:
    """Return the answers of the submission and of our solution, each in a new process.

    submission, ours: make a Student of it; its time does not count. None if one gives no answer.
    """
    answers = []
    for start in (submission, ours):
        try:
            with closing(start()) as student:
                answers.append(student.ask(request))
        except (BotschoolError, Wrong, OSError):  # an exception, or a fault of the machine
            return None
    return answers[0], answers[1]


def kept_something(failure: Failure, submission: Start, ours: Start) -> bool:
    """Return whether a wrong answer is right in new processes, and wrong again after other calls.

    A random answer is right by chance, but hardly wrong in the same way again.
    """
    for _ in range(AGAIN):
        answers = answers_afresh(failure.request, submission, ours)
        if answers is None or distance(*answers) > TIE or distance(failure.got, answers[0]) <= TIE:
            return False
    with closing(submission()) as student:
        try:
            with processor_time_limit(MAX_SECONDS):
                failure.check(student)  # type: ignore[misc]  # it is quick, so it is there
        except TookTooLong:
            return False
        except Exception:  # that of the check, or a fault of the machine
            return distance(failure.got, student.answer) <= TIE
    return False
