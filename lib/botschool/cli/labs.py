"""`botschool lab N`: experiments of one's own, checked by doing them again."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()


@app.command(epilog="Example: botschool lab 9 start, then lab 9 run, lab 9 check, lab 9 report")
def lab(
    number: Annotated[str, typer.Argument(help="Laboratory N.", metavar="N")],
    action: Annotated[
        str, typer.Argument(help="start, run, check or report.", metavar="ACTION")
    ] = "check",
    name: Annotated[
        str | None, typer.Option(help="start: your name; asked for once otherwise.")
    ] = None,
    course: Annotated[
        str | None, typer.Option(help="start: your course's name.", show_default="botschool")
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="run: short runs, for a look.")] = False,
    workers: Annotated[
        int, typer.Option("-w", "--workers", min=1, max=1024, help="run: cores to use.")
    ] = 1,
    submission: Annotated[
        Path | None,
        typer.Option(help="check: somebody else's folder or zip file.", metavar="FOLDER"),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="check: print the result as JSON.")] = False,
) -> None:
    """Do a laboratory: predict, run, measure, draw, conclude; the evidence earns the points.

    - `start` makes its folder with sheet.md, measure.py and figure.py
    - `run` makes the runs, once the prediction is written; it goes on where it stopped
    - `check` gives points, part by part
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
        raise BotschoolError(f"lab has no action {action}: write start, run, check or report.")
