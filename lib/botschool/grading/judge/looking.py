"""Look for a likely cause of failed checks, and limit the processor time of checks."""

from __future__ import annotations

import re
import signal
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from botschool.grading.declare.checks import Mismatch, NotDone, Wrong, keeping
from botschool.grading.declare.diagnosis import diagnose, fitting
from botschool.grading.declare.diagnosis.comparison import Comparison, alike
from botschool.grading.declare.values import show
from botschool.grading.run.student import Student
from botschool.sandbox.protocol import pack

MAX_SECONDS = 0.5
"""Largest processor time, in seconds, of a check whose call is repeated."""
MISTAKES_SECONDS = 10.0
"""Largest processor time in which a check tells what mistakes make of one answer."""
MAX_CASES = 50
"""Wrong answers of a task to look at."""
MAX_RIGHT = 4
"""Right answers of a check, for each part, that a sentence on wrong ones must not contradict."""
INPUTS = 2
"""Different calls that must show the same cause before it is reported."""
COUNTED = "off by one"
"""Words of causes that one number may show by chance."""
MANY = 5
"""So many wrong values of yes and no, among right ones or of both kinds, prove a cause."""
Check = Callable[[Student], None]
_CALL = re.compile(r"(\w+)\(")
_DIGITS = re.compile(r"[-+]?\d[\d.e+-]*")


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
    wrong: Mismatch | None = None
    """What the check raised, if it is a wrong number or array."""
    cause: str = ""
    """A sentence on the likely cause."""
    named: bool = False
    """Whether the check itself names this cause."""
    direct: dict[str, Any] = field(default_factory=dict)
    """The call of the function; {} if a driver made it."""

    shown: bool = False
    """Whether the text shows the whole call."""

    @property
    def told(self) -> bool:
        """Return whether to show the call, or a smaller one: it was answered in little time."""
        return bool(self.pasted) or (self.quick and bool(self.direct) and not self.shown)

    @property
    def name(self) -> str:
        """Return the name of the called function, or of the driver."""
        return str(self.request.get("name"))


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
    failure.got, failure.wrong = student.answer, error if isinstance(error, Mismatch) else None
    failure.raised = not isinstance(error, NotDone) and bool(student.raised)
    if _of_another(text, failure.direct):
        failure.pasted, failure.direct = "", {}
    return failure


def _of_another(text: str, direct: dict[str, Any]) -> bool:
    """Return whether the last call is not the one with which a sentence begins."""
    called = _CALL.match(text)
    return bool(called and direct and called[1] != direct["name"])


@dataclass
class Case:
    """An answer that differs from the expected one."""

    check: Check
    text: str
    request: bytes
    pasted: str
    cause: str
    named: list[str]
    """The check's own sentences that explain the answer."""
    direct: dict[str, Any]
    certain: bool
    """Whether one case is enough: the check itself names the mistake, with many numbers."""
    wrong: Mismatch

    @property
    def part(self) -> tuple[str, str]:
        return self.wrong.part


def look_for_causes(failures: list[Failure], passed: list[Check], student: Student) -> None:
    """Run quick checks again to their end, and add to each failure its smallest case.

    Also add the cause: a sentence of the check that explains all its wrong answers, or a sentence
    found for two different calls. It must not contradict right answers, also those of the quick
    checks that have passed. student: the submission in a new child; its time does not count.
    """
    cases, right = _cases([each.check for each in failures if each.quick and each.check], student)
    if any(case.named for case in cases):
        right += _cases(passed, student)[1]
    calls: dict[str, set[bytes]] = {}
    for case in cases:
        calls.setdefault(_DIGITS.sub("", case.cause), set()).add(case.request)
    for failure in failures:
        own = sorted((c for c in cases if c.check is failure.check), key=lambda c: len(c.request))
        if not own:
            _name_at_once(failure, right)
        for case in own[:1]:
            failure.text, failure.direct = case.text, case.direct
            failure.shown = bool(case.pasted) and case.pasted in case.text
            failure.pasted = "" if failure.shown else case.pasted
            same_part = [each for each in cases if each.part == case.part]
            others = [each for each in right if each.part == case.part]
            others += [each.wrong for each in same_part]
            common = _common(own, cases, others)
            enough = any(each.certain for each in own) or len({c.request for c in own}) >= INPUTS
            if common and enough:
                failure.cause, failure.named = common, True
            elif case.cause and 2 * sum(_explained(case.cause, c) for c in own) < len(own):
                continue  # it explains a few of the check's wrong answers by chance
            elif _contradicted(case.cause, others):
                continue
            elif COUNTED in case.cause and not all(_explained(case.cause, c) for c in same_part):
                continue  # a count is one too large by chance
            elif case.certain or len(calls[_DIGITS.sub("", case.cause)]) >= INPUTS:
                failure.cause, failure.named = case.cause, case.cause in case.named


def _name_at_once(failure: Failure, right: list[Mismatch]) -> None:
    """Name the mistake of a check that takes too long to run again, if one answer proves it."""
    if (wrong := failure.wrong) is None or wrong.got.shape != wrong.wanted.shape:
        return
    others = [each for each in right if each.part == wrong.part]
    try:
        with processor_time_limit(MISTAKES_SECONDS):
            fit = fitting(wrong.got, wrong.wanted, wrong.mistakes)
    except TookTooLong:
        return
    told = [text for text in fit if not _contradicted(text, others)]
    if told and _certain(wrong.got, wrong.wanted):
        failure.cause, failure.named = told[0], True


def _explained(cause: str, case: Case) -> bool:
    """Return whether a sentence explains a case, whatever numbers it has there."""
    return cause in case.named or _DIGITS.sub("", cause) == _DIGITS.sub("", case.cause)


def _contradicted(text: str, others: list[Mismatch]) -> bool:
    """Return whether a mistake would have changed right answers, or wrong ones in another way."""
    try:
        with processor_time_limit(MAX_SECONDS):
            return any(text in each.mistakes and _differs(each, text) for each in others)
    except TookTooLong:
        return False


def _differs(answer: Mismatch, text: str) -> bool:
    made = answer.mistakes[text]
    effective = answer.right or not alike(answer.wanted, made)
    return effective and not alike(answer.got, made)


def _common(own: list[Case], cases: list[Case], others: list[Mismatch]) -> str:
    """Return a sentence of a check that explains all its wrong answers, or "".

    own: the check's cases. others: answers that a sentence must not contradict. Of several
    sentences, the one that explains most of all cases comes first.
    """
    said = [{_DIGITS.sub("", text) for text in case.named} for case in cases]
    mine = [names for case, names in zip(cases, said, strict=True) if case.check is own[0].check]

    def explained(text: str) -> int:
        return sum(_DIGITS.sub("", text) in names for names in said)

    fit = [text for text in own[0].named if all(text in case.named for case in own)]
    if not fit:  # a number in the sentence may follow from the case
        fit = [text for text in own[0].named if all(_DIGITS.sub("", text) in each for each in mine)]
    best_first = sorted(fit, key=explained, reverse=True)
    return next((text for text in best_first if not _contradicted(text, others)), "")


def _certain(got: np.ndarray, wanted: np.ndarray) -> bool:
    """Return whether one array is enough to prove a check's own sentence that explains it."""
    if Comparison(got, wanted).varied > 2:
        return True
    return got.shape == wanted.shape and np.sum(got != wanted) >= MANY and len(np.unique(got)) > 1


def _cases(checks: list[Check], student: Student) -> tuple[list[Case], list[Mismatch]]:
    """Return the wrong answers in checks, and a few right ones of each check."""
    found: list[Case] = []
    right: list[Mismatch] = []

    def keep(error: Mismatch) -> None:
        if error.right:
            few[error.part] += 1
            if few[error.part] <= MAX_RIGHT:
                right.append(error)
            return
        options = student.request.get("options", {}).values()
        given = (*student.request.get("arguments", ()), *options)
        cause = diagnose(error.got, error.wanted, given, student.answer, error.mistakes)
        certain = cause in error.mistakes and _certain(error.got, error.wanted)
        request = pack({key: student.request[key] for key in ("name", "arguments")})
        if len(found) < MAX_CASES:
            text, pasted, direct = str(error), student.pasted, student.direct
            if _of_another(text, direct):
                pasted, direct = "", {}
            named = fitting(error.got, error.wanted, error.mistakes)
            found.append(Case(check, text, request, pasted, cause, named, direct, certain, error))

    try:
        for check in checks:
            before = len(found)
            few = Counter[tuple[str, str]]()
            try:
                with processor_time_limit(MAX_SECONDS), keeping(keep):
                    check(student)
            except TookTooLong:
                continue
            except Mismatch as error:  # the check itself raised it
                if len(found) == before:
                    keep(error)
            except Exception as error:  # perhaps because it continued after a wrong answer
                if len(found) == before and not isinstance(error, Wrong):
                    raise
    except Exception:  # a fault of the machine: it will appear again, or does not matter here
        return [], []
    return found, right


def looked_at_again(failure: Failure, student: Student, ours: Callable[[], Student]) -> str:
    """Return lines on what two more calls with the same arguments show; "" if nothing.

    student: as in look_for_causes. ours: makes a Student of our solution; a call whose answers
    differ there, too, shows nothing.
    """
    try:
        found = student.twice(failure.request)
    except Exception:  # a fault of the machine: it will appear again, or does not matter here
        found = None
    if found is None:
        return ""
    first, second = found["answers"]
    text = ""
    if not same(first, second) and _steady(failure.request, ours):
        text += (
            "\n  Called again in the same way, the code gives another answer: by chance, or "
            "because something stays from call to call (a variable, an object, a file)."
        )
    if "driver" not in failure.request and isinstance(found["arguments"], list):
        for number, (before, after) in enumerate(
            zip(failure.request["arguments"], found["arguments"], strict=False), 1
        ):
            if isinstance(before, (np.ndarray, list, dict)) and not same(before, after):
                text += (
                    f"\n  It changes its argument number {number} in place, but the caller still "
                    "needs it as it was: work on a copy (.copy())."
                )
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
