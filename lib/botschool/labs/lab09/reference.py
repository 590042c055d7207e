"""What measure.py of this laboratory should give; a released copy has it packed."""

from __future__ import annotations

from typing import Any

from botschool.labs.declare import Answers
from botschool.labs.measuring import record


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Metres ahead, share of steps with the foot on the ground, and whether it is a statue."""
    seen = record(run, seed=1)
    metres = float(seen["distance"][0] - seen["distance"][-1])
    rule = answers.get("rule", 5.0)
    return {
        "metres": metres,
        "ground": float(seen["feet"].max(axis=1).mean()),
        "statue": float(metres < rule),
    }
