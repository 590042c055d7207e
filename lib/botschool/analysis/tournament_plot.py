"""A master tournament as one picture, with its numbers beside it as CSV."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from botschool.analysis.plots import PICTURE_SUFFIXES, new_figure
from botschool.analysis.tournament import ROLES, Table, interval, progress
from botschool.analysis.tournament_report import spaced
from botschool.output import check_output, save_bytes

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
    """The picture and the CSV file beside it; raises BotschoolError if they cannot be written."""
    return check_output(picture, PICTURE_SUFFIXES), check_output(
        picture.with_suffix(".csv"), (".csv",)
    )


def save_csv(path: Path, tables: tuple[Table, Table], generations: Sequence[int]) -> None:
    """A row for each side, generation and generation of competitors: mean and 95 % interval."""
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
    """Heat maps, profiles, fitness against everybody and progress; to a file or the screen.

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
    """Whether all fitness is from 0 to 1; otherwise each side has a scale of its own."""
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
    # Single hues from light to dark, so that later generations are the darker ones.
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
        _tidy(axes)
        if shared:
            axes.set(ylim=(-0.05, 1.25), yticks=np.linspace(0, 1, 6))  # with room for the legend
        else:
            bottom, top = axes.get_ylim()
            axes.set_ylim(bottom, top + 0.2 * (top - bottom))
        axes.legend(frameon=False, fontsize=9, loc="upper center", ncols=2)
    panels[0].set_ylabel("mean fitness, 95 % interval")


def _draw_overall(axes: Axes, tables: tuple[Table, Table], generations) -> None:
    """Fitness of each generation against the competitors of all generations."""
    for table in tables:
        colour = COLOURS[table.role]
        low, high = interval(table.samples.mean(axis=-1))
        axes.fill_between(generations, low, high, color=colour, alpha=0.15, lw=0)
        mean = table.mean.mean(axis=-1)
        axes.plot(generations, mean, "o-", color=colour, lw=2, ms=4, label=table.role)
    axes.set_title("against competitors of all generations")
    axes.set_xlabel("generation")
    axes.set_ylabel("mean fitness, 95 % interval")
    _tidy(axes)
    axes.legend(frameon=False)


def _draw_progress(axes: Axes, tables: tuple[Table, Table]) -> None:
    """Both indices of both sides as dots with their intervals; 0 is no progress."""
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
    _tidy(axes, "x")
    axes.spines["left"].set_visible(False)
    axes.tick_params(axis="y", length=0)


def _tidy(axes: Axes, grid: Any = "both") -> None:
    axes.grid(axis=grid, color="#DDDDDD", lw=0.6)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
