"""Failed checks, looked at for a likely cause."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from botschool.grading.declare.checks import Mismatch, NotDone, Wrong
from botschool.grading.declare.diagnosis import diagnose
from botschool.grading.run.student import Student

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
