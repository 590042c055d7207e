"""Grade exercises in isolated processes; grader files import only the names listed here."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
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

_PLACES = {
    "declare.checks": ("Wrong", "expect", "expect_array", "expect_close", "expect_fields", "show"),
    "declare.exercise": ("Exercise", "Task"),
    "declare.picture": ("Picture", "all_over"),
    "declare.same": ("same", "seed_of"),
    "run.student": ("Student",),
}
"""Modules and their names, which are loaded when they are used: a submission needs none."""

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


def __getattr__(name: str) -> Any:
    for place, names in _PLACES.items():
        if name in names:
            return getattr(import_module(f"{__name__}.{place}"), name)
    raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
