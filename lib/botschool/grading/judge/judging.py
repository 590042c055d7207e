"""Run a task's checks on a submission's file: points, and sentences about missing ones."""

from __future__ import annotations

import tempfile
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
from botschool.grading.judge.known import VARIED, known_mistake
from botschool.grading.judge.looking import (
    MAX_SECONDS,
    Failure,
    TookTooLong,
    failure_of,
    look_for_causes,
    looked_at_again,
    processor_time_limit,
)
from botschool.grading.judge.sentences import is_vague
from botschool.grading.judge.smallest import smallest_case
from botschool.grading.run.confined import MachineFault, machine_fault
from botschool.grading.run.failures import Origin
from botschool.grading.run.student import Student
from botschool.sandbox import ForkServer

T = TypeVar("T")
CHECK_SECONDS = 20
"""Processor seconds of a check in the grader's own thread; our solutions need up to 3."""
SLIPS = (ArithmeticError, AttributeError, LookupError, TypeError, ValueError)
SHORT = 120
"""Characters of a call that needs no smaller one."""
MOST_SECONDS = 2.0
"""As MAX_SECONDS, of a check that has failed: a known mistake must explain its answers, too."""
MAX_DIAGNOSED, LOOKING_SECONDS = 2, 6.0
"""Failed checks of a task whose calls are repeated; processor seconds for a second look."""


@dataclass
class TaskResult:
    """A submission's result for a task."""

    id: str
    title: str
    points: int
    max_points: int
    message: str
    """Why points are missing, in sentences; empty for full marks."""
    printed: str = ""
    """The beginning of what the submission printed."""
    missing: list[str] = field(default_factory=list)
    """What this system could not confine, in words."""
    pictures: list[tuple[str, bytes]] = field(default_factory=list)
    """(name, PNG) of the pictures beside the submission's file after the task."""
    graded: bool = True
    """Whether this machine has what the task needs."""


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
    references: as in Student; with them, nothing is shown of what the submission prints, draws or
    says in exceptions.
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
    problems: list[str] = []
    failed: list[tuple[int, Failure]] = []
    cheap: list[Callable[[Student], None]] = []
    student, again, told = None, None, ""
    try:
        student = Student(
            file, task.seconds, task.memory, server, tried, origin, references, task.refused
        )
        for worth, _, check in task.checks:
            start = time.thread_time() - student.seconds_left
            problem = _problem(task, check, student)
            spent = time.thread_time() - student.seconds_left - start
            if spent < (MAX_SECONDS if problem is None else MOST_SECONDS):
                cheap.append(check)
            if problem is None:
                result.points += worth
            else:
                failed.append((len(problems), problem))
                problems.append(problem.text)
        student.stop()
        if references is None:
            result.printed = plain(student.printed)
            result.pictures = student.pictures()
        result.missing = student.missing
        failures = [failure for _, failure in failed]
        try:
            if any(failure.answered or failure.raised for failure in failures):
                limits = min(LOOKING_SECONDS, task.seconds), task.memory, server, True
                again = Student(file, *limits, origin, references, task.refused)
                slow = [
                    (each.request, each.got)
                    for each in failures
                    if each.answered and each.check not in cheap
                ]
                told = known_mistake(task, cheap, known, again, file.name, server, slow)
                passed = [each for each in cheap if each not in [f.check for f in failures]]
                look_for_causes(failures, passed, again)
                if told.startswith(VARIED) and any(failure.named for failure in failures):
                    told = ""  # the check's own sentence is written for the task
            causes: set[str] = set()
            vague = told.startswith(VARIED) and is_vague(told[len(VARIED) :])
            for at, failure in failed:
                known_cause = (told and not vague) or failure.cause in causes
                cause = "" if known_cause else failure.cause
                causes.add(cause)
                problems[at] = f"{failure.text}\n  {cause}" if cause else failure.text
            for at, failure in [pair for pair in failed if pair[1].told][:1]:
                text = ""
                if len(failure.pasted) > SHORT or not failure.pasted:
                    calls = task, known.solution, file.name, failure.direct
                    text = smallest_case(*calls, again, server)
                if text or failure.pasted:
                    problems[at] += f"\n  To try it: {text or failure.pasted}"
            for at, failure in [] if told else _diagnosable(failed):
                with tempfile.TemporaryDirectory(prefix="botschool-") as folder:
                    place = Path(folder) / file.name
                    place.write_text(known.solution, encoding="utf-8")
                    ours = partial(Student, place, *limits, refused=task.refused)
                    problems[at] += looked_at_again(failure, again, ours)
        except SLIPS as slip:  # of ours, and points do not depend on it
            warnings.warn(f"The cause of a failure could not be found: {slip!r}.", stacklevel=1)
    except Wrong as error:
        problems.append(str(error))
    finally:
        for used in (student, again):
            if used is not None:
                used.close()
    # report the same exception at the same line once, though several checks meet it
    said: dict[str, str] = {}
    for each in problems:
        said.setdefault(each.partition(" raised ")[2] or each, each)
    if told:
        said = {"": told, **said}
    result.message = plain("\n".join(said.values()))
    return result


def _diagnosable(failed: list[tuple[int, Failure]]) -> list[tuple[int, Failure]]:
    """Return the first failure of each function without a known cause."""
    by_name = {
        each.name: (at, each) for at, each in reversed(failed) if each.quick and not each.cause
    }
    return sorted(by_name.values(), key=lambda pair: pair[0])[:MAX_DIAGNOSED]


def _problem(task: Task, check: Callable[[Student], None], student: Student) -> Failure | None:
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
