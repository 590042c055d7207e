"""What measure.py of this laboratory should give; a released copy has it packed."""

from __future__ import annotations

from typing import Any

import numpy as np

from botschool.labs.declare import Answers
from botschool.labs.measuring import play_again

BODY = 64
"""Parameters of a body, at the end of a genotype."""


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Return of the brain in its own body, and the mean of its returns in the others'."""
    brain = np.asarray(run["genotype"])[:-BODY]
    mixed = [np.concatenate([brain, np.asarray(other)[-BODY:]]) for other in run["others"]]
    returns = [play_again(run | {"genotype": each}, seed=1, episodes=10).mean() for each in mixed]
    return {
        "own": float(play_again(run, seed=1, episodes=10).mean()),
        "swapped": float(np.mean(returns)),
    }
