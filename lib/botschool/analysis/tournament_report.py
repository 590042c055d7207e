"""Report a tournament: tables on the screen, a picture and a CSV file."""

from __future__ import annotations

import csv
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from rich import box
from rich.table import Table as Grid

from botschool.analysis.figure import PICTURE_SUFFIXES, new_figure, tidy
from botschool.analysis.tournament import (
    ROLES,
    Estimate,
    Table,
    in_words,
    interval,
    progress,
    verdict,
)
from botschool.console import Console
from botschool.output import check_output, save_bytes

# --- Tournaments as text: tables and sentences for a terminal or a file.


MAX_COLUMNS = 11
"""Generations or individuals that a table shows in a row."""


def print_roles(roles: str) -> None:
    """Print what predators and prey are, unless it is obvious."""
    if roles:
        print(roles)


def print_pairs(fitness: np.ndarray, tables: tuple[Table, Table], name: str) -> None:
    """Print each predator of a generation against each prey: fitness (n, n) or (2, n, n)."""
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
    """Print one generation against several: the first row of predators and of prey."""
    grid = _grid(f"{name} against competitors of its own time and before: mean fitness")
    _columns(grid, ["competitors of", "its predators", "its prey"])
    for j, other in enumerate(names):
        grid.add_row(other, _cell(predators, 0, j), _cell(prey, 0, j))
    _print(grid)


def print_cross(tables: tuple[Table, Table], names: Sequence[str]) -> None:
    """Print a cross test of two runs: their predators and prey against both runs', and who wins."""
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
    """Print all against all: for each side the means, each generation in brief, and the verdict."""
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
    """Return each generation against the competitors before it, of its own time, and after it."""
    grid = _grid(f"{table.role} against {other} of other times: mean fitness, 95 % interval")
    _columns(grid, ["generation", "before it", "its own", "after it"])
    for i in spaced(len(numbers), MAX_COLUMNS):
        parts = [slice(0, i), slice(i, i + 1), slice(i + 1, None)]
        cells = [_estimate(table.mean[i, part], table.samples[:, i, part]) for part in parts]
        grid.add_row(numbers[i], *cells)
    return grid


@contextmanager
def progress_bar(total: int) -> Iterator[Callable[[int], None]]:
    """Yield a function to call with the generations done; on a terminal it moves a bar."""
    if not sys.stdout.isatty():
        yield lambda done: None
        return
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TimeRemainingColumn

    columns = ("generations", BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(compact=True))
    with Progress(*columns, console=Console()) as bar:
        task = bar.add_task("", total=total)
        yield lambda done: bar.update(task, completed=done)


def spaced(count: int, most: int) -> list[int]:
    """Return at most `most` of `count` indices, evenly spaced, including the first and the last."""
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
    """Add the columns: first the texts, then the numbers."""
    for place, name in enumerate(names):
        grid.add_column(name, justify="left" if place < texts else "right", no_wrap=True)


def _print(grid: Grid) -> None:
    console = Console(highlight=False)
    if not sys.stdout.isatty():  # a file has room for every column
        console.width = max(console.width, 200)
    console.print(f"\n{grid.title}", markup=False, soft_wrap=True)
    grid.title = None
    console.print(grid)


# --- A master tournament as one picture, with its numbers beside it as CSV.


if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure

COLOURS = {"predators": "#D55E00", "prey": "#0072B2"}
"""As in the pictures of the arena."""
PROFILES = 4
"""Generations whose profile is drawn."""
MAX_NUMBERS = 12
"""Larger heat maps have no numbers in their cells."""
CSV_COLUMNS = ("side", "generation", "competitors", "fitness", "low", "high")


def check_files(picture: Path) -> tuple[Path, Path]:
    """Return the files of picture and CSV. Raises BotschoolError if they cannot be written."""
    return check_output(picture, PICTURE_SUFFIXES), check_output(
        picture.with_suffix(".csv"), (".csv",)
    )


def save_csv(path: Path, tables: tuple[Table, Table], generations: Sequence[int]) -> None:
    """Write a row for each side, generation and competing generation: mean and 95 % interval."""
    text = StringIO()
    rows = csv.writer(text, lineterminator="\n")
    rows.writerow(CSV_COLUMNS)
    for table in tables:
        low, high = table.interval
        for i, own in enumerate(generations):
            for j, other in enumerate(generations):
                numbers = (table.mean[i, j], low[i, j], high[i, j])
                rows.writerow([table.role, own, other, *(f"{number:.6f}" for number in numbers)])
    save_bytes(path, text.getvalue().encode())


def draw(
    tables: tuple[Table, Table],
    generations: Sequence[int],
    title: str,
    output: Path | None = None,
) -> None:
    """Draw heat maps, profiles, fitness against all and progress, to a file or the screen.

    generations: of the tables' rows and columns, at least two. Raises BotschoolError.
    """
    with new_figure(output, height=13.0, width=11.5) as page:
        page.suptitle(title, fontsize=15)
        maps, profiles, indices = page.subfigures(3, 1, height_ratios=(1.15, 0.85, 0.65))
        _draw_maps(maps, tables, generations)
        _draw_profiles(profiles, tables, generations)
        left, right = indices.subplots(1, 2, width_ratios=(1.0, 1.0))
        _draw_overall(left, tables, generations)
        _draw_progress(right, tables)


def _other(table: Table) -> str:
    return ROLES[1 - ROLES.index(table.role)]


def _one_scale(tables: tuple[Table, Table]) -> bool:
    """Return whether all fitness is from 0 to 1; otherwise each side has a scale of its own."""
    return all(table.mean.min() >= 0 and table.mean.max() <= 1 for table in tables)


def _draw_maps(page: Figure | SubFigure, tables: tuple[Table, Table], generations) -> None:
    shared = _one_scale(tables)
    panels = page.subplots(1, 2)
    for axes, table in zip(panels, tables, strict=True):
        scaled = tables if shared else (table,)
        low = min(each.mean.min() for each in scaled)
        high = max(each.mean.max() for each in scaled)
        picture = axes.imshow(table.mean, cmap="viridis", vmin=low, vmax=high, origin="lower")
        axes.set_title(f"fitness of the {table.role}")
        axes.set_xlabel(f"generation of the {_other(table)}: ancient to the left")
        axes.set_ylabel(f"generation of the {table.role}")
        ticks = spaced(len(generations), 11)
        axes.set_xticks(ticks, [generations[i] for i in ticks])
        axes.set_yticks(ticks, [generations[i] for i in ticks])
        if len(generations) > 6:
            axes.tick_params(axis="x", rotation=45)
        _frame_contemporaries(axes, len(generations))
        if len(generations) <= MAX_NUMBERS:
            _write_numbers(axes, table.mean, (low + high) / 2)
        if not shared:
            page.colorbar(picture, ax=axes, label="mean fitness", fraction=0.045, pad=0.02)
    if shared:
        page.colorbar(picture, ax=panels, label="mean fitness", fraction=0.03, pad=0.02)


def _frame_contemporaries(axes: Axes, count: int) -> None:
    from matplotlib.patches import Rectangle

    for i in range(count):
        axes.add_patch(Rectangle((i - 0.5, i - 0.5), 1, 1, fill=False, ec="white", lw=1.4))


def _write_numbers(axes: Axes, mean: np.ndarray, middle: float) -> None:
    form = ".2f" if np.abs(mean).max() < 10 else ".0f"
    for (row, column), value in np.ndenumerate(mean):
        axes.text(
            column,
            row,
            re.sub(r"^0\.", ".", f"{value:{form}}"),
            ha="center",
            va="center",
            fontsize=9,
            color="black" if value > middle else "white",
        )


def _draw_profiles(page: Figure | SubFigure, tables: tuple[Table, Table], generations) -> None:
    from matplotlib import colormaps

    shared = _one_scale(tables)
    panels = page.subplots(1, 2, sharey=shared)
    chosen = spaced(len(generations), PROFILES)
    # Single hues from light to dark: later generations are darker.
    hues = {"predators": colormaps["Oranges"], "prey": colormaps["Blues"]}
    for axes, table in zip(panels, tables, strict=True):
        low, high = table.interval
        for place, i in enumerate(chosen):
            colour = hues[table.role](0.4 + 0.6 * place / (len(chosen) - 1))
            axes.fill_between(generations, low[i], high[i], color=colour, alpha=0.15, lw=0)
            label = f"generation {generations[i]}"
            axes.plot(generations, table.mean[i], color=colour, lw=2, label=label)
            axes.plot(
                generations[i], table.mean[i, i], "o", color=colour, ms=8, mec="black", zorder=3
            )
        axes.set_title(f"{table.role} against ancient and future {_other(table)}")
        axes.set_xlabel(f"generation of the {_other(table)} (dot: of the same generation)")
        tidy(axes)
        if shared:
            axes.set(ylim=(-0.05, 1.25), yticks=np.linspace(0, 1, 6))  # leave room for the legend
        else:
            bottom, top = axes.get_ylim()
            axes.set_ylim(bottom, top + 0.2 * (top - bottom))
        axes.legend(frameon=False, fontsize=9, loc="upper center", ncols=2)
    panels[0].set_ylabel("mean fitness, 95 % interval")


def _draw_overall(axes: Axes, tables: tuple[Table, Table], generations) -> None:
    """Draw the fitness of each generation against the competitors of all generations."""
    for table in tables:
        colour = COLOURS[table.role]
        low, high = interval(table.samples.mean(axis=-1))
        axes.fill_between(generations, low, high, color=colour, alpha=0.15, lw=0)
        mean = table.mean.mean(axis=-1)
        axes.plot(generations, mean, "o-", color=colour, lw=2, ms=4, label=table.role)
    axes.set_title("against competitors of all generations")
    axes.set_xlabel("generation")
    axes.set_ylabel("mean fitness, 95 % interval")
    tidy(axes)
    axes.legend(frameon=False)


def _draw_progress(axes: Axes, tables: tuple[Table, Table]) -> None:
    """Draw both indices of both sides as dots with their intervals; 0 is no progress."""
    labels, row = [], 0
    for table in tables:
        for name, estimate in progress(table).items():
            colour = COLOURS[table.role]
            axes.plot([estimate.low, estimate.high], [row, row], color=colour, lw=3, alpha=0.5)
            axes.plot(estimate.value, row, "o", color=colour, ms=8)
            axes.annotate(
                f"{estimate.value:+.2f}",
                (estimate.value, row),
                xytext=(0, 8),
                textcoords="offset points",
                ha="center",
            )
            labels.append(f"{table.role},\n{name}")
            row += 1
    axes.axvline(0.0, color="black", lw=0.9)
    axes.set_yticks(range(row), labels)
    axes.set_ylim(row - 0.5, -0.7)
    axes.margins(x=0.15)
    axes.set_title("progress: above 0, later generations do better")
    axes.set_xlabel("gain of a later over an earlier generation, in fitness")
    tidy(axes, "x")
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)
