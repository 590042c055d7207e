"""Define `botschool examples` and `botschool problems`, which show what botschool has."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()


@app.command(epilog="Example: botschool examples acrobot.ini acrobot.npy -o my-folder")
def examples(
    names: Annotated[
        list[str] | None, typer.Argument(help="Files to copy.", metavar="NAME")
    ] = None,
    folder: Annotated[
        Path, typer.Option("-o", "--output", help="Folder to copy them to.", metavar="FOLDER")
    ] = Path("."),
) -> None:
    """List the experiments, robots and agents of botschool, or copy some."""
    from botschool import examples as ours

    if names:
        for path in ours.copy(names, folder):
            print(f"made: {path}")
        return
    from rich.markup import escape
    from rich.table import Table

    from botschool.console import Console

    console = Console(highlight=False)
    table = Table(box=None, pad_edge=False, header_style="dim")
    table.add_column("experiment", no_wrap=True)
    table.add_column("evolved robot", no_wrap=True)
    table.add_column("what it evolves")
    robots = ours.examples(ours.ROBOTS)
    for name, path in ours.examples("experiments").items():
        robot = path.with_suffix(".npy").name
        table.add_row(name, robot if robots.pop(robot, None) else "", escape(ours.purpose(path)))
    console.print(table)
    console.print(f"\n[dim]more robots:[/] {', '.join(robots)}")
    console.print("[dim]trained agents:[/] botschool rl list --ours")
    console.print(
        "\nTo evolve: botschool es -f acrobot.ini -s 1 -o results/acrobot\n"
        "To watch:  botschool es -f planarhopper.ini -p -g planarhopper.npy\n"
        "To change: botschool examples acrobot.ini copies the file here",
        soft_wrap=True,
    )


@app.command(epilog="Example: botschool problems PlanarHopper-v5")
def problems(
    name: Annotated[
        str | None, typer.Argument(help="A native problem, or an experiment file.", metavar="NAME")
    ] = None,
) -> None:
    """List the native problems, or the quantities of one that `reward` and `ends` may name."""
    from rich.table import Table

    from botschool.console import Console
    from botschool.interface.problem import problem
    from botschool.problems.native import NATIVE

    console = Console(highlight=False)
    if name is None:
        console.print(", ".join(NATIVE), soft_wrap=True)
        console.print("\nbotschool problems PlanarHopper-v5 lists what its rewards may name.")
        return
    rows = problem(name).quantities()
    table = Table(box=None, pad_edge=False, header_style="dim")
    table.add_column("quantity", no_wrap=True)
    table.add_column("unit", no_wrap=True)
    table.add_column("what it is")
    for row in rows:
        table.add_row(*row)
    console.print(table)
    console.print("\nIn an experiment file: reward = ..., ends = ... (docs/experiments.md)")
