"""Several runs of one experiment, with consecutive seeds, one after another."""

from __future__ import annotations

from pathlib import Path

from botschool.config import Experiment
from botschool.evolution.progress import reporting
from botschool.evolution.record import RunFiles
from botschool.evolution.run import Run, claim, evolve
from botschool.evolution.signals import stoppable


def replicate(
    experiment: Experiment,
    seeds: list[int],
    folder: Path,
    workers: int,
    steps: int | None,
    resume: bool,
    force: bool,
    terminal: bool,
) -> bool:
    """Runs every seed and prints where the results are; False when the user stopped it."""
    with stoppable() as stopping:
        runs = [Run(experiment, seed, workers, stopping) for seed in seeds[:1]]
        claim(folder, seeds, resume, force)
        for seed in seeds:
            run = runs.pop() if runs else Run(experiment, seed, workers, stopping)
            budget = run.max_steps if steps is None else min(steps, run.max_steps)
            with reporting(budget, seed, terminal) as report:
                finished = evolve(run, folder, budget, resume, report)
            _print_result(run, RunFiles(folder, seed), finished)
            if not finished:
                return False
    return True


def _print_result(run: Run, files: RunFiles, finished: bool) -> None:
    record = run.record
    if not finished:
        print(
            f"seed {run.seed}: stopped after {record.generation} generations; all is saved, "
            "add --resume to the same command to go on."
        )
    elif record.generation:
        print(
            f"seed {run.seed}: best {record.best_fitness:.2f}, best post-evaluated "
            f"{record.bestg_fitness:.2f} after {record.steps} steps; best robot: {files.bestg}"
        )
