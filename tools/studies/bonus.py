"""Evolve the hoppers that exercise 9's page shows: for bonuses, and for rewards to begin with.

    python tools/studies bonus [SEEDS]    seeds: for example 1 2 3

Writes ex09.npy and ex09_starts.npy in lib/botschool/page/figures: robots as run files hold them,
but in single precision.
A run takes about ten seconds.
"""

import sys

import numpy as np

from botschool.evolution.run import Run
from botschool.page.figures.ex09 import BONUSES, FILE, SEEDS, STARTED, STARTS, experiment, start

STEPS = 4_000_000
"""Of an evolution for a reward to begin with, as in the page."""


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
    begun = []
    for reward in STARTS.values():
        run = Run(start(reward), 1)
        while run.record.steps < STEPS:
            run.advance()
        begun.append(run.record.bestg)
        print(f"{reward}: {run.record.bestg_fitness:.0f}", flush=True)
    np.save(STARTED, np.array(begun).astype("<f4"))
    np.save(FILE, np.reshape(found, (len(BONUSES), len(seeds), -1)).astype("<f4"))
