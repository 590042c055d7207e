"""The command: one short function per subcommand. Heavy imports are made where they are used."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from botschool.errors import BotschoolError

app = typer.Typer(
    help="Train robots in simulation by evolution and by reinforcement learning.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="markdown",
    pretty_exceptions_enable=False,
)

Experiment = Annotated[
    Path | None, typer.Option("-f", "--file", help="Experiment file (.ini).", metavar="FILE")
]
Picture = Annotated[
    Path | None,
    typer.Option("-o", "--output", help="Write a picture instead of a window.", metavar="FILE"),
]
Folders = Annotated[
    list[Path] | None,
    typer.Argument(help="Folders of runs, or stat files; default: here.", show_default=False),
]


@app.callback()
def botschool() -> None:
    pass


@app.command(epilog="Example: botschool es -f data/experiments/acrobot.ini -s 11 -w 2 -o results")
def es(
    file: Experiment = None,
    seed: Annotated[int, typer.Option("-s", "--seed", min=0, max=2**62, help="Seed.")] = 1,
    replications: Annotated[
        int, typer.Option("-n", "--replications", min=1, help="Runs, with consecutive seeds.")
    ] = 1,
    workers: Annotated[
        int, typer.Option("-w", "--workers", min=1, max=1024, help="Cores to use.")
    ] = 1,
    output: Annotated[
        Path, typer.Option("-o", "--output", help="Folder of the run's files.", metavar="FOLDER")
    ] = Path("."),
    post: Annotated[
        bool, typer.Option("-p", "--postevaluate", help="Evaluate and show a robot instead.")
    ] = False,
    genotype: Annotated[
        Path | None,
        typer.Option("-g", "--genotype", help="With -p: a saved robot.", metavar="FILE"),
    ] = None,
    neurons: Annotated[
        bool, typer.Option("-d", "--neurons", help="With -p: show the neurons' activations.")
    ] = False,
    steps: Annotated[
        int | None, typer.Option(min=1, help="Stop after so many steps (--resume goes on).")
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Continue interrupted runs.")] = False,
    force: Annotated[bool, typer.Option("--force", help="Overwrite existing runs.")] = False,
    render: Annotated[
        str | None, typer.Option(help="With -p: human (a window) or none.", metavar="MODE")
    ] = None,
    video: Annotated[
        Path | None, typer.Option(help="With -p: a film (.mp4, .webm, .gif).", metavar="FILE")
    ] = None,
    episodes: Annotated[
        int | None, typer.Option(min=1, help="With -p: episodes to evaluate or show.")
    ] = None,
) -> None:
    """Evolve robots, or look at an evolved one (-p). Without -f: list all hyperparameters."""
    if file is None:
        _list_hyperparameters()
        return
    from botschool import config

    experiment = config.load(file)
    if post or genotype or video or render or neurons:
        _watch(experiment, seed, genotype, neurons, render, video, episodes)
        return
    from botschool.evolution.replicate import replicate

    if resume and force:
        raise BotschoolError("--resume continues a run and --force replaces it: give one of them.")
    seeds = list(range(seed, seed + replications))
    terminal = sys.stdout.isatty()
    if not replicate(experiment, seeds, output, workers, steps, resume, force, terminal):
        raise typer.Exit(130)


@app.command(epilog="Example: botschool plotstat results -o curves.png")
def plotstat(folders: Folders = None, output: Picture = None) -> None:
    """Plot fitness against steps: one run, or mean and band of all runs in a folder."""
    from botschool.analysis.plots import plot_stat

    plot_stat(folders or [Path(".")], output)


@app.command(epilog="Example: botschool plotave results/acrobot results/pendulum -o average.png")
def plotave(folders: Folders = None, output: Picture = None) -> None:
    """Mean, standard deviation and number of runs of the best post-evaluated fitness."""
    from botschool.analysis.plots import plot_ave

    plot_ave(folders or [Path(".")], output)


def _list_hyperparameters() -> None:
    from rich.console import Console
    from rich.table import Table

    from botschool.config import describe

    table = Table("Section", "Hyperparameter", "Default", "Meaning", title="Hyperparameters")
    for section, name, default, meaning in describe():
        table.add_row(f"\\[{section}]", name, "" if default is None else str(default), meaning)
    console = Console()
    console.print(table)
    console.print("To evolve: botschool es -f FILE.ini -s SEED (see botschool es --help)")


def _watch(experiment, seed, genotype, neurons, render, video, episodes) -> None:
    from botschool.render.watch import (
        VIDEO_EPISODES,
        PostEvaluation,
        has_display,
        read_genotype,
        watch,
    )

    if render not in (None, "human", "none"):
        raise BotschoolError(f"--render is '{render}', but must be human or none.")
    saved = None if genotype is None else read_genotype(genotype)
    robot = PostEvaluation(experiment, seed, saved)
    window = render == "human" or (render is None and video is None and has_display())
    wanted = experiment.policy.pepisodes
    watch(
        robot,
        episodes or (min(wanted, VIDEO_EPISODES) if video else wanted),
        window,
        video,
        neurons,
    )


def main() -> None:
    """Runs the command; errors for learners are one sentence and exit code 2."""
    try:
        app()
    except BotschoolError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        sys.exit(130)
    except BrokenPipeError:
        sys.stderr.close()
        sys.exit(1)
