"""Run a task's checks on a submission's file: points, and sentences about missing ones."""

from __future__ import annotations

import time
import traceback
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TypeVar

from botschool.errors import BotschoolError
from botschool.grading.declare.checks import Wrong, plain
from botschool.grading.declare.exercise import Task
from botschool.grading.declare.mistakes import Known
from botschool.grading.judge.causes import Explanation
from botschool.grading.judge.sentence import QUICK, Failure, failure_of
from botschool.grading.run.confined import MachineFault, machine_fault
from botschool.grading.run.failures import Origin
from botschool.grading.run.limit import TookTooLong, processor_time_limit
from botschool.grading.run.student import Student
from botschool.sandbox import ForkServer

T = TypeVar("T")
CHECK_SECONDS = 20
"""Processor seconds of a check in the grader's own thread; our solutions need up to 3."""
AGAIN = "It fails with our functions in the place of others, too."
"""What is said of a check of such an attempt."""
FAULTS = (ArithmeticError, AttributeError, LookupError, TypeError, ValueError)
MOST_SECONDS = 2.0
"""As QUICK, of a check that has failed: a known mistake must explain its answers, too."""
LOOKING_SECONDS = 6.0
"""Processor seconds of the submission while a cause is looked for."""


@dataclass
class TaskResult:
    """A submission's result for a task."""

    id: str
    title: str
    points: int
    max_points: int
    message: str
    """Why points are missing, in sentences; empty for full marks."""
    checks: dict[str, str] = field(default_factory=dict)
    """Why each check fails, by its name; "" where it passes."""
    cause: str = ""
    """The line of the message that names the cause, once it is complete."""
    undone: str = ""
    """The task of the function that is not started yet, if that is why points are missing."""
    failing: str = ""
    """The call, and the part of its answer, at which the first check fails."""
    explain: Callable[[], tuple[str, str]] | None = field(default=None, repr=False, compare=False)
    """Finds the cause; returns it and the whole message. Takes up to some seconds."""
    compared: bool = False
    """Whether checks of the task compare with our solution, so that `explain` shows their calls."""
    pictured: bool = False
    """Whether the task has a picture, so that `show` draws its answers."""
    hung: bool = False
    """Whether a call did not return in time."""
    note: str = ""
    """Lines below the message, whatever the cause is."""
    printed: str = ""
    """The beginning of what the submission printed."""
    missing: list[str] = field(default_factory=list)
    """What this system could not confine, in words."""
    pictures: list[tuple[str, bytes]] = field(default_factory=list)
    """(name, PNG) of the pictures beside the submission's file after the task."""
    graded: bool = True
    """Whether this machine has what the task needs."""

    def complete(self) -> TaskResult:
        """Find the cause and complete the message, once."""
        if self.explain is not None:
            explain, self.explain = self.explain, None
            self.cause, self.message = explain()
        self.message += self.note
        self.note = ""
        return self


class GraderFault(BotschoolError):
    """A check itself has a fault; the submission did not cause it."""


def grade_task(
    task: Task,
    file: Path,
    server: ForkServer,
    alone: bool = True,
    origin: Origin | None = None,
    references: dict | None = None,
    known: Known | None = None,
) -> TaskResult:
    """Run a task's checks on a file, in a child of its own; alone: as in `grade`.

    origin: where the lines of the file come from.
    references: as in Student; with them, nothing is shown that the submission returns, prints,
    draws or raises, since it can read these functions: the message names a known mistake, or the
    first call that fails.
    known: mistakes to try if a check fails. Raises BotschoolError.
    """
    attempt = partial(_grade_task, task, file, server, origin, references, known or Known())
    return tried_twice(attempt, alone)


def _grade_task(
    task: Task,
    file: Path,
    server: ForkServer,
    origin: Origin | None,
    references: dict | None,
    known: Known,
    tried: bool,
) -> TaskResult:
    result = TaskResult(task.id, task.title, 0, task.max_points, "")
    result.pictured = task.picture is not None
    failed: list[Failure] = []
    cheap: list[Callable[[Student], None]] = []
    student, shown = None, ""
    quiet = references is not None
    try:
        student = Student(
            file, task.seconds, task.memory, server, tried, origin, references, task.refused
        )
        for worth, name, check in task.checks:
            start = time.thread_time() - student.seconds_left
            failure = _failure(task, check, student)
            spent = time.thread_time() - student.seconds_left - start
            if spent < (QUICK if failure is None else MOST_SECONDS):
                cheap.append(check)
            result.checks[name] = (AGAIN if quiet else failure.text) if failure else ""
            if failure is None:
                result.points += worth
            else:
                failed.append(failure)
        student.stop()
        if not quiet:
            result.printed = plain(student.printed)
            result.pictures = student.pictures()
        result.missing, result.hung = student.missing, bool(student.hung)
        result.compared = any(hasattr(check, "what") for _, _, check in task.checks)
        if failed:
            first = failed[0]
            shown, result.undone = first.public if quiet else first.text, first.undone
            result.failing = first.public
            if known.solution:
                limits = min(LOOKING_SECONDS, task.seconds), task.memory, server, True
                begun = partial(Student, file, *limits, origin, references, task.refused)
                look = Explanation(task, known, task.exercise.ours, begun, failed, cheap, quiet)
                result.explain = partial(_explained, look, shown)
    except Wrong as error:
        shown = str(error)
    finally:
        if student is not None:
            student.close()
    result.message = plain(shown)
    return result


def _explained(look: Explanation, shown: str) -> tuple[str, str]:
    """Return the cause and the whole message; what is shown already, if that fails."""
    try:
        cause, text = look.message()
        return plain(cause), plain("\n".join(filter(None, [cause, text])))
    except FAULTS as fault:  # of ours, and points do not depend on it
        warnings.warn(f"The cause of a failure could not be found: {fault!r}.", stacklevel=1)
    except BotschoolError:  # a fault of the machine
        pass
    return "", plain(shown)


def _failure(task: Task, check: Callable[[Student], None], student: Student) -> Failure | None:
    """Return why a check fails; None if it passes."""
    answers = student.answers
    before = student.seconds_left
    student.changed = ""
    try:
        with processor_time_limit(CHECK_SECONDS):
            check(student)
    except TookTooLong:
        return Failure(f"{student.said} returned something that takes too long to judge.")
    except Wrong as error:
        return failure_of(error, check, student, before - student.seconds_left)
    except BotschoolError:
        raise  # the grader's own trouble, not the submission's
    except OSError as error:
        fault = machine_fault(error)
        if isinstance(fault, MachineFault):
            raise fault from error
        return Failure(_unjudged(task, student, answers, error))
    except Exception as error:
        return Failure(_unjudged(task, student, answers, error))
    return Failure(student.changed) if student.changed else None


def _unjudged(task: Task, student: Student, answers: int, error: Exception) -> str:
    """Return a sentence on a check's exception. Raises GraderFault if no answer can cause it."""
    said = f"{type(error).__name__}: {str(error)[:200]}"
    # before the submission answered, or by an unknown name
    if student.answers == answers or isinstance(error, (NameError, ImportError)):
        place = traceback.extract_tb(error.__traceback__)[-1]
        raise GraderFault(
            f"The grader of task {task.id} has a fault, which is not the submission's "
            f"({said}, in {Path(place.filename).name} line {place.lineno}): report it to your "
            "instructor."
        ) from error
    return (
        f"{student.said} returned something that cannot be judged ({said}). If it is what the "
        "task asks for, tell your instructor."
    )


def tried_twice(attempt: Callable[[bool], T], alone: bool) -> T:
    """Call attempt(tried before); repeat it once after a MachineFault if nobody else runs."""
    try:
        return attempt(False)
    except MachineFault:
        if not alone:
            raise
    return attempt(True)
