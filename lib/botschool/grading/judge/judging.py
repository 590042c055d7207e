"""A task's checks on a submission's file: points, and sentences about what is missing.

Failed checks are looked at again for a likely cause. Checks have a limit of processor time in the
grader's own thread.
"""

from __future__ import annotations

import signal
import threading
import time
import traceback
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from botschool.errors import BotschoolError
from botschool.grading.declare.checks import Mismatch, NotDone, Wrong, plain
from botschool.grading.declare.diagnosis import diagnose
from botschool.grading.declare.exercise import Task
from botschool.grading.run.confined import MachineFault, machine_fault
from botschool.grading.run.failures import Origin
from botschool.grading.run.student import Student
from botschool.sandbox import ForkServer

T = TypeVar("T")
CHECK_SECONDS = 20
"""Processor time that a check may use in the grader's own thread; our solutions need up to 3."""
MAX_DIAGNOSED, DIAGNOSIS_SECONDS = 2, 2.0
"""Failed checks of a task whose calls are looked at again; processor time for that."""


@dataclass
class TaskResult:
    """What a submission got for a task."""

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
    """(name, PNG) of those beside the submission's file after the task."""


class GraderFault(BotschoolError):
    """A check failed by a fault of its own, not by what a submission did."""


def grade_task(
    task: Task,
    file: Path,
    server: ForkServer,
    alone: bool = True,
    origin: Origin | None = None,
    references: dict | None = None,
) -> TaskResult:
    """Runs a task's checks on a file, in a child of its own; alone: as of `grade`.

    origin: where the lines of the file come from. references: as of Student; nothing is then shown
    of what the submission prints, draws, or says in exceptions. Raises BotschoolError.
    """
    return tried_twice(partial(_grade_task, task, file, server, origin, references), alone)


def _grade_task(
    task: Task,
    file: Path,
    server: ForkServer,
    origin: Origin | None,
    references: dict | None,
    tried: bool,
) -> TaskResult:
    result = TaskResult(task.id, task.title, 0, task.max_points, "")
    problems: list[str] = []
    failed: list[tuple[int, Failure]] = []
    student = None
    try:
        student = Student(
            file, task.seconds, task.memory, server, tried, origin, references, task.refused
        )
        for worth, _, check in task.checks:
            problem = _problem(task, check, student)
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
        for at, failure in [pair for pair in failed if pair[1].pasted][:1]:
            problems[at] += f"\n  To try it: {failure.pasted}"
        for at, failure in _diagnosable(failed):
            limits = DIAGNOSIS_SECONDS, task.memory, server, True
            again = partial(Student, file, *limits, origin, references, task.refused)
            problems[at] += looked_at_again(failure, again)
    except Wrong as error:
        problems.append(str(error))
    finally:
        if student is not None:
            student.close()
    # the same exception at the same line is said once, though several checks meet it
    said: dict[str, str] = {}
    for each in problems:
        said.setdefault(each.partition(" raised ")[2] or each, each)
    result.message = plain("\n".join(said.values()))
    return result


def _diagnosable(failed: list[tuple[int, Failure]]) -> list[tuple[int, Failure]]:
    """The first failures without a known cause, one of each function."""
    by_name = {each.name: (at, each) for at, each in reversed(failed) if each.unexplained}
    return sorted(by_name.values(), key=lambda pair: pair[0])[:MAX_DIAGNOSED]


def _problem(task: Task, check: Callable[[Student], None], student: Student) -> Failure | None:
    """Why a check is not passed; None when it is."""
    answers = student.answers
    before = student.seconds_left
    try:
        with processor_time_limit(CHECK_SECONDS):
            check(student)
    except TookTooLong:
        return Failure(f"{student.said} returned something that takes too long to judge.")
    except Wrong as error:
        return failure_of(error, student, before - student.seconds_left)
    except BotschoolError:
        raise  # the grader's own trouble, not the submission's
    except OSError as error:
        fault = machine_fault(error)
        if isinstance(fault, MachineFault):
            raise fault from error
        return Failure(_unjudged(task, student, answers, error))
    except Exception as error:
        return Failure(_unjudged(task, student, answers, error))
    return None


def _unjudged(task: Task, student: Student, answers: int, error: Exception) -> str:
    """An exception in a check: a sentence. Raises GraderFault if no answer can have caused it."""
    said = f"{type(error).__name__}: {str(error)[:200]}"
    # with nothing from the submission at hand, or by a name that is not there
    if student.answers == answers or isinstance(error, (NameError, ImportError)):
        place = traceback.extract_tb(error.__traceback__)[-1]
        raise GraderFault(
            f"The grader of task {task.id} has a fault, which is not the submission's "
            f"({said}, in {Path(place.filename).name} line {place.lineno}): it must be mended."
        ) from error
    return (
        f"{student.said} returned something that cannot be judged ({said}). If it is what the "
        "task asks for, tell your instructor."
    )


def tried_twice(attempt: Callable[[bool], T], alone: bool) -> T:
    """attempt(whether it was tried before), once more after a MachineFault if nobody else runs."""
    try:
        return attempt(False)
    except MachineFault:
        if not alone:
            raise
    return attempt(True)


MAX_SECONDS = 0.5
"""Of processor time that a check may have taken whose call is made again."""


@dataclass
class Failure:
    """A check that was not passed."""

    text: str
    unexplained: bool = False
    """Whether the call is worth another look."""
    request: dict[str, Any] = field(default_factory=dict)
    pasted: str = ""
    """The call, to paste."""

    @property
    def name(self) -> str:
        """Of the function called, or of the driver."""
        return str(self.request.get("name"))


def failure_of(error: Wrong, student: Student, seconds: float) -> Failure:
    """What a check's exception says, with a likely cause.

    seconds: of processor time that the submission used in this check.
    """
    text = str(error)
    if not isinstance(error, Mismatch):
        return Failure(text, not isinstance(error, NotDone) and student.answer is not None
                       and seconds < MAX_SECONDS, student.request)  # fmt: skip
    arguments = (
        *student.request.get("arguments", ()),
        *student.request.get("options", {}).values(),
    )
    cause = diagnose(error.got, error.wanted, arguments, student.answer, error.mistakes)
    text += f"\n  {cause}" if cause else ""
    pasted = "" if student.pasted in text else student.pasted
    return Failure(text, not cause and seconds < MAX_SECONDS, student.request, pasted)


def looked_at_again(failure: Failure, fresh: Callable[[], Student]) -> str:
    """What two more calls with the same arguments tell, as lines to add; "" if nothing.

    fresh: gives a Student whose time counts for nothing.
    """
    student = fresh()
    try:
        found = student.twice(failure.request)
    except Exception:  # of the machine: it will show itself again, or does not matter here
        found = None
    finally:
        student.close()
    if found is None:
        return ""
    first, second = found["answers"]
    text = ""
    if not same(first, second):
        text += (
            "\n  Called twice with the same arguments it gives different answers: random numbers "
            "that do not come from the seed, or something kept from call to call."
        )
    if "driver" not in failure.request and isinstance(found["arguments"], list):
        for number, (before, after) in enumerate(
            zip(failure.request["arguments"], found["arguments"], strict=False), 1
        ):
            if isinstance(before, (np.ndarray, list, dict)) and not same(before, after):
                text += (
                    f"\n  It changes its argument number {number} in place, which others go on "
                    "using: work on a copy (.copy())."
                )
    return text


def same(one: Any, other: Any) -> bool:
    """Whether two values of plain data are equal, bit by bit; tuples and lists are alike."""
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


POLL_SECONDS = 0.5
"""Of processor time of the whole process, between two looks."""


class TookTooLong(BaseException):
    """The block was ended; no `except Exception` inside it catches this."""


@contextmanager
def processor_time_limit(seconds: float) -> Iterator[None]:
    """Raises TookTooLong in the block when this thread has used so much processor time.

    Only in the main thread, where Python runs signal handlers; elsewhere there is no limit. A call
    into a library is interrupted when it returns. The threads of a library do not count: there
    may be many that wait busily.
    """
    main = threading.current_thread() is threading.main_thread()
    if not main or not hasattr(signal, "setitimer"):
        yield
        return

    start = time.thread_time()

    def end(number: int, frame: object) -> None:
        if time.thread_time() - start >= seconds:
            raise TookTooLong

    before = signal.signal(signal.SIGPROF, end)
    try:
        # again and again, since Python drops an exception that meets a destructor
        signal.setitimer(signal.ITIMER_PROF, min(seconds, POLL_SECONDS), POLL_SECONDS)
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
