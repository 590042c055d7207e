"""Define `plotstat`, `plotave`, `plotelites` and `showrobot`: pictures of runs and robots."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()

Picture = Annotated[
    Path | None,
    typer.Option(
        "-o", "--output", help="Write a picture instead of opening a window.", metavar="FILE"
    ),
]
Folders = Annotated[
    list[Path] | None,
    typer.Argument(
        help="Folders of runs, or stat files; default: this folder.", show_default=False
    ),
]


@app.command(epilog="Example: botschool plotstat results -o curves.png")
def plotstat(folders: Folders = None, output: Picture = None) -> None:
    """Plot fitness against steps: one run, or mean and band of all runs in a folder."""
    from botschool.analysis.plots import plot_stat

    plot_stat(folders or [Path(".")], output)


@app.command(epilog="Example: botschool plotave results/acrobot results/pendulum -o average.png")
def plotave(folders: Folders = None, output: Picture = None) -> None:
    """Print mean, standard deviation and number of runs of the best post-evaluated fitness."""
    from botschool.analysis.plots import plot_ave

    plot_ave(folders or [Path(".")], output)


@app.command(epilog="Example: botschool plotelites results -s 1 -o gaits.png --replay gaits.html")
def plotelites(
    folder: Annotated[Path, typer.Argument(help="Folder of a run of MAP-Elites.")] = Path("."),
    seed: Annotated[int, typer.Option("-s", "--seed", help="The run's seed.")] = 1,
    output: Picture = None,
    replay: Annotated[
        Path | None,
        typer.Option(help="Also write a page that plays the elites shown.", metavar="FILE"),
    ] = None,
) -> None:
    """Draw the map of MAP-Elites: the fitness of each behaviour, and pictures of nine robots."""
    from botschool.analysis.elites import plot_elites

    plot_elites(folder, seed, output, replay)


@app.command(epilog="Example: botschool showrobot minitaur --sheet minitaur.png")
def showrobot(
    name: Annotated[
        str | None,
        typer.Argument(
            help="A locomotor, balancebot, a model of PyBullet (kuka, minitaur, r2d2 ...), or a "
            ".urdf or .xml file; without a name: list the robots.",
            metavar="NAME",
            show_default=False,
        ),
    ] = None,
    video: Annotated[
        Path | None, typer.Option(help="Write a film of each joint's range.", metavar="FILE")
    ] = None,
    sheet: Annotated[
        Path | None, typer.Option(help="Write a picture of each joint's range.", metavar="FILE")
    ] = None,
) -> None:
    """Show a robot: a window with a slider for each joint and for gravity, a film or a sheet."""
    from botschool.envs.showrobot import list_robots, show_robot

    if name is None:
        list_robots()
    else:
        show_robot(name, video, sheet)
