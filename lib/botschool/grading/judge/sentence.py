"""Put a failed check into words, and keep what is needed to look for its cause."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from botschool.grading.declare.alike import distance
from botschool.grading.declare.checks import NotDone, Wrong, came, expect_close
from botschool.grading.declare.values import show
from botschool.grading.run.student import Student

TOLD = "Your code"
"""The beginning of the line about a known mistake."""
QUICK = 0.5
"""Processor seconds of a check whose calls are repeated."""
APART = 1e-4
"""Relative difference of two answers that is reported."""
_NUMBERS = ("task", "does", "solution", "its"), ("tasks", "do", "solutions", "their")
Check = Callable[[Student], None]


@dataclass
class Failure:
    """A check that failed."""

    text: str
    public: str = ""
    """What may be said where the submission can read functions of ours: nothing of its answer."""
    undone: str = ""
    """The task of the function that is not started yet, or ""."""
    stays: bool = False
    """Whether the text says already that something stays from call to call."""
    check: Check | None = None
    quick: bool = False
    """Whether the call is worth another look: the submission answered it in little time."""
    request: dict[str, Any] = field(default_factory=dict)
    answered: bool = False
    """Whether the submission gave an answer to the last call."""
    got: Any = None
    """This answer."""
    raised: bool = False
    """Whether the last call ended with an exception."""
    direct: dict[str, Any] = field(default_factory=dict)
    """The call of the function; {} if a driver made it."""
    shown: bool = False
    """Whether the text shows the whole call."""


def failure_of(error: Wrong, check: Check, student: Student, seconds: float) -> Failure:
    """Return the Failure for a check's exception.

    seconds: processor time of the submission in this check.
    """
    started = not isinstance(error, NotDone)
    failure = Failure(str(error), undone="" if started else error.task, stays=error.stays)
    failure.check, failure.request, failure.got = check, student.request, student.answer
    failure.answered = started and student.answer is not None
    failure.raised = started and bool(student.raised)
    failure.quick = failure.answered and seconds < QUICK
    called = error.said.partition("(")[0]
    if student.direct and called in ("", student.direct["name"]):  # it is about the last call
        failure.direct = student.direct
    failure.shown = bool(student.pasted) and student.pasted in str(error)
    failure.public = _public(error, student)
    return failure


def _public(error: Wrong, student: Student) -> str:
    """Return a failure in words that hold nothing which the submission returned or raised."""
    if isinstance(error, NotDone):
        return f"Task {error.task} is not done yet." if error.task else ""
    if not error.wanted:
        return f"Then {student.pasted or student.said} is wrong."
    verb = "are" if came(error.said) == "are" else "is"
    return f"Then {error.said} {verb} wrong: {error.wanted} was expected."


def line_about(what: str) -> str:
    """Return the line about a known mistake; what: its sentence, "Takes the sum for the mean."."""
    return f"{TOLD} {what[0].lower()}{what[1:]}"


def difference(said: str, got: Any, right: Any) -> str:
    """Return a sentence about the first part of two answers that differs."""
    if isinstance(got, dict) and isinstance(right, dict):
        for key in right:
            if key in got and distance(got[key], right[key]) > APART:
                return difference(f"{said}: {key}", got[key], right[key])
    if _of_parts(got) and _of_parts(right) and len(got) == len(right):
        for place, (mine, wanted) in enumerate(zip(got, right, strict=True)):
            if distance(mine, wanted) > APART:
                return difference(f"{said}[{place}]", mine, wanted)
    if _of_parts(right) and isinstance(got, list) and len(got) != len(right):
        return f"{said} has {len(got)} parts, but {len(right)} were expected."
    if not _of_parts(right) and got is not None and right is not None:
        try:
            expect_close(said, got, right, APART)
        except Wrong as error:
            return str(error)
        except (TypeError, ValueError, OverflowError):  # no numbers, or rows of different lengths
            pass
    return f"{said} {came(said)} {show(got)}, but {show(right)} was expected."


def _of_parts(answer: Any) -> bool:
    """Return whether an answer is a list with arrays, dicts or None."""
    kinds = (np.ndarray, dict, type(None))
    return isinstance(answer, list) and any(isinstance(part, kinds) for part in answer)


def built_on(broken: Iterable[tuple[str, Iterable[str]]], gain: int, missing: int) -> str:
    """Return a sentence on a task that was graded with our functions of others as well.

    broken: these tasks with their functions. gain: the points that it gets by that; missing: those
    that it still loses.
    """
    tasks = [f"{id} ({', '.join(names)})" for id, names in broken]
    task_or_tasks, do, solution, place = _NUMBERS[len(tasks) > 1]
    end = "gets all of its points" if not missing else "still loses some of its points"
    return (
        f"This task builds on {task_or_tasks} {' and '.join(tasks)}, which {do} not pass yet. "
        f"With our {solution} in {place} place, it {end if gain else 'fails as well'}."
    )
