"""What measure.py of this laboratory should give; a released copy has it packed."""

from __future__ import annotations

from typing import Any

import numpy as np

from botschool.labs.declare import Answers
from botschool.labs.measuring import play_again

SOLVED = 475.0
"""CartPole: mean of 20 new episodes."""


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Reported and new fitness, evaluations until solved, and whether it is solved."""
    size = run["experiment"]["algo"]["popsize"]
    reported = np.asarray(run["stat"])[:, 2]
    solved = reported >= SOLVED
    generations = int(solved.argmax()) + 1 if solved.any() else len(solved)
    return {
        "reported": float(reported[-1]),
        "fresh": float(np.mean(play_again(run, seed=1, episodes=100))),
        "evaluations": float(size * generations),
        "solved": float(solved.any()),
    }
