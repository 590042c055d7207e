"""Define `botschool lab N`, for students' own experiments, and the league's commands."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()
MAX_REFUSED = 50
"""Files that the league names because they are no entries."""


@app.command(epilog="Example: botschool lab 9 start, then lab 9 run, lab 9 check, lab 9 report")
def lab(
    number: Annotated[str, typer.Argument(help="Laboratory N.", metavar="N")],
    action: Annotated[
        str, typer.Argument(help="start, run, check or report.", metavar="ACTION")
    ] = "check",
    name: Annotated[
        str | None, typer.Option(help="start: your name; the command asks if you leave it out.")
    ] = None,
    course: Annotated[
        str | None, typer.Option(help="start: your course's name.", show_default="botschool")
    ] = None,
    quick: Annotated[
        bool, typer.Option("--quick", help="run: make short runs, for a first look.")
    ] = False,
    workers: Annotated[
        int, typer.Option("-w", "--workers", min=1, max=1024, help="run: cores to use.")
    ] = 1,
    submission: Annotated[
        Path | None,
        typer.Option(help="check: another person's folder or zip file.", metavar="FOLDER"),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="check: print the result as JSON.")] = False,
) -> None:
    """Do a laboratory: predict, run, measure, draw, conclude; the evidence earns the points.

    - `start` makes its folder with sheet.md, measure.py and figure.py
    - `run` makes the runs after you have written the prediction; it continues where it stopped
    - `check` gives points for each part
    - `report` checks and writes report.html
    """
    from botschool.errors import BotschoolError
    from botschool.labs import commands

    if action == "start":
        commands.start_command(number, name, course)
    elif action == "run":
        if not commands.run_command(number, quick, workers):
            raise typer.Exit(130)
    elif action == "check":
        if not commands.check_command(number, json, submission):
            raise typer.Exit(1)
    elif action == "report":
        commands.report_command(number)
    else:
        raise BotschoolError(
            f"The laboratory has no action {action}: use start, run, check or report."
        )


@app.command(epilog="Example: botschool enter 'lab09/runs/bonus 0/bestgS7.npy' --name Ada")
def enter(
    genotype: Annotated[
        Path, typer.Argument(help="A bestgS*.npy file of a run.", metavar="GENOTYPE")
    ],
    file: Annotated[
        Path | None,
        typer.Option(
            "-f",
            "--file",
            help="The run's experiment (.ini).",
            metavar="FILE",
            show_default="the experiment of the laboratory",
        ),
    ] = None,
    name: Annotated[
        str, typer.Option(help="Your name on the league's page; without it you stay anonymous.")
    ] = "",
    output: Annotated[
        Path | None, typer.Option("-o", "--output", help="The entry.", metavar="FILE")
    ] = None,
) -> None:
    """Make an entry for the league: one small file with your robot."""
    from botschool.labs.entries import write_entry

    path = write_entry(genotype, file, name, output)
    print(f"entry: {path} ({path.stat().st_size / 1000:.0f} kB), {name or 'anonymous'}")


@app.command(epilog="Example: botschool league entries -o results/league.html")
def league(
    folder: Annotated[Path, typer.Argument(help="Folder of entries.", metavar="FOLDER")],
    output: Annotated[
        Path,
        typer.Option(
            "-o", "--output", help="Page to write, with a .csv beside it.", metavar="FILE"
        ),
    ] = Path("results/league.html"),
    title: Annotated[str, typer.Option(help="The page's heading.")] = "The league",
) -> None:
    """For instructors: let all robots compete, and write a page of the results.

    Hoppers, walkers and cheetahs run for metres, cart-poles balance longer and longer poles, and
    all predators chase all prey. The command measures every robot itself.
    """
    from botschool.grading.run.temporary import temporary_folder
    from botschool.labs.league import compete, results_csv
    from botschool.labs.league_page import write_page
    from botschool.output import save_bytes

    found = compete(folder, print)
    output.parent.mkdir(parents=True, exist_ok=True)
    with temporary_folder() as temporary:
        write_page(found, output, temporary, title)
    table = output.with_suffix(".csv")
    save_bytes(table, results_csv(found))
    print(*found.equal, sep="\n", end="\n" if found.equal else "")
    for sentence in found.refused[:MAX_REFUSED]:
        print(f"not in the league: {sentence}")
    if more := found.refused[MAX_REFUSED:]:
        print(f"not in the league: {len(more)} more files")
    print(f"Page: {output}   Table: {table}")
