"""Load a submission's file in its process, and return what fails."""

from __future__ import annotations

from pathlib import Path

from botschool.grading.declare.checks import Wrong, plain
from botschool.grading.run.confined import MachineFault
from botschool.grading.run.failures import Origin
from botschool.grading.run.student import Student
from botschool.sandbox import ForkServer

MOST_LOST = 100
"""Names without a value that are told."""
LOADING_SECONDS = 10
"""Processor seconds of all code in a file or a notebook outside functions."""


def left_out_of(file: Path, server: ForkServer, origin: Origin) -> list[tuple[str, int, str]]:
    """Return (name, line, what was raised) of each name that has no value, as the file tells."""

    def left_out(module):
        return module.__left_out__

    student = Student(file, LOADING_SECONDS, server=server, origin=origin)
    try:
        found = student.run(left_out, said="the code outside functions")
        return [(plain(str(n)), int(line), plain(str(said))) for n, line, said in found[:MOST_LOST]]
    except (Wrong, MachineFault, TypeError, ValueError):
        return []
    finally:
        student.close()


def trouble_of(file: Path, server: ForkServer, origin: Origin, tried: bool) -> Wrong | None:
    """Return why a submission's file cannot be loaded; None if it can.

    Raises Wrong if it must not be loaded.
    """

    def loads(module):
        return True

    student = Student(file, LOADING_SECONDS, server=server, tried=tried, origin=origin)
    try:
        student.run(loads, said="the code outside functions")
    except Wrong as error:
        return error
    finally:
        student.close()
    return None
