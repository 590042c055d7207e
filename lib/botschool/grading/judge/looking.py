"""Keep what a failed check shows, and limit the processor time of checks."""

from __future__ import annotations

import re
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from botschool.grading.declare.checks import Mismatch, NotDone, Wrong
from botschool.grading.declare.values import show
from botschool.grading.run.student import IN_PLACE, Student

MANY = 5
"""Answers to equal calls: those of a program that draws at random may be equal, too."""
MAX_SECONDS = 0.5
"""Largest processor time, in seconds, of a check whose call is repeated."""
Check = Callable[[Student], None]
_CALL = re.compile(r"(\w+)\(")


@dataclass
class Failure:
    """A check that failed."""

    text: str
    check: Check | None = None
    quick: bool = False
    """Whether the call is worth another look: the submission answered it in little time."""
    request: dict[str, Any] = field(default_factory=dict)
    pasted: str = ""
    """The call to paste, if the text does not show it."""
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
    text = str(error)
    answered = not isinstance(error, NotDone) and student.answer is not None
    pasted = student.pasted if answered and student.pasted not in text else ""
    if pasted and not isinstance(error, Mismatch):
        pasted += f" returned {show(student.answer)}"
    quick = answered and seconds < MAX_SECONDS
    failure = Failure(text, check, quick, student.request, pasted, answered)
    failure.direct, failure.shown = student.direct, bool(student.pasted) and not pasted
    failure.got = student.answer
    failure.raised = not isinstance(error, NotDone) and bool(student.raised)
    if _of_another(text, failure.direct):
        failure.pasted, failure.direct = "", {}
    return failure


def _of_another(text: str, direct: dict[str, Any]) -> bool:
    """Return whether the last call is not the one with which a sentence begins."""
    called = _CALL.match(text)
    return bool(called and direct and called[1] != direct["name"])


def looked_at_again(failure: Failure, student: Student, ours: Callable[[], Student]) -> str:
    """Return lines on what more calls with the same arguments show; "" if nothing.

    student: the submission in a new child; its time does not count. ours: makes a Student of our
    solution; a call whose answers differ there, too, shows nothing.
    """
    answers = [failure.got]
    try:
        while len(answers) < MANY and all(same(each, answers[0]) for each in answers):
            found = student.twice(failure.request)
            if found is None:
                return ""
            answers += found["answers"]
    except Exception:  # a fault of the machine: it will appear again, or does not matter here
        return ""
    text = ""
    unsteady = not all(same(each, answers[0]) for each in answers)
    if unsteady and _steady(failure.request, ours):
        text += (
            "\n  Called again in the same way, the code gives another answer: by chance, or "
            "because something stays from call to call (a variable, an object, a file)."
        )
    if "driver" not in failure.request and isinstance(found["arguments"], list):
        for number, (before, after) in enumerate(
            zip(failure.request["arguments"], found["arguments"], strict=False), 1
        ):
            if isinstance(before, (np.ndarray, list, dict)) and not same(before, after):
                text += f"\n  It changes its argument number {number} {IN_PLACE}"
    return text


def _steady(request: dict[str, Any], ours: Callable[[], Student]) -> bool:
    """Return whether our solution answers a request alike twice."""
    solution = None
    try:
        solution = ours()
        found = solution.twice(request)
    except Exception:  # a fault of the machine: nothing is said then
        found = None
    finally:
        if solution is not None:
            solution.close()
    return found is not None and same(*found["answers"])


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


POLL_SECONDS = 0.5
"""Processor seconds of the whole process between two checks."""


class TookTooLong(BaseException):
    """The time limit ends the block; no `except Exception` inside it catches this."""


@contextmanager
def processor_time_limit(seconds: float) -> Iterator[None]:
    """Raise TookTooLong in the block when this thread has used so much processor time.

    The limit works only in the main thread, where Python runs signal handlers. A call into a
    library is interrupted when it returns. A library's threads do not count: many of them may wait
    busily.
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
        # repeatedly, because Python drops an exception raised in a destructor
        signal.setitimer(signal.ITIMER_PROF, min(seconds, POLL_SECONDS), POLL_SECONDS)
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
