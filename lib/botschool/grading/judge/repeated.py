"""Repeat a wrong call: does its answer depend on chance, or on the calls before?"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from typing import Any

import numpy as np

from botschool.errors import BotschoolError
from botschool.grading.declare.alike import TIE, distance
from botschool.grading.declare.checks import Wrong
from botschool.grading.judge.sentence import QUICK, Failure
from botschool.grading.run.limit import TookTooLong, processor_time_limit
from botschool.grading.run.student import IN_PLACE, Student

KEPT = (
    "The same call in a new process gives the right answer: something stays from call to call. "
    "Look for a variable of the module, a default argument, an array that is changed in place, or "
    "a file."
)
UNSTEADY = (
    "Called again in the same way, the code gives another answer: by chance, or because something "
    "stays from call to call (a variable, an object, a file)."
)
MANY = 5
"""Answers to equal calls: those of a program that draws at random may be equal, too."""
NEW = 5
"""Right answers in new processes that show a state: a random one of few values may be right."""
Start = Callable[[], Student]


def answer_afresh(request: dict[str, Any], submission: Start) -> Any:
    """Return the submission's answer in a new process; None if it gives none."""
    try:
        with closing(submission()) as student:
            return student.ask(request)
    except (BotschoolError, Wrong, OSError):  # an exception, or a fault of the machine
        return None


def repeats(
    failure: Failure, fresh: Any, again: Student, submission: Start, ours: Student
) -> tuple[str, str]:
    """Return a sentence on answers that differ, and one on changed arguments; "" for none.

    fresh: the answer to the call in a new process. again: the submission. ours: our solution in a
    process where nothing counts; a call whose answers differ there, too, shows nothing.
    """
    if failure.answered and _stays(failure, fresh, submission, ours):
        return KEPT, ""
    answers, pair = [failure.got], None
    while len(answers) < MANY and all(same(answer, answers[0]) for answer in answers):
        pair = again.twice(failure.request)
        if pair is None:
            return "", ""
        answers += pair["answers"]
    unsteady = not all(same(answer, answers[0]) for answer in answers)
    if unsteady and (pair_of_ours := ours.twice(failure.request)) is not None:
        unsteady = same(*pair_of_ours["answers"])
    return UNSTEADY if unsteady else "", _changed(failure.request, pair)


def _changed(request: dict[str, Any], pair: dict[str, Any] | None) -> str:
    """Return a sentence on the first argument that a call changes, or ""."""
    if pair is None or "driver" in request or not isinstance(pair["arguments"], list):
        return ""
    both = zip(request["arguments"], pair["arguments"], strict=False)
    for number, (before, after) in enumerate(both, 1):
        if isinstance(before, (np.ndarray, list, dict)) and not same(before, after):
            return f"It changes its argument number {number} {IN_PLACE}"
    return ""


def _stays(failure: Failure, fresh: Any, submission: Start, ours: Student) -> bool:
    """Return whether a wrong answer is right in new processes, and wrong again after other calls.

    A random answer is right by chance, but hardly wrong in the same way again.
    """
    right = ours.ask(failure.request)
    for number in range(NEW):
        fresh = answer_afresh(failure.request, submission) if number else fresh
        if fresh is None or distance(fresh, right) > TIE or distance(failure.got, fresh) <= TIE:
            return False
    with closing(submission()) as student:
        try:
            with processor_time_limit(QUICK):
                failure.check(student)  # type: ignore[misc]  # it is quick, so it is there
        except TookTooLong:
            return False
        except Exception:  # that of the check, or a fault of the machine
            return distance(failure.got, student.answer) <= TIE
    return False


def same(one: Any, other: Any) -> bool:
    """Return whether two values of plain data are equal, bit by bit; tuples equal lists."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        if not (isinstance(one, np.ndarray) and isinstance(other, np.ndarray)):
            return False
        return one.shape == other.shape and one.tobytes() == other.tobytes()
    if isinstance(one, (list, tuple)) and isinstance(other, (list, tuple)):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, dict) and isinstance(other, dict):
        keys = [str(key) for key in one]
        return keys == [str(key) for key in other] and all(map(same, one.values(), other.values()))
    return one == other or (one != one and other != other)
