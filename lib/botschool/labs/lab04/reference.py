"""What measure.py of this laboratory should give; a released copy has it packed."""

from __future__ import annotations

from typing import Any

import numpy as np

from botschool.labs.declare import Answers
from botschool.labs.measuring import play_again


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Reported fitness, mean return in 100 new episodes, and the standard deviation of these."""
    returns = play_again(run, seed=1, episodes=100)
    return {
        "reported": float(np.asarray(run["stat"])[-1, 2]),
        "fresh": float(returns.mean()),
        "spread": float(returns.std(ddof=1)),
    }
