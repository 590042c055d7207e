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
def plotstat(
    folders: Folders = None,
    output: Picture = None,
    box: Annotated[
        bool, typer.Option("--box", help="Draw a box of each folder's results instead of curves.")
    ] = False,
) -> None:
    """Plot fitness against steps: one run, or mean and band of all runs in a folder."""
    if box:
        from botschool.analysis.comparison import plot_boxes

        plot_boxes(folders or [Path(".")], output)
        return
    from botschool.analysis.plots import plot_stat

    plot_stat(folders or [Path(".")], output)


@app.command(epilog="Example: botschool compare results/openaies results/cmaes -o boxes.png")
def compare(
    first: Annotated[Path, typer.Argument(help="Folder of runs.", metavar="A")],
    second: Annotated[Path, typer.Argument(help="Another one.", metavar="B")],
    output: Picture = None,
) -> None:
    """Compare the results of two folders: medians, intervals, a test, the size of the effect.

    Each run counts once, by its best robot in fresh episodes. The intervals come from a bootstrap
    of the runs. The test asks how often chance alone would part the runs as clearly.
    """
    from botschool.analysis.comparison import compare_command

    compare_command((first, second), output)


@app.command(
    epilog="Example: botschool landscape planarhopper.ini -g planarhopper.npy -o landscape.png"
)
def landscape(
    file: Annotated[Path, typer.Argument(help="Experiment file.", metavar="FILE.ini")],
    genotype: Annotated[
        Path, typer.Option("-g", "--genotype", help="The robot in the middle.", metavar="FILE.npy")
    ],
    output: Picture = None,
    seed: Annotated[
        int, typer.Option("-s", "--seed", min=0, max=2**31, help="Of directions and episodes.")
    ] = 1,
    points: Annotated[int, typer.Option(min=3, max=501, help="Points of each direction.")] = 41,
    reach: Annotated[
        float,
        typer.Option(min=1e-6, max=1e6, help="Distance of the border; 1: the genotype's length."),
    ] = 0.4,
    episodes: Annotated[int, typer.Option(min=1, max=10_000, help="Episodes of each point.")] = 5,
    workers: Annotated[int, typer.Option("-w", "--workers", min=1, max=1024, help="Cores.")] = 1,
    physics: Annotated[
        str,
        typer.Option(help="Instead: along other physics of its world.", metavar="NAME=LOW..HIGH"),
    ] = "",
) -> None:
    """Draw the fitness around a robot, along two random directions of its parameters.

    With --physics friction=0.2..2, draw the robot's returns against that number (21 points).

    All points play the same episodes. The normalisation and, for an evolved body, its parameters
    belong to the genotype: the first stays, the others change like all parameters.
    """
    from botschool.analysis.landscape import landscape_command
    from botschool.cli.experiments import experiment_of
    from botschool.paths import own_file
    from botschool.render.watch import read_genotype

    path = own_file(genotype, "genotypes")
    robot, experiment = read_genotype(path), experiment_of(file)
    if physics:
        from botschool.analysis.worlds import worlds_command

        where = (physics, output, seed, min(points, 21), max(episodes, 20), workers)
        return worlds_command(experiment, robot, path.name, *where)
    odd = points + 1 - points % 2  # so that the robot is the point in the middle
    return landscape_command(
        experiment, robot, path.name, output, seed, odd, reach, episodes, workers
    )


@app.command(epilog="Example: botschool plotave results/acrobot results/pendulum -o average.png")
def plotave(folders: Folders = None, output: Picture = None) -> None:
    """Print the best robots' fitness: mean with its 95 % interval, standard deviation, runs."""
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


@app.command(epilog="Example: botschool plotmatrix results/walkers -o matrix.png")
def plotmatrix(
    folder: Annotated[Path, typer.Argument(help="Folder of runs.")] = Path("."),
    seed: Annotated[
        int | None, typer.Option("-s", "--seed", help="Of co-evolution: the run's seed.")
    ] = None,
    output: Picture = None,
) -> None:
    """Draw who does how well with whom.

    With evolved bodies (planarbodybrain.ini): the brain of each run in the body of each other run,
    measured in new episodes. With predators and prey: the newest generation, each against each.
    """
    from botschool.analysis.matrix import plot_matrix

    plot_matrix(folder, seed, output)


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
