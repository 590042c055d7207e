"""What the experiments of data/experiments reach over several seeds: a part of results.py.

Every run is that of `botschool es -f FILE -s SEED`, two of them side by side, on a core each.
"""

from __future__ import annotations

import multiprocessing
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from botschool import config
from botschool.analysis.runs import read_stat
from botschool.evolution.record import RunFiles
from botschool.evolution.run import Run, evolve
from botschool.problems import Episodes

DATA = Path(__file__).parents[2] / "data" / "experiments"
NEW_SEED = 2**40
"""New episodes are those of a seed that no run uses."""
PROCESSES = 2
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


def run(row: Row, steps: float, seed: int) -> dict:
    """One whole run, of at most that many million steps; its files go to a temporary folder."""
    experiment = config.load(DATA / f"{row.file}.ini")
    experiment.algo.maxmsteps = min(steps, experiment.algo.maxmsteps)
    with tempfile.TemporaryDirectory() as folder:
        start = time.process_time()
        run = Run(experiment, seed)
        evolve(run, Path(folder))
        seconds = time.process_time() - start
        stat = read_stat(RunFiles(Path(folder), seed).stat)
    genotype, normalisation = run.policy.split(run.record.bestg)
    outcome = run.problem.evaluate(
        run.policy,
        genotype[None],
        normalisation,
        Episodes.of([NEW_SEED + seed], row.new),
        experiment.policy.maxsteps,
    )
    best = run.record.bestg_fitness
    reached = row.solved is not None and best >= row.solved
    rows = np.searchsorted(stat[:, 0], grid(experiment.algo.maxmsteps), side="right") - 1
    return {
        "seed": seed,
        "best": round(best, 2),
        "new": round(float(outcome.fitness.mean()), 2),
        "solved": float(stat[np.argmax(stat[:, 2] >= row.solved), 0]) if reached else None,
        "seconds": round(seconds, 2),
        "curve": [None if i < 0 else round(float(stat[i, 2]), 1) for i in rows],
    }


def grid(millions: float) -> np.ndarray:
    """The steps of a learning curve's points."""
    return np.geomspace(millions * 1e6 / 200, millions * 1e6, POINTS)


def evolved(rows: list[Row], seeds: int, steps: float = float("inf")) -> dict:
    """{file: {"algorithm", "steps", "runs"}} with seeds 1 to that."""
    found = {}
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(PROCESSES, mp_context=context) as pool:
        for row in rows:
            experiment = config.load(DATA / f"{row.file}.ini")
            runs = list(pool.map(partial(run, row, steps), range(1, seeds + 1)))
            found[row.file] = {
                "algorithm": experiment.exp.algo,
                "steps": min(steps, experiment.algo.maxmsteps),
                "runs": runs,
            }
            print(row.file, *(each["best"] for each in runs), flush=True)
    return found
