"""Grade exercises in isolated processes; grader files import only the names listed here."""

from botschool.grading.declare.checks import (
    Wrong,
    expect,
    expect_array,
    expect_close,
    expect_fields,
    show,
)
from botschool.grading.declare.exercise import Exercise, Task
from botschool.grading.declare.same import same
from botschool.grading.run.student import Student

__all__ = [
    "Exercise",
    "Student",
    "Task",
    "Wrong",
    "expect",
    "expect_array",
    "expect_close",
    "expect_fields",
    "same",
    "show",
]
