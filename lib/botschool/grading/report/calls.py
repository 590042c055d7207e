"""Make the calls of a check that compares, to show them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from botschool.grading.declare.checks import NotDone, Wrong
from botschool.grading.declare.same import Same
from botschool.grading.run.student import Student


@dataclass
class Call:
    """A call, with both answers."""

    check: Same
    arguments: tuple
    wanted: Any
    got: Any = None
    said: str = ""
    """The call, as the learner would write it."""
    message: str = ""
    """Why the submission gives no answer that can be compared."""
    right: bool = False


def calls_of(check: Same, student: Student, inputs: Iterable[tuple]) -> Iterator[Call]:
    """Yield a check's calls with these inputs. Raises NotDone."""
    for arguments in inputs:
        ours = check.task.exercise.ours.answer(check.what, arguments)
        if ours.raised:
            continue
        call = Call(check, arguments, ours.value)
        try:
            call.got = check.ask(student, arguments, ours.seconds)
            check.seen(student.said, call.got, arguments)
            call.right = check.equal(arguments, call.got, ours.value)
        except NotDone:
            raise
        except Wrong as error:
            call.message = str(error)
        call.said = student.said
        yield call
