"""Evolve the hoppers that exercise 9's page shows, each with another bonus for standing.

    python tools/studies bonus [SEEDS]    seeds: for example 1 2 3

Writes lib/botschool/page/figures/ex09.npy: robots as run files hold them, but in single precision.
A run takes about ten seconds.
"""

import sys

import numpy as np

from botschool.evolution.run import Run
from botschool.page.figures.ex09 import BONUSES, FILE, SEEDS, experiment


def main() -> None:
    """See the top of the file."""
    seeds = list(map(int, sys.argv[1:])) or list(SEEDS)
    found = []
    for bonus in BONUSES:
        for seed in seeds:
            run = Run(experiment(bonus), seed)
            while not run.limit.reached(run):
                run.advance()
            found.append(run.record.bestg)
            print(f"bonus {bonus:g}, seed {seed}: {run.record.bestg_fitness:.0f}", flush=True)
    np.save(FILE, np.reshape(found, (len(BONUSES), len(seeds), -1)).astype("<f4"))
