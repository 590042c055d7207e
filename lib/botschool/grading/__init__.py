"""Grade exercises in isolated processes; grader files import only the names listed here."""

from botschool.grading.declare.checks import (
    Mismatch,
    Wrong,
    expect,
    expect_array,
    expect_close,
    expect_ends,
    expect_fields,
    show,
    went_on,
)
from botschool.grading.declare.exercise import Exercise, Task
from botschool.grading.declare.same import same
from botschool.grading.declare.slips import slips, spoiled
from botschool.grading.run.student import Student

__all__ = [
    "Exercise",
    "Mismatch",
    "Student",
    "Task",
    "Wrong",
    "expect",
    "expect_array",
    "expect_close",
    "expect_ends",
    "expect_fields",
    "same",
    "show",
    "slips",
    "spoiled",
    "went_on",
]
