"""What the figures of exercise 9 need: hoppers that evolved with other bonuses for standing, and
three rewards to begin with.

`python tools/studies bonus` evolves the hoppers, in some minutes.
"""

from base64 import b64encode
from pathlib import Path
from typing import Any

import numpy as np

from botschool import config, problems
from botschool.page import for_core
from botschool.page.exercise import robot
from botschool.paths import material
from botschool.problems.native import NativeProblem

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


STARTS = {
    "statue": "ahead + not ended",
    "leaper": "height * (foot_force == 0)",
    "runner": "ahead",
}
"""Rewards to begin with; STARTED holds the hoppers that evolved for them."""
STARTED = FILE.with_name("ex09_starts.npy")


def start(reward: str) -> config.Experiment:
    """Return the experiment that the page evolves for a reward."""
    own = experiment(0.0)
    own.exp.options, own.exp.reward = "", reward
    return own


def data() -> dict[str, Any]:
    """Return the hopper, the numbers of all evolved ones, one after another, and the starts."""
    hopper = robot("planarhopper.ini", **NETWORK)
    own = start("")
    problem = problems.of(own)
    assert isinstance(problem, NativeProblem)
    return {
        "hopper": hopper,
        "bonuses": BONUSES,
        "seeds": SEEDS,
        "evolved": b64encode(np.load(FILE).tobytes()).decode(),
        "evolution": for_core(own, problem),
        "starts": {
            name: {"reward": reward, "robot": b64encode(each.astype("<f4").tobytes()).decode()}
            for (name, reward), each in zip(STARTS.items(), np.load(STARTED), strict=True)
        },
    }
