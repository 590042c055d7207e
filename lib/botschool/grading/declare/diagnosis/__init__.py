"""Find likely causes of a wrong answer by comparing it with the right one.

A detector is a function of a Comparison. It returns a sentence if the cause that it knows explains
the whole difference, to rounding, and None otherwise. `diagnose` asks the detectors of places.py
(shapes, values in other places, order), then the detectors of numbers.py (numbers computed from the
right ones), and returns the first sentence. A sentence names the mistake, never the right numbers.
To add a detector, write the function, decorate it with @detector, and give its example in
tests/test_grading_diagnosis.py. That test also checks that no detector explains random numbers.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from botschool.grading.declare.diagnosis import numbers, places
from botschool.grading.declare.diagnosis.comparison import MAX_NUMBERS, Comparison, Detector, alike
from botschool.grading.declare.diagnosis.places import of_shapes

__all__ = ["DETECTORS", "diagnose", "fitting", "of_shapes"]

DETECTORS: tuple[Detector, ...] = (*places.DETECTORS, *numbers.DETECTORS)


def fitting(got: Any, wanted: Any, mistakes: dict[str, Any]) -> list[str]:
    """Return the sentences of the mistakes that lead to an answer; mistakes: as in diagnose."""
    return [text for text, made in mistakes.items() if alike(got, made) and not alike(wanted, made)]


def diagnose(
    got: Any,
    wanted: Any,
    arguments: tuple = (),
    answer: Any = None,
    mistakes: dict[str, Any] | None = None,
) -> str:
    """Return a sentence about the likely cause, or "".

    mistakes: sentence -> the answer that this mistake leads to; these are tried first.
    """
    got, wanted = np.asarray(got, dtype=np.float64), np.asarray(wanted, dtype=np.float64)
    sizes_fit = 0 < got.size <= MAX_NUMBERS and 0 < wanted.size <= MAX_NUMBERS
    if not sizes_fit or not (np.all(np.isfinite(got)) and np.all(np.isfinite(wanted))):
        return ""
    found = Comparison(got, wanted, arguments, answer)
    if alike(got, wanted):
        return ""
    if named := fitting(got, wanted, mistakes or {}):
        return named[0]
    with np.errstate(all="ignore"):
        return next((text for each in DETECTORS if (text := each(found))), "")
