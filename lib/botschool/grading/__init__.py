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
from botschool.grading.declare.picture import Picture, all_over
from botschool.grading.declare.same import same, seed_of
from botschool.grading.run.student import Student

__all__ = [
    "Exercise",
    "Picture",
    "Student",
    "Task",
    "Wrong",
    "all_over",
    "expect",
    "expect_array",
    "expect_close",
    "expect_fields",
    "same",
    "seed_of",
    "show",
]
