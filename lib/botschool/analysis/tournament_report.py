"""Tournaments as text: tables and sentences for a terminal or a file."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

import numpy as np
from rich import box
from rich.console import Console
from rich.table import Table as Grid

from botschool.analysis.tournament import ROLES, Estimate, Table, in_words, verdict

MAX_COLUMNS = 11
"""Generations or individuals that a table shows side by side."""


def print_roles(roles: str) -> None:
    """Who predators and prey are, if it has to be said."""
    if roles:
        print(roles)


def print_pairs(fitness: np.ndarray, tables: tuple[Table, Table], name: str) -> None:
    """Each predator of a generation against each prey: the predators' fitness, (n, n), or that of
    both sides, (2, n, n)."""
    if fitness.shape[-1] <= MAX_COLUMNS:
        if fitness.ndim == 2:
            _print_pairs(fitness, f"{name}: fitness of predators (rows) against prey (columns)")
        else:
            _print_pairs(fitness[0], f"{name}: fitness of predators (rows) against prey (columns)")
            _print_pairs(fitness[1], f"{name}: fitness of these prey (columns)")
    for table in tables:
        words = in_words(Estimate.of(table.mean[0, 0], table.samples[:, 0, 0]))
        if fitness.shape[-1] == 1:
            words = _number(table.mean[0, 0])
        print(f"mean fitness of the {table.role}: {words}")


def _print_pairs(fitness: np.ndarray, title: str) -> None:
    grid = _grid(title)
    _columns(grid, ["", *(str(j + 1) for j in range(len(fitness))), "all"])
    for i, row in enumerate(fitness):
        grid.add_row(str(i + 1), *map(_number, row), _number(row.mean()))
    means = fitness.mean(axis=0)
    grid.add_row("all", *map(_number, means), _number(means.mean()))
    _print(grid)


def print_row(predators: Table, prey: Table, name: str, names: Sequence[str]) -> None:
    """One generation against several: the predators' first row, and the prey's."""
    grid = _grid(f"{name} against competitors of its own time and before: mean fitness")
    _columns(grid, ["competitors of", "its predators", "its prey"])
    for j, other in enumerate(names):
        grid.add_row(other, _cell(predators, 0, j), _cell(prey, 0, j))
    _print(grid)


def print_cross(tables: tuple[Table, Table], names: Sequence[str]) -> None:
    """Two runs: predators and prey of each against those of both, and who is better."""
    predators, prey = tables
    letters = ("A", "B")
    for letter, name in zip(letters, names, strict=True):
        print(f"{letter} is {name}")
    grid = _grid("cross test: mean fitness")
    _columns(grid, ["predators of", "prey of", "of these predators", "of these prey"], 2)
    for i, hunter in enumerate(letters):
        for j, hunted in enumerate(letters):
            grid.add_row(hunter, hunted, _cell(predators, i, j), _cell(prey, j, i))
    _print(grid)
    for table, other in zip(tables, ROLES[::-1], strict=True):
        overall, samples = table.mean.mean(axis=-1), table.samples.mean(axis=-1)
        gap = Estimate.of(overall[1] - overall[0], samples[:, 1] - samples[:, 0])
        print(f"{table.role} of B minus those of A, against all {other}: {in_words(gap, '+')}")


def print_tournament(tables: tuple[Table, Table], names: Sequence[str]) -> None:
    """All against all: per side the means, each generation in brief, and the verdict."""
    numbers = [name.removeprefix("generation ") for name in names]
    for table, other in zip(tables, ROLES[::-1], strict=True):
        _print(_means(table, other, numbers))
        _print(_brief(table, other, numbers))
    for table in tables:
        print(verdict(table, names))


def _means(table: Table, other: str, numbers: Sequence[str]) -> Grid:
    chosen = spaced(len(numbers), MAX_COLUMNS)
    title = f"{table.role} (rows, by generation) against {other} (columns): mean fitness"
    if len(chosen) < len(numbers):
        title += f"; {len(chosen)} of {len(numbers)} generations"
    grid = _grid(title)
    _columns(grid, ["", *(numbers[j] for j in chosen), "all"])
    for i in chosen:
        cells = [_number(table.mean[i, j]) for j in chosen]
        grid.add_row(numbers[i], *cells, _number(table.mean[i].mean()))
    return grid


def _brief(table: Table, other: str, numbers: Sequence[str]) -> Grid:
    """Each generation against the competitors before it, of its own time, and after it."""
    grid = _grid(f"{table.role} against {other} of other times: mean fitness, 95 % interval")
    _columns(grid, ["generation", "before it", "its own", "after it"])
    for i in spaced(len(numbers), MAX_COLUMNS):
        parts = [slice(0, i), slice(i, i + 1), slice(i + 1, None)]
        cells = [_estimate(table.mean[i, part], table.samples[:, i, part]) for part in parts]
        grid.add_row(numbers[i], *cells)
    return grid


@contextmanager
def progress_bar(total: int) -> Iterator[Callable[[int], None]]:
    """Gives a function to call with the generations done; a bar where there is a terminal."""
    if not sys.stdout.isatty():
        yield lambda done: None
        return
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TimeRemainingColumn

    columns = ("generations", BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(compact=True))
    with Progress(*columns) as bar:
        task = bar.add_task("", total=total)
        yield lambda done: bar.update(task, completed=done)


def spaced(count: int, most: int) -> list[int]:
    """At most so many of `count` places, evenly spaced, the first and the last among them."""
    if count <= most:
        return list(range(count))
    return [round(place) for place in np.linspace(0, count - 1, most)]


def _estimate(mean: np.ndarray, samples: np.ndarray) -> str:
    if not mean.size:
        return "-"
    estimate = Estimate.of(mean.mean(), samples.mean(axis=1))
    return f"{estimate.value:.2f} ({estimate.low:.2f} to {estimate.high:.2f})"


def _cell(table: Table, row: int, column: int) -> str:
    return _estimate(table.mean[row, [column]], table.samples[:, row, [column]])


def _number(value: float) -> str:
    return f"{value:.2f}"


def _grid(title: str) -> Grid:
    return Grid(
        title=title, box=box.SIMPLE, title_justify="left", collapse_padding=True, pad_edge=False
    )


def _columns(grid: Grid, names: Sequence[str], texts: int = 1) -> None:
    """The first columns are texts, the others numbers."""
    for place, name in enumerate(names):
        grid.add_column(name, justify="left" if place < texts else "right", no_wrap=True)


def _print(grid: Grid) -> None:
    console = Console(highlight=False)
    if not sys.stdout.isatty():  # a file has room for every column
        console.width = max(console.width, 200)
    console.print(f"\n{grid.title}", markup=False, soft_wrap=True)
    grid.title = None
    console.print(grid)
