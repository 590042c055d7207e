"""Tables of measurements: on a screen, as Markdown, or as plain data."""

from __future__ import annotations

import os
import platform
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import gymnasium
import numpy as np
from rich.console import Console
from rich.table import Table as Grid

REPOSITORY = Path(__file__).parents[2]


@dataclass
class Table:
    """A title, what is compared with what, and both sides in columns; cells are text."""

    title: str
    about: str
    columns: list[str]
    rows: list[list[str]] = field(default_factory=list)
    numbers: dict = field(default_factory=dict)
    """What a figure is drawn from, where there is one."""

    def add(self, *cells: str) -> None:
        """Appends a row, one cell a column."""
        self.rows.append([str(cell) for cell in cells])

    def show(self, markdown: bool) -> None:
        """Prints it."""
        if markdown:
            print(f"### {self.title}\n\n{self.about}\n")
            print(self.markdown() + "\n")
            return
        grid = Grid()
        for i, column in enumerate(self.columns):
            grid.add_column(column, justify="right" if i else "left", no_wrap=not i)
        for row in self.rows:
            grid.add_row(*[_coloured(cell) for cell in row])
        console = Console(width=None if os.isatty(1) else 120)
        console.print(self.title, style="bold")
        console.print(grid)
        console.print(self.about + "\n", style="dim", highlight=False)

    def markdown(self) -> str:
        """Only the table, as Markdown."""
        rule = ["---"] + ["---:"] * (len(self.columns) - 1)
        lines = [self.columns, rule, *self.rows]
        return "\n".join("| " + " | ".join(line) + " |" for line in lines)


PASS, SHORT = "PASS", "FALLS SHORT"


def verdict(reached: bool) -> str:
    """The word for a target that is reached, or is not."""
    return PASS if reached else SHORT


def _coloured(cell: str) -> str:
    colour = {PASS: "green", SHORT: "red"}.get(cell)
    return f"[{colour}]{cell}[/]" if colour else cell


def rate(steps_per_second: float) -> str:
    """A number of steps per second, three digits of it: 45.3 M, 30.5 k."""
    unit, name = (1e6, "M") if steps_per_second >= 1e6 else (1e3, "k")
    return f"{steps_per_second / unit:.3g} {name}"


def commit() -> str:
    """That of the checkout; it says so if code or experiments have been changed since."""

    def git(*arguments: str) -> str:
        done = subprocess.run(
            ["git", *arguments], cwd=REPOSITORY, capture_output=True, text=True, check=True
        )
        return done.stdout.strip()

    changed = git("status", "--porcelain", "--untracked-files=no", "--", ".", ":!docs")
    return git("rev-parse", "--short=10", "HEAD") + (" with changes" if changed else "")


def machine() -> str:
    """The machine in general terms, and the versions that matter."""
    return (
        f"{os.cpu_count()} cores ({_processor()}), {platform.system()}, "
        f"Python {platform.python_version()}, numpy {np.__version__}, "
        f"Gymnasium {gymnasium.__version__}"
    )


def _processor() -> str:
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            names = [line.split(":", 1)[1].strip() for line in file if "model name" in line]
        return names[0]
    except (OSError, IndexError):
        return platform.processor() or platform.machine()
