"""Repeat a call in a new process, where nothing has stayed from the calls before."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.declare.checks import Wrong
from botschool.grading.run.student import Student

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
