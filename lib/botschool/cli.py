"""The command: one short function per subcommand. Heavy imports are made where they are used."""

from __future__ import annotations

import os
import signal
import sys
from contextlib import suppress
from pathlib import Path
from typing import Annotated

import typer

from botschool.cli_rl import rl
from botschool.cli_tournament import post_evaluate, tournament
from botschool.errors import BotschoolError

UsageError = typer.BadParameter.__base__

app = typer.Typer(
    help="Train robots in simulation by evolution and by reinforcement learning.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="markdown",
    pretty_exceptions_enable=False,
)
app.add_typer(rl, name="rl")

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


Submission = Annotated[
    str | None,
    typer.Option(help="Grade another folder; `solutions` is the reference.", metavar="FOLDER"),
]
GradingWorkers = Annotated[
    int | None,
    typer.Option(
        "-w", "--workers", min=1, max=1024, help="Submissions at a time.", show_default="all cores"
    ),
]


@app.callback()
def botschool() -> None:
    pass


@app.command(epilog="Example: botschool es -f data/experiments/acrobot.ini -s 11 -w 2 -o results")
def es(
    file: Experiment = None,
    seed: Annotated[int, typer.Option("-s", "--seed", min=0, max=2**62, help="Seed.")] = 1,
    replications: Annotated[
        int,
        typer.Option(
            "-n", "--replications", min=1, max=100_000, help="Runs, with consecutive seeds."
        ),
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
        str | None,
        typer.Option(
            "-g",
            "--genotype",
            help="With -p: a saved robot; for coevo2 also P-100-5 and the like, see above.",
            metavar="FILE",
        ),
    ] = None,
    neurons: Annotated[
        bool, typer.Option("-d", "--neurons", help="With -p: show the neurons' activations.")
    ] = False,
    steps: Annotated[
        int | None, typer.Option(min=1, help="Stop after so many steps (--resume goes on).")
    ] = None,
    generations: Annotated[
        int | None, typer.Option(min=1, help="Stop after so many generations, likewise.")
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
            help="With -p: a page that plays the episodes in a browser, as "
            "`es -f acrobot.ini -p -g bestgS1.npy --replay acrobot.html`.",
            metavar="FILE",
        ),
    ] = None,
    episodes: Annotated[
        int | None, typer.Option(min=1, help="With -p: episodes to evaluate or show.")
    ] = None,
) -> None:
    """Evolve robots, or look at an evolved one (-p). Without -f: list all hyperparameters.

    For predators and prey (coevo2) -g may also be, with -o naming the folder of the run:

    - `P-100-5`: watch the 5 best predators of generation 100 chase its 5 best prey;
      `p-100-5`: only measure them
    - `m-100-20`: measure generation 100 against those of generations 100, 80, 60 ... that are
      saved; `M-100-20`: measure all of these against each other
    - `c-FILE1-FILE2`: measure the populations of two runs against each other

    As in: botschool es -f predprey.ini -s 12 -o results -p -g m-100-20
    """
    if file is None:
        if post or genotype or video or replay or resume or force:
            raise BotschoolError("Say which experiment: add -f FILE.ini.")
        _list_hyperparameters()
        return
    from botschool import config

    experiment = config.load(file)
    if replay and not (post or genotype):
        raise BotschoolError("--replay shows a robot: add -p, and -g FILE for a saved one.")
    if post or genotype or video or render or neurons:
        from botschool.render.watch import Watching

        watching = Watching(neurons, render, video, replay, episodes)
        post_evaluate(experiment, seed, genotype, output, workers, watching)
        return
    from botschool.evolution.replicate import replicate

    if resume and force:
        raise BotschoolError("--resume continues a run and --force replaces it: give one of them.")
    seeds = list(range(seed, seed + replications))
    terminal = sys.stdout.isatty()
    if not replicate(
        experiment, seeds, output, workers, steps, resume, force, terminal, generations
    ):
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


app.command(epilog="Example: botschool tournament results -f predprey.ini -o tournament.png")(
    tournament
)


@app.command(epilog="Example: botschool showrobot ant --sheet ant.png")
def showrobot(
    name: Annotated[
        str,
        typer.Argument(help="A locomotor, balancebot, or a .urdf or .xml file.", metavar="NAME"),
    ],
    video: Annotated[
        Path | None, typer.Option(help="A film of each joint's range.", metavar="FILE")
    ] = None,
    sheet: Annotated[
        Path | None, typer.Option(help="A picture of each joint's range.", metavar="FILE")
    ] = None,
) -> None:
    """Show a robot: a window with a slider for each joint and for gravity, a film or a sheet."""
    from botschool.render.showrobot import show_robot

    show_robot(name, video, sheet)


@app.command(epilog="Example: botschool grade 3, or botschool grade 3.2 for one task")
def grade(
    what: Annotated[str, typer.Argument(help="Exercise N or task N.T.", metavar="N[.T]")],
    submission: Submission = None,
    json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
    debug: Annotated[
        bool, typer.Option(help="One task in this process, without points, for breakpoints.")
    ] = False,
) -> None:
    """Grade your solution of an exercise, or of one task."""
    from botschool.grading.commands import grade_command

    if not grade_command(what, submission, json, debug):
        raise typer.Exit(1)


@app.command(epilog="Example: botschool hint 3.2")
def hint(
    task: Annotated[str, typer.Argument(help="Task N.T.", metavar="N.T")],
) -> None:
    """Show one more hint for a task, each time it is called."""
    from botschool.grading.commands import hint_command

    hint_command(task)


@app.command(epilog="Example: botschool progress")
def progress(workers: GradingWorkers = None) -> None:
    """Show your points in all exercises, and what comes next."""
    from botschool.grading.commands import progress_command

    progress_command(workers)


@app.command(epilog="Example: botschool watch 3, or botschool watch 3.2 for one task")
def watch(
    what: Annotated[str, typer.Argument(help="Exercise N or task N.T.", metavar="N[.T]")],
    submission: Submission = None,
) -> None:
    """Grade again whenever you save; Ctrl-C ends."""
    from botschool.grading.commands import watch_command

    watch_command(what, submission)


@app.command(epilog="Example: botschool release ../course-for-students")
def release(
    folder: Annotated[Path, typer.Argument(help="A new folder.", metavar="FOLDER")],
) -> None:
    """For instructors: make a copy of the repository for students, without solutions."""
    from botschool.grading.commands import release_command

    release_command(folder)


@app.command("grade-all", epilog="Example: botschool grade-all submissions --exercise 3 -o grades")
def grade_all(
    folder: Annotated[
        Path, typer.Argument(help="Holds a sub-folder per student.", metavar="FOLDER")
    ],
    exercise: Annotated[
        str, typer.Option("-e", "--exercise", help="A number, or all.", metavar="N")
    ] = "all",
    output: Annotated[
        Path, typer.Option("-o", "--output", help="Folder of table and feedback.", metavar="FOLDER")
    ] = Path("results/grades"),
    workers: GradingWorkers = None,
    fresh: Annotated[
        bool, typer.Option("--fresh", help="Grade again what has not changed since.")
    ] = False,
) -> None:
    """For instructors: grade a class into a table and a page of feedback per student."""
    from botschool.grading.commands import grade_all_command

    grade_all_command(folder, output, exercise, workers, fresh)


@app.command(epilog="Example: botschool nbgrader results/nbgrader")
def nbgrader(
    folder: Annotated[
        Path, typer.Argument(help="The course folder to make or bring up to date.", metavar="DIR")
    ] = Path("results/nbgrader"),
) -> None:
    """For instructors: make a course folder for nbgrader, with the exercises as notebooks."""
    from botschool.grading.nbgrader import nbgrader_command

    nbgrader_command(folder)


@app.command()
def skeletons() -> None:
    """Generate the exercises' skeletons from the solutions (edited files are left alone)."""
    from botschool.grading.exercise import course_root
    from botschool.grading.skeleton import write_skeletons

    for path in write_skeletons(course_root()):
        print(f"left alone, because it was edited: {path}")


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


def main() -> None:
    """Runs the command; errors for learners are one sentence and exit code 2."""
    with suppress(AttributeError):  # in a notebook
        sys.stdout.reconfigure(errors="backslashreplace")  # names that the terminal cannot show
    try:
        code = app(standalone_mode=False) or 0
        sys.stdout.flush()
    except BotschoolError as error:
        code = _refuse(str(error))
    except UsageError as error:
        message = " ".join(error.format_message().split()).rstrip(".")
        command = error.ctx.command_path.removeprefix("python -m ") if error.ctx else "botschool"
        code = _refuse(f"{message}: see {command} --help.") if message else 2
    except MemoryError:
        code = _refuse(
            "There is not enough memory: lower samplesize, popsize, nhiddens or the number of "
            "workers (-w)."
        )
    except (KeyboardInterrupt, typer.Abort):
        code = 130
    except BrokenPipeError:
        code = _silence(1)
    except OSError as error:
        place = error.filename or "Standard output"
        code = _refuse(
            f"{place} cannot be read or written ({error.strerror or error}): free some space or "
            "choose another place."
        )
        code = _silence(code)
    if code == 130:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # impatience is no error
    sys.exit(code)


def _refuse(sentence: str) -> int:
    print(f"error: {sentence}", file=sys.stderr)
    return 2


def _silence(code: int) -> int:
    """Drops what the interpreter would still print to a broken standard output at its end."""
    with suppress(OSError):
        sys.stdout.flush()
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return code
