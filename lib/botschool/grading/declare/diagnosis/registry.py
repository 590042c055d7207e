"""What a detector of likely causes is, and how it is entered in a list."""

from __future__ import annotations

from collections.abc import Callable

from botschool.grading.declare.comparison import Comparison

Detector = Callable[[Comparison], "str | None"]


def adding_to(detectors: list[Detector]) -> Callable[[Detector], Detector]:
    """A decorator that puts functions at the end of this list."""

    def add(function: Detector) -> Detector:
        detectors.append(function)
        return function

    return add
