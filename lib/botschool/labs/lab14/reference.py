"""What measure.py of this laboratory should give; a released copy has it packed."""

from __future__ import annotations

from typing import Any

import numpy as np

from botschool.labs.declare import Answers
from botschool.labs.measuring import play_again

GOALS = {"dense": -200.0, "sparse": 90.0, "long": 1000.0}


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Steps until the goal, whether it is reached, and the return in new episodes."""
    stat = np.asarray(run["stat"])
    reached = stat[:, 2] >= GOALS[run["condition"].split()[0]]
    return {
        "steps": float(stat[reached.argmax() if reached.any() else -1, 0]),
        "reached": float(reached.any()),
        "fresh": float(np.mean(play_again(run, seed=2, episodes=20))),
    }
