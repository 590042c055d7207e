"""Let pytest collect tasks and checks: `pytest exercises/ex03_evolution_strategy -k 3.2`."""

from botschool.grading.report.items import pytest_pycollect_makemodule

__all__ = ["pytest_pycollect_makemodule"]
