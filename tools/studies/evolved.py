"""What the experiments of data/experiments reach over several seeds: a part of results.py.

Every run is that of `botschool es -f FILE -s SEED`, two of them side by side, on a core each.
"""

from __future__ import annotations

import tempfile
import time
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from study import EXPERIMENTS, NEW_SEED, at_steps, played, side_by_side

from botschool import config
from botschool.evolution.run import Run, evolve

POINTS = 40
"""Of a learning curve, equally spaced in the logarithm of the steps, from a 200th of them."""


@dataclass
class Row:
    """An experiment file, and what is known of others' results on its problem."""

    file: str
    published: str = "-"
    level: float | None = None
    """The published mean, for a line in the figure."""
    solved: float | None = None
    """Best post-evaluated fitness from which a run counts as solved."""
    new: int = 1000
    """New episodes."""


ROWS = [
    Row("acrobot", "-66.3 +- 2.1 (20 M steps); PPO -73.5 +- 18", -66.3),
    Row("pendulum", "-206 +- 39 (100 M steps); PPO -172 +- 104", -206),
    Row("cartpole", "PPO 500", 500, solved=500),
    Row("cartpole_openaies", "PPO 500", 500, solved=500),
    Row("mountaincarcontinuous", solved=90),
    Row("swingup"),
    Row("dpole", "725 +- 21", 725),
    Row("dpole_lstm", "725 +- 21 (10,000 M steps)", 725),
    Row("discrim", "about 180 to 360 (50 M steps)"),
]
BOX2D = [Row("lunarlander", solved=200, new=100)]
"""In Gymnasium's Box2D, stepped in Python: minutes a run."""


def whole(file: str, steps: float, seed: int, folder: Path) -> tuple[Run, dict]:
    """Return a whole run, of at most that many million steps, and what all runs tell of it."""
    experiment = config.load(EXPERIMENTS / f"{file}.ini")
    experiment.algo.maxmsteps = min(steps, experiment.algo.maxmsteps)
    start = time.process_time()
    run = Run(experiment, seed)
    evolve(run, folder)
    seconds = time.process_time() - start
    return run, {
        "seed": seed,
        "best": run.record.bestg_fitness,
        "seconds": seconds,
        "curve": at_steps(run.record.rows(), grid(experiment.algo.maxmsteps), 1),
    }


def run(row: Row, steps: float, seed: int) -> dict:
    """One run, whose files go to a temporary folder."""
    with tempfile.TemporaryDirectory() as folder:
        run, found = whole(row.file, steps, seed, Path(folder))
    outcome = played(run, run.record.bestg, NEW_SEED + seed, row.new)
    stat, solved = run.record.rows(), None
    if row.solved is not None and found["best"] >= row.solved:
        solved = float(stat[np.argmax(stat[:, 2] >= row.solved), 0])
    return {
        "seed": seed,
        "best": round(found["best"], 2),
        "new": round(float(outcome.fitness.mean()), 2),
        "solved": solved,
        "seconds": round(found["seconds"], 2),
        "curve": found["curve"],
    }


def grid(millions: float) -> np.ndarray:
    """The steps of a learning curve's points."""
    return np.geomspace(millions * 1e6 / 200, millions * 1e6, POINTS)


def evolved(rows: list[Row], seeds: int, steps: float = float("inf")) -> dict:
    """{file: {"algorithm", "steps", "runs"}} with seeds 1 to that."""
    found = {}
    for row in rows:
        experiment = config.load(EXPERIMENTS / f"{row.file}.ini")
        found[row.file] = {
            "algorithm": experiment.exp.algo,
            "steps": min(steps, experiment.algo.maxmsteps),
            "runs": side_by_side(partial(run, row, steps), range(1, seeds + 1)),
        }
        print(row.file, *(each["best"] for each in found[row.file]["runs"]), flush=True)
    return found
