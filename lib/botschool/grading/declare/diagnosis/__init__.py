"""Find likely causes of a wrong answer by comparing it with the right one.

A detector is a function of a Comparison. It returns a sentence if the cause that it knows explains
the whole difference, to rounding, and None otherwise. `diagnose` asks the detectors of places.py
(shapes, values in other places, order), then the detectors of numbers.py (numbers computed from the
right ones), and returns the first sentence. A sentence names the mistake, never the right numbers.
To add a detector, write the function, decorate it with @detector, and give its example in
tests/grading/test_grading_diagnosis.py. That test also checks that no detector explains random
numbers.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from botschool.grading.declare.diagnosis import numbers, places
from botschool.grading.declare.diagnosis.comparison import MAX_NUMBERS, Comparison, Detector, alike
from botschool.grading.declare.diagnosis.places import of_shapes

__all__ = ["DETECTORS", "diagnose", "of_shapes"]

DETECTORS: tuple[Detector, ...] = (*places.DETECTORS, *numbers.DETECTORS)


def diagnose(
    got: Any,
    wanted: Any,
    arguments: tuple = (),
    answer: Any = None,
) -> tuple[str, str]:
    """Return a detector's name and its sentence about the likely cause; ("", "") for none."""
    got, wanted = np.asarray(got, dtype=np.float64), np.asarray(wanted, dtype=np.float64)
    sizes_fit = 0 < got.size <= MAX_NUMBERS and 0 < wanted.size <= MAX_NUMBERS
    if not sizes_fit or not (np.all(np.isfinite(got)) and np.all(np.isfinite(wanted))):
        return "", ""
    both = Comparison(got, wanted, arguments, answer)
    if alike(got, wanted):
        return "", ""
    with np.errstate(all="ignore"):
        sentences = ((detector.__name__, detector(both)) for detector in DETECTORS)
        return next(((name, text) for name, text in sentences if text), ("", ""))
