"""Try a task's known mistakes if a check fails, to find one that answers as the submission does.

The result never changes the points. The checks run on our solution in a confined child; its calls
are repeated on the submission and on each known mistake. A mistake is reported if all its answers
equal the submission's, and if at least two of them, to different calls, differ from ours.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.exercise import Task
from botschool.grading.declare.mistakes import Case, Known
from botschool.grading.judge.alike import fits, weight
from botschool.grading.judge.looking import TookTooLong, processor_time_limit
from botschool.grading.run.student import Student
from botschool.sandbox import ForkServer
from botschool.sandbox.protocol import unpack

SECONDS = 2.0
"""Processor seconds for all attempts of a task."""
MOST = 16
"""Mistakes of a task to try."""
INPUTS = 2
"""Different calls that must point to a mistake, at least."""
Check = Callable[[Student], None]


@dataclass
class Call:
    """A request, and the answers of our solution and of the submission."""

    request: bytes
    ours: Any
    got: Any = None


def known_mistake(
    task: Task,
    checks: Iterable[Check],
    known: Known,
    submission: Student,
    name: str,
    server: ForkServer,
) -> str:
    """Return the sentence of the known mistake that explains a submission's answers, or "".

    checks: the task's quick checks. submission: a Student whose time does not count. name: its
    file's.
    """
    cases = known.of(task.id)[:MOST]
    if not cases:
        return ""
    with tempfile.TemporaryDirectory(prefix="botschool-") as folder:
        file = Path(folder) / "ours" / name
        file.parent.mkdir()
        file.write_text(known.solution, encoding="utf-8")
        ours = None
        try:
            ours = Student(file, SECONDS, task.memory, server, True, refused=task.refused)
            calls = _calls(ours, checks)
            for call in calls:
                call.got = submission.ask(unpack(call.request))
            if not _tells(calls, [call.got for call in calls]):
                return ""
            texts = ((case.what, _changed(case, known.solution)) for case in cases)
            return next((what for what, text in texts if _explains(ours, text, calls)), "")
        except (BotschoolError, Wrong, OSError):  # a fault of the machine, or no time is left
            return ""
        finally:
            if ours is not None:
                ours.close()


def _calls(ours: Student, checks: Iterable[Check]) -> list[Call]:
    """Return the calls that the checks make to our solution."""
    ours.trace = []
    for check in checks:
        try:
            with processor_time_limit(SECONDS):
                check(ours)
        except (Wrong, TookTooLong):
            continue
    found, ours.trace = ours.trace, None
    return [Call(request, unpack(answer)) for request, answer in found]


def _changed(case: Case, solution: str) -> str:
    """Return the text of a mistake; "" if it no longer fits the solution."""
    try:
        return case.of(solution)
    except ValueError:
        return ""


def _explains(ours: Student, text: str, calls: list[Call]) -> bool:
    """Return whether a wrong solution answers as the submission does."""
    if not text:
        return False
    made: list[Any] = []
    for part in (calls[:1], calls[1:]):
        try:
            requests = [unpack(call.request) for call in part]
            made += ours.run(answered, text, requests, said="a known mistake")
        except Wrong:
            if ours.seconds_left <= 0:
                raise
            return False
        if not all(fits(c.got, each, c.ours) for c, each in zip(calls, made, strict=False)):
            return False
    return _tells(calls, made)


def answered(module, text, requests):
    """Return another text's answers; runs in the child of our solution."""
    import sys
    import types

    from botschool.sandbox.child import run

    other = types.ModuleType("student")
    other.__file__ = module.__file__
    sys.modules["student"] = other
    exec(compile(text, module.__file__, "exec"), vars(other))
    return [run(other, request) for request in requests]


def _tells(calls: list[Call], answers: list[Any]) -> bool:
    """Return whether answers that fit the submission's prove a mistake, on enough inputs."""
    told: dict[bytes, float] = {}
    for call, answer in zip(calls, answers, strict=True):
        told[call.request] = max(told.get(call.request, 0.0), weight(call.got, answer, call.ours))
    return sum(told.values()) >= INPUTS
