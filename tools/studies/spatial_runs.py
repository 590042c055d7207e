"""How soon robots in space run, and how long: seeds of an experiment, each until it meets its goal.

    python tools/studies spatial_runs EXPERIMENT SECONDS SEED...

EXPERIMENT is a file of data/experiments, SECONDS of the processor the longest search. A run is that
of `botschool es -f EXPERIMENT -s SEED`, on one core. Every second of it, its best post-evaluated
robot runs new episodes, which does not count in the times and changes nothing. The run ends when
the ant runs 3 m/s, or the humanoid lives 20 s, without a fall in any of them. Results go to
tools/studies/data/spatial.jsonl, robots to results/spatial; what is there is not run again.
"""

from __future__ import annotations

import argparse
import time
from functools import partial

import numpy as np
from study import DATA, EXPERIMENTS, ROOT, Results

from botschool import config
from botschool.evolution.run import Run
from botschool.output import save_npy
from botschool.problems import Episodes

NEW_SEED, NEW = 2_000_000, 20
"""Seed and number of the new episodes."""
EVERY = 1.0
"""Seconds of search between two looks."""


class Trial:
    """New episodes of a runner: how fast and how long."""

    def __init__(self, run: Run) -> None:
        self.run = run
        self.human = "Humanoid" in run.experiment.exp.environment
        self.seconds = 1 / run.problem.fps
        self.steps = round((20 if self.human else 50) / self.seconds + 0.499)

    def measure(self, saved: np.ndarray) -> dict:
        """Return median speed (m/s), falls, and median life (s) of a saved robot."""
        problem, (genotype, scale) = self.run.problem, self.run.policy.split(saved)
        limit, problem.limit = problem.limit, self.steps
        outcome = problem.evaluate(
            self.run.policy, genotype[None], scale, Episodes.of([NEW_SEED], NEW), self.steps
        )
        problem.limit = limit
        lived, whole = outcome.steps, outcome.steps == self.steps
        metres = (outcome.fitness - problem.alive * (lived - ~whole)) * self.seconds
        return {
            "speed": round(float(np.median(metres / (lived * self.seconds))), 3),
            "falls": int((~whole).sum()),
            "life": round(float(np.median(lived)) * self.seconds, 1),
        }

    def goals(self, seen: dict) -> dict[str, bool]:
        """Return which goals it meets; the last one ends the run."""
        upright = seen["falls"] == 0
        goals = {f"{pace} m/s": upright and seen["speed"] >= pace for pace in (1, 2, 3)}
        return {"1 m/s": goals["1 m/s"], "20 s": upright} if self.human else goals


def search(name: str, seed: int, longest: float) -> dict:
    """Return what a run found, with its curve."""
    run = Run(config.load(EXPERIMENTS / f"{name}.ini"), seed)
    trial, spent, looked, met, curve = Trial(run), 0.0, 0.0, {}, []
    folder = ROOT / "results" / "spatial"
    folder.mkdir(parents=True, exist_ok=True)
    while spent < longest:
        start = time.process_time()
        run.advance()
        spent += time.process_time() - start
        if spent - looked < EVERY:
            continue
        looked, record = spent, run.record
        seen = trial.measure(record.bestg)
        save_npy(folder / f"{name}S{seed}.npy", record.bestg)
        point = {"seconds": round(spent, 1), "steps": record.steps, **seen}
        curve.append(point)
        if len(curve) % 10 == 0:
            print(name, seed, point, flush=True)
        goals = trial.goals(seen)
        for goal in goals:
            if goals[goal] and goal not in met:
                met[goal] = point
                print(name, seed, goal, point, flush=True)
        if goal in met:
            break
    return {"met": met, "end": curve[-1], "curve": curve}


def main(arguments: list[str] | None = None) -> None:
    """Measure seeds, and keep a line for each."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("experiment")
    parser.add_argument("seconds", type=float)
    parser.add_argument("seeds", type=int, nargs="+")
    given = parser.parse_args(arguments)
    results = Results(DATA / "spatial.jsonl")
    for seed in given.seeds:
        run = partial(search, given.experiment, seed, given.seconds)
        results.do({"experiment": given.experiment, "seed": seed}, run)
