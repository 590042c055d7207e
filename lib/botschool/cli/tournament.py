"""Define `botschool tournament`, and show evolved robots for `botschool es -p`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from botschool.cli import cluster_options as options
from botschool.cli.experiments import experiment_of
from botschool.errors import BotschoolError
from botschool.paths import own_file

if TYPE_CHECKING:
    from botschool.config import Experiment
    from botschool.render.watch import Watching


app = typer.Typer()


@app.command(epilog="Example: botschool tournament results -f predprey.ini -o tournament.png")
def tournament(
    folder: Annotated[
        Path, typer.Argument(help="Folder of a run of predators and prey.", metavar="FOLDER")
    ] = Path("."),
    file: Annotated[
        Path | None,
        typer.Option("-f", "--file", help="The run's experiment (.ini).", metavar="FILE"),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            "-s",
            "--seed",
            min=0,
            max=2**62,
            help="The run's seed.",
            show_default="the only one there",
        ),
    ] = None,
    generations: Annotated[
        str | None,
        typer.Option(
            help="Generations that take part.",
            metavar="0,100,200",
            show_default="11, evenly spaced",
        ),
    ] = None,
    every: Annotated[
        int | None,
        typer.Option(min=1, help="Instead: generations that this number divides."),
    ] = None,
    best: Annotated[
        int | None,
        typer.Option(
            min=2, help="Number of robots of each population.", show_default="the 10 best"
        ),
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option("-w", "--workers", min=1, max=1024, help="Cores to use.", show_default="1"),
    ] = None,
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", help="Write a picture, and a .csv beside it.", metavar="FILE"
        ),
    ] = None,
    cluster: options.Cluster = None,
    no_tls: options.NoTLS = False,
    patience: options.Patience = None,
) -> None:
    """Let predators and prey of all generations meet, and report whether they made progress.

    The command prints the mean fitness of each generation against each other one, with 95 %
    intervals, and draws it.
    """
    if file is None:
        raise BotschoolError("Name the experiment of the run: add -f FILE.ini.")
    from botschool.analysis import coevolution
    from botschool.terminal import has_display

    machines = options.machines(cluster, no_tls, patience, workers)
    experiment = experiment_of(file)
    folder = own_run(folder, experiment, seed)
    wanted = coevolution.generations_in(generations, every)
    coevolution.tournament(
        experiment, folder, seed, wanted, every, best, workers or 1, output, has_display(), machines
    )


def own_run(folder: Path, experiment: Experiment, seed: int | None) -> Path:
    """Return the folder of the run to use.

    If the user named no folder and the current one has no populations of this seed (None: of any
    seed), return the folder of botschool's own run, if it has the seed.
    """
    from botschool.analysis.populations import seeds_of
    from botschool.examples import ROBOTS, examples

    own = examples(ROBOTS).get(experiment.path.stem) if experiment.path else None
    if folder != Path(".") or own is None or not own.is_dir():
        return folder
    here, there = seeds_of(folder), seeds_of(own)
    if here if seed is None else seed in here or seed not in there:
        return folder
    print(
        f"This folder has no such run; here is the one that comes with botschool: {own}",
        file=sys.stderr,
    )
    return own


def post_evaluate(
    experiment: Experiment,
    seed: int,
    genotype: str | None,
    folder: Path,
    workers: int,
    watching: Watching,
) -> None:
    """Show a robot, random or from a file; or let the populations of a folder meet."""
    from botschool.analysis import coevolution
    from botschool.evolution import checkpoint
    from botschool.render.watch import PairEpisodes, PostEvaluation, read_genotype

    if genotype is None:
        watching.show(PostEvaluation(experiment, seed))
    elif not experiment.competitive or coevolution.names_file(genotype):
        path = own_file(genotype, "genotypes")
        robot = PostEvaluation(experiment, seed, read_genotype(path), path.name)
        checkpoint.check_scaling(path, robot.policy)
        watching.show(robot)
    else:
        folder = own_run(folder, experiment, seed)
        request = coevolution.parse(genotype, folder)
        if watching.asked and request.kind != "P":
            raise BotschoolError(
                f"-g {genotype} only measures. To see robots, use P, such as -g P-100-5 (the "
                "5 best of generation 100); to measure, leave out the options for pictures."
            )

        def show(population) -> None:
            pairs = population.predators, population.prey
            watching.show(PairEpisodes(experiment, seed, *pairs, population.name))

        coevolution.post_evaluate(experiment, seed, folder, request, workers, show)
