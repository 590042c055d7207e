"""What measure.py of this laboratory should give; a released copy has it packed."""

from __future__ import annotations

from typing import Any

import numpy as np

from botschool.labs.declare import Answers
from botschool.labs.measuring import swing

LAST, UPRIGHT = 50, 0.3
"""An episode ends upright if the angle is below UPRIGHT in all LAST steps."""


def upright(seen: dict[str, np.ndarray]) -> float:
    """The share of episodes that end upright."""
    return float((np.abs(seen["angles"][:, -LAST:]) < UPRIGHT).all(axis=1).mean())


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Return and share of upright ends, under the gravity of evolution and under a greater one."""
    usual, heavy = swing(run, gravity=10.0), swing(run, gravity=12.0)
    return {
        "return": float(usual["rewards"].sum(axis=1).mean()),
        "upright": upright(usual),
        "heavy": float(heavy["rewards"].sum(axis=1).mean()),
        "heavy_upright": upright(heavy),
    }
