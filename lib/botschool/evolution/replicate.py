"""Several runs of one experiment, with consecutive seeds, one after another."""

from __future__ import annotations

from pathlib import Path

from botschool.config import Experiment, competitive
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.progress import reporting
from botschool.evolution.record import RunFiles
from botschool.evolution.run import Run, claim, evolve
from botschool.terminal import stoppable


def replicate(
    experiment: Experiment,
    seeds: list[int],
    folder: Path,
    workers: int,
    steps: int | None,
    resume: bool,
    force: bool,
    terminal: bool,
    generations: int | None = None,
) -> bool:
    """Runs every seed and prints where the results are; False when the user stopped it."""
    kind = Coevolution if competitive(experiment) else Run
    with stoppable() as stopping:
        runs = [kind(experiment, seed, workers, stopping) for seed in seeds[:1]]
        claim(folder, seeds, resume, force)
        for seed in seeds:
            run = runs.pop() if runs else kind(experiment, seed, workers, stopping)
            with reporting(seed, terminal) as report:
                finished = evolve(run, folder, steps, resume, report, generations)
            _print_result(run, RunFiles(folder, seed), finished)
            if not finished:
                return False
    return True


def _print_result(run: Run, files: RunFiles, finished: bool) -> None:
    if not finished:
        print(
            f"seed {run.seed}: stopped after {run.record.generation} generations; all is saved, "
            "add --resume to the same command to go on."
        )
    elif run.record.generation:
        print(run.result(files))
