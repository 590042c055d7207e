"""What measure.py of this laboratory should give; a released copy has it packed."""

from __future__ import annotations

from typing import Any

import numpy as np

from botschool.labs.declare import Answers
from botschool.labs.measuring import chases


def historical(matrix: np.ndarray) -> float:
    """What each generation gains on its predecessor against older prey, summed up."""
    gains = np.diff(matrix, axis=0)
    return float(sum(row[:g].mean() for g, row in enumerate(gains, 1)))


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Historical progress with and without generation 0, and global progress, of predators."""
    matrix = chases(run, best=5).mean(axis=(1, 3))
    return {
        "historical": historical(matrix),
        "later": historical(matrix[1:, 1:]),
        "global": float(np.diff(matrix, axis=0).mean(axis=1).sum()),
    }
