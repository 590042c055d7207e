"""Define `botschool es`, which evolves robots and shows evolved ones."""

from __future__ import annotations

import gc
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from botschool.cli import cluster_options as across
from botschool.cli.experiments import experiment_of, robots_lie_in
from botschool.errors import BotschoolError

if TYPE_CHECKING:
    from botschool.config import Experiment

app = typer.Typer()


@app.command(epilog="Example: botschool es -f data/experiments/acrobot.ini -s 11 -w 2 -o results")
def es(
    file: Annotated[
        Path | None, typer.Option("-f", "--file", help="Experiment file (.ini).", metavar="FILE")
    ] = None,
    seed: Annotated[int, typer.Option("-s", "--seed", min=0, max=2**62, help="Seed.")] = 1,
    replications: Annotated[
        int,
        typer.Option(
            "-n",
            "--replications",
            min=1,
            max=100_000,
            help="Number of runs, with consecutive seeds.",
        ),
    ] = 1,
    workers: Annotated[
        int | None,
        typer.Option("-w", "--workers", min=1, max=1024, help="Cores to use.", show_default="1"),
    ] = None,
    output: Annotated[
        Path, typer.Option("-o", "--output", help="Folder for the run's files.", metavar="FOLDER")
    ] = Path("."),
    post: Annotated[
        bool, typer.Option("-p", "--postevaluate", help="Evaluate and show a robot instead.")
    ] = False,
    genotype: Annotated[
        str | None,
        typer.Option(
            "-g",
            "--genotype",
            help="With -p: a saved robot; for predators and prey also P-100-5 and the like.",
            metavar="FILE",
        ),
    ] = None,
    neurons: Annotated[
        bool, typer.Option("-d", "--neurons", help="With -p: show the neurons' activations.")
    ] = False,
    steps: Annotated[
        int | None, typer.Option(min=1, help="Stop after this many steps (--resume goes on).")
    ] = None,
    generations: Annotated[
        int | None, typer.Option(min=1, help="Stop after this many generations (--resume goes on).")
    ] = None,
    keep_every: Annotated[
        int | None,
        typer.Option(
            min=1, help="Also save the best genotype so far every N generations.", metavar="N"
        ),
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Continue interrupted runs.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Overwrite existing runs.")] = False,
    render: Annotated[
        str | None, typer.Option(help="With -p: human (a window) or none.", metavar="MODE")
    ] = None,
    video: Annotated[
        Path | None, typer.Option(help="With -p: a film (.mp4, .webm, .gif).", metavar="FILE")
    ] = None,
    replay: Annotated[
        Path | None,
        typer.Option(
            help="With -p: write a page that plays the episodes in a browser: `es -f acrobot.ini "
            "-p -g bestgS1.npy --replay acrobot.html`.",
            metavar="FILE",
        ),
    ] = None,
    episodes: Annotated[
        int | None, typer.Option(min=1, help="With -p: number of episodes.")
    ] = None,
    page: Annotated[
        bool,
        typer.Option(
            "--page", help="Only write the run's page from its files; works during the run, too."
        ),
    ] = False,
    cluster: across.Cluster = None,
    no_tls: across.NoTLS = False,
    patience: across.Patience = None,
) -> None:
    """Evolve robots, or show an evolved one (-p). Without -f: list all hyperparameters.

    For predators and prey, -g also takes one of these (-o names the folder of the run). For a
    generation that is not saved, the nearest one takes part:

    - `P-100-5`: watch the 5 best predators of generation 100 chase its 5 best prey;
      `p-100-5`: only measure them
    - `m-100-20`: measure generation 100 against generations 100, 80, 60 ...;
      `M-100-20`: measure all of these against each other
    - `c-FILE1-FILE2`: measure the populations of two runs against each other

    Example: botschool es -f predprey.ini -s 12 -o results -p -g m-100-20
    """
    if file is None:
        if post or genotype or video or replay or resume or force:
            raise BotschoolError("Name the experiment: add -f FILE.ini.")
        _list_hyperparameters()
        return
    machines = across.machines(cluster, no_tls, patience, workers)
    workers = workers or 1
    experiment = experiment_of(file)
    robots_lie_in(experiment.path, output, Path(genotype) if genotype else None)
    if page:
        from botschool.analysis.run_page import write_page

        for number in range(seed, seed + replications):
            print(f"page: {write_page(experiment, number, output)}")
        return
    if replay and not (post or genotype):
        raise BotschoolError("--replay shows a robot: add -p, and -g FILE for a saved robot.")
    if post or genotype or video or render or neurons:
        if machines:
            raise BotschoolError(
                "--cluster works with evolution and tournaments only: leave it out."
            )
        from botschool.render.watch import Watching

        watching = Watching(neurons, render, video, replay, episodes)
        from botschool.cli.tournament import post_evaluate

        post_evaluate(experiment, seed, genotype, output, workers, watching)
        return
    from botschool.evolution.replicate import replicate
    from botschool.evolution.run import Options

    if resume and force:
        raise BotschoolError(
            "--resume continues a run and --force replaces it: give only one of them."
        )
    seeds = list(range(seed, seed + replications))
    options = Options(
        workers=workers,
        steps=steps,
        generations=generations,
        keep_every=keep_every,
        resume=resume,
        force=force,
        terminal=sys.stdout.isatty(),
        cluster=machines,
    )
    gc.freeze()  # modules live until the end: spare the garbage collector a look at them
    collecting = gc.get_threshold()
    gc.set_threshold(100_000)  # a run's own objects rarely form cycles
    try:
        finished = replicate(experiment, seeds, output, options)
    finally:
        gc.set_threshold(*collecting)
        gc.unfreeze()
    if not finished:
        raise typer.Exit(130)
    _write_pages(experiment, seeds, output, options.terminal)


def _write_pages(experiment: Experiment, seeds: list[int], folder: Path, say: bool) -> None:
    """Write a page about each run; for native problems, the page plays the robot."""
    from botschool import problems
    from botschool.analysis.run_page import has_begun, write_page

    native = experiment.exp.environment in problems.names() and not experiment.exp.wrappers
    for seed in filter(lambda seed: has_begun(folder, seed), seeds):
        path = write_page(experiment, seed, folder, native)
        if say:
            print(f"page: {path}")


def _list_hyperparameters() -> None:
    from rich.table import Table

    from botschool.config import describe
    from botschool.console import Console

    table = Table("Section", "Hyperparameter", "Default", "Meaning", title="Hyperparameters")
    for section, name, default, meaning in describe():
        table.add_row(f"\\[{section}]", name, "" if default is None else str(default), meaning)
    console = Console()
    console.print(table)
    console.print("To evolve: botschool es -f FILE.ini -s SEED (see botschool es --help)")
