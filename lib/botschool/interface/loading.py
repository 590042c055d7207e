"""`botschool.load`: what a folder of results holds."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

from botschool.config import Experiment, from_dict
from botschool.evolution import checkpoint
from botschool.evolution.record import RunFiles
from botschool.interface.runs import Run, Runs
from botschool.interface.sources import Source, experiment_of, in_python_words
from botschool.interface.training import Agent


def load(folder: str | PathLike[str], experiment: Source | None = None) -> Runs | Agent:
    """Return the runs in a folder (of `evolve` or `botschool es`), or the agent of a training.

    experiment: for folders without checkpoints, as older libraries wrote; it is needed to play,
    film and write pages, not for histories. Raises BotschoolError.
    """
    from botschool.analysis.runs import find_runs
    from botschool.rl.folder import RunFolder, is_run

    folder = Path(folder)
    with in_python_words():
        if is_run(folder):
            return Agent(RunFolder(folder))
        given = None if experiment is None else experiment_of(experiment, {})
        seeds = [run.seed for run in find_runs(folder) if run.stat or run.bestg]
        return Runs([Run(given or _experiment(folder, seed), seed, folder) for seed in seeds])


def _experiment(folder: Path, seed: int) -> Experiment | None:
    path = RunFiles(folder, seed).checkpoint
    if not path.exists():
        return None
    return from_dict(checkpoint.header(path)["experiment"], str(path))
