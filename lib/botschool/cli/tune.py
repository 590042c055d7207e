"""Define `botschool tune`, which searches for better hyperparameters of an experiment."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()


@app.command(epilog="Example: botschool tune hopper.ini --trials 30 --steps 1000000 --seeds 3 -w 2")
def tune(
    file: Annotated[
        Path, typer.Argument(help="Experiment file (.ini).", metavar="FILE.ini", show_default=False)
    ],
    trials: Annotated[int, typer.Option(min=1, max=100_000, help="Values to try.")] = 20,
    steps: Annotated[
        int | None,
        typer.Option(
            min=1, max=10**12, help="Steps of each run.", show_default="a fifth of the file's"
        ),
    ] = None,
    seed: Annotated[int, typer.Option("-s", "--seed", min=0, max=2**31, help="Seed.")] = 1,
    seeds: Annotated[
        int,
        typer.Option(
            min=1,
            max=1000,
            help="Runs of each trial, with seeds from --seed on; their mean counts.",
        ),
    ] = 1,
    workers: Annotated[
        int, typer.Option("-w", "--workers", min=1, max=1024, help="Cores of a run.")
    ] = 1,
    output: Annotated[
        Path, typer.Option("-o", "--output", help="Folder of tunings.", metavar="FOLDER")
    ] = Path("results/tune"),
) -> None:
    """Search for better hyperparameters by many short runs (Optuna); the same command continues.

    The file marks what to tune in a section `[TUNE]`, with lines such as `stepsize = 0.001 .. 0.1
    log`, `sigma = 0.1 .. 0.5` or `nhiddens = 8, 16, 32`; without it, the usual hyperparameters of
    the algorithm are tuned. A trial counts by its best robot in 20 fresh episodes. Trials without
    prospects end early. The command writes `best.ini`, and a picture with the importance of each
    hyperparameter.
    """
    from botschool.analysis.tuning import Plan, tune_command
    from botschool.cli.experiments import experiment_of

    experiment = experiment_of(file)
    length = steps or max(1, round(getattr(experiment.algo, "maxmsteps", 1.0) * 1e6 / 5))
    if not tune_command(Plan(experiment, output, trials, length, seed, seeds, workers)):
        raise typer.Exit(130)
