"""What the figures of exercise 9 need: hoppers that evolved with other bonuses for standing.

`python tools/studies bonus` evolves them, in some minutes.
"""

from base64 import b64encode
from pathlib import Path
from typing import Any

import numpy as np

from botschool import config
from botschool.page.exercise import robot
from botschool.paths import material

CORE = "planar"
FILE = Path(__file__).with_suffix(".npy")
"""The robots: (bonuses, seeds, numbers), in single precision."""
BONUSES = (0.0, 0.05, 0.1, 0.2, 0.5, 1.0)
SEEDS = (1, 2, 3, 4, 5)
NETWORK: dict[str, Any] = {"nhiddens": 10}


def experiment(bonus: float) -> config.Experiment:
    """Return a hopper's experiment: version 5, and a bonus for each step in which it stands."""
    read = config.load(material() / "data" / "experiments" / "planarhopper.ini")
    read.exp.options = f"alive={bonus:g}"
    for key, value in NETWORK.items():
        setattr(read.policy, key, value)
    read.algo.maxmsteps, read.algo.stepsize, read.algo.noiseStdDev = 10, 0.03, 0.05
    return read


def data() -> dict[str, Any]:
    """Return the hopper, and the numbers of all evolved ones, one after another."""
    hopper = robot("planarhopper.ini", **NETWORK)
    evolved = b64encode(np.load(FILE).tobytes()).decode()
    return {"hopper": hopper, "bonuses": BONUSES, "seeds": SEEDS, "evolved": evolved}
