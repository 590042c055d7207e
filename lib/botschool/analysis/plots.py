"""Draw results: learning curves and averages over replications."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from botschool.analysis.figure import (
    COLOURS,
    NoDisplay,
    check_picture,
    cycle,
    new_figure,
    tidy,
    tidy_rows,
)
from botschool.analysis.runs import (
    BEST_POST,
    GENERATION_AVERAGE,
    GENERATION_BEST,
    STEPS,
    Warn,
    common_title,
    find_runs,
    named,
    problem_of,
    read_curves,
    read_fitness,
    read_fresh,
    read_stat,
    seed_of,
    warn,
)
from botschool.analysis.trainings import (
    POST_EVALUATED,
    TRAINING_EPISODES,
    has_trainings,
    read_trainings,
)
from botschool.evolution import fresh
from botschool.terminal import readable

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MAX_POINTS = 1000
"""Largest number of points drawn of a curve; longer curves are thinned."""

FITNESS = "fitness (mean return of an episode)"
RETURN = "mean return of an episode"
ROBOTS = "best robots in fresh episodes"


class Curves(dict[int, np.ndarray]):
    """Seed -> (generations, 6)."""

    def __init__(self, *items: Any, fresh: dict[int, np.ndarray] | None = None) -> None:
        """fresh: seed -> returns of the run's best robot in fresh episodes, where it has some."""
        super().__init__(*items)
        self.fresh = fresh or {}


def plot_stat(
    targets: Sequence[Path | str], output: Path | str | None = None, warn: Warn = warn
) -> None:
    """Draw fitness against steps for stat files, and for all runs and trainings of folders.

    One run gives three curves. The runs of one folder give the mean and a band of one standard
    deviation, with the single runs as thin lines. Colours distinguish several folders, and
    trainings of `botschool rl` that differ in more than the seed. Next to evolution, a training is
    drawn like a run: the best post-evaluation so far against steps that include post-evaluations.
    The picture goes to the screen, or to the file `output`. A damaged stat file is an error if it
    was named; if its folder was named, it is left out with a warning. Raises BotschoolError.
    """
    evolved, trained, problems = _read_targets(targets, warn)
    with new_figure(output) as figure:
        draw_stat(figure, evolved, trained, problems)


def draw_stat(
    figure: Figure,
    evolved: dict[str, Curves],
    trained: dict[str, Curves],
    problems: Mapping[str, str] = MappingProxyType({}),
) -> None:
    """Draw what `plot_stat` draws; evolved, trained: name -> runs; problems: name -> problem."""
    experiments = evolved | trained
    words = _Words.of(bool(evolved), bool(trained))
    axes = figure.add_subplot()
    if len(experiments) > 1:
        for (name, curves), colour in zip(experiments.items(), cycle(), strict=False):
            label = f"{name}, {_of_runs(curves)}"
            _draw_group(axes, curves, words.column, colour, label, singles=False)
            _draw_fresh(axes, curves, colour)
        _finish(axes, common_title(problems.values(), words.labels[words.column]), words)
        return
    [(name, curves)] = experiments.items()
    name = problems.get(name, name)
    if len(curves) == 1:
        [number] = curves
        _draw_run(axes, curves[number], words.labels)
        title = f"{name}, {words.number} {number}" if number >= 0 else name
    else:
        runs = _of_runs(curves)
        average = f"{words.labels[GENERATION_AVERAGE]}, {runs}"
        main = f"{words.labels[words.column]}, {runs}"
        _draw_mean(axes, curves, GENERATION_AVERAGE, COLOURS[1], average)
        _draw_group(axes, curves, words.column, COLOURS[0], main)
        title = name
    _draw_fresh(axes, curves, "black")
    _finish(axes, title, words)


@dataclass(frozen=True)
class _Words:
    """The words of a figure."""

    column: int
    """Column of the main curve."""
    labels: dict[int, str]
    steps: str
    fitness: str
    number: str

    @classmethod
    def of(cls, evolved: bool, trained: bool) -> _Words:
        """Return words for runs of evolution, for trainings, or for both together."""
        best = "best post-evaluated so far"
        if not trained:
            labels = {
                GENERATION_BEST: "best of the generation",
                GENERATION_AVERAGE: "average of the generation",
                BEST_POST: best,
            }
            return cls(BEST_POST, labels, "steps", FITNESS, "seed")
        labels = {
            POST_EVALUATED: "post-evaluated",
            TRAINING_EPISODES: "episodes of the training",
            BEST_POST: best,
        }
        if not evolved:
            return cls(POST_EVALUATED, labels, "steps of training", RETURN, "run")
        return cls(BEST_POST, labels, "steps, including post-evaluations", RETURN, "run")


def plot_ave(targets: Sequence[Path | str], output: Path | str | None = None) -> None:
    """Print and draw mean, standard deviation (n - 1), 95 % interval of the mean, and n of the
    best robots' mean return in fresh episodes (read_fitness says when it is another number).

    Each folder of runs gives one row and one bar, each run a dot. The table is printed before the
    picture is drawn; without a display, a note replaces the picture. Raises BotschoolError.
    """
    folders = [Path(target) for target in targets]
    check_picture(output)
    fitness = {
        name: np.array(list(read_fitness(folder, warn).values()))
        for name, folder in named(folders).items()
    }
    title = _title(folders)
    print_table(title, fitness)
    try:
        with new_figure(output, height=max(5.0, 1.6 + 0.6 * len(fitness))) as figure:
            axes = figure.add_subplot()
            _draw_bars(axes, fitness)
            problems = [problem_of(folder) for folder in folders]
            axes.set_title(common_title(problems, f"{title}, mean \u00b1 sd over runs"))
    except NoDisplay as error:
        print(f"note: {error}", file=sys.stderr)


def _read_targets(
    targets: Sequence[Path | str], warn: Warn
) -> tuple[dict[str, Curves], dict[str, Curves], dict[str, str]]:
    """Return name -> curves, of evolution and of trainings, and name -> problem and algorithm.

    Stat files are grouped by folder; a folder of old runs may not say its problem.
    """
    evolved: dict[Path, Curves] = {}
    trainings: list[Path] = []
    for target in map(Path, targets):
        if target.suffix == ".npy" and not target.is_dir():
            runs = evolved.setdefault(target.parent, Curves())
            seed = seed_of(target)
            runs[-1 - len(runs) if seed is None else seed] = read_stat(target)
        elif has_trainings(target):
            trainings.append(target)
        else:
            evolved.setdefault(target, Curves()).update(read_curves(target, warn))
    for folder, runs in evolved.items():
        runs.fresh = read_fresh(folder, set(runs))
    trained: dict[Path, Curves] = {}
    for target in trainings:
        for group, curves in read_trainings(target, bool(evolved), warn).items():
            trained.setdefault(group, Curves()).update(curves)
    names = named([*evolved, *trained])
    return (
        {name: evolved[folder] for name, folder in names.items() if folder in evolved},
        {name: trained[group] for name, group in names.items() if group in trained},
        {name: about for name, folder in names.items() if (about := problem_of(folder))},
    )


def _draw_run(axes: Axes, stat: np.ndarray, labels: dict[int, str]) -> None:
    stat = _thinned(stat)
    marker = "o" if len(stat) == 1 else None
    styles = {
        GENERATION_BEST: ("#BBBBBB", 0.8),
        GENERATION_AVERAGE: (COLOURS[1], 1.1),
        BEST_POST: (COLOURS[0], 2.2),
    }
    for column, (colour, width) in styles.items():
        fitness = _finite(stat[:, column])
        axes.plot(
            stat[:, STEPS], fitness, color=colour, lw=width, marker=marker, label=labels[column]
        )


def _draw_group(
    axes: Axes, curves: Curves, column: int, colour: str, label: str, singles: bool = True
) -> None:
    """Draw the mean and band of several runs; singles: also each run as a thin line."""
    single = len(curves) == 1
    for stat in curves.values() if single or singles else ():
        marker = "o" if len(stat) == 1 else None
        stat = _thinned(stat)
        axes.plot(
            stat[:, STEPS],
            _finite(stat[:, column]),
            color=colour,
            lw=2.2 if single else 0.7,
            alpha=1.0 if single else 0.4,
            marker=marker,
            markersize=4,
            label=label if single else None,
        )
    if not single:
        _draw_mean(axes, curves, column, colour, label)


def _draw_mean(axes: Axes, curves: Curves, column: int, colour: str, label: str) -> None:
    steps, mean, sd = replication_mean(list(curves.values()), column)
    axes.fill_between(steps, mean - sd, mean + sd, color=colour, alpha=0.1, lw=0)
    for edge in (mean - sd, mean + sd):  # where bands overlap, each shows where it ends
        axes.plot(steps, edge, color=colour, lw=0.9, ls=(0, (4, 2)))
    axes.plot(steps, mean, color=colour, lw=2.2, label=label)


def _draw_fresh(axes: Axes, curves: Curves, colour: str) -> None:
    """Draw the best robots' mean return in fresh episodes at the end, with its 95 % interval."""
    if not curves.fresh:
        return
    [returns, *others] = curves.fresh.values()
    who = f"best robot in {len(returns)} fresh episodes"
    if others:
        returns = np.array([each.mean() for each in curves.fresh.values()])
        who = f"best robots in fresh episodes, {len(returns)} runs"
    axes.errorbar(
        max(stat[-1, STEPS] for stat in curves.values()),
        returns.mean(),
        yerr=np.nan_to_num(fresh.half_width(returns)),
        color=colour,
        fmt="D",
        ms=6,
        capsize=5,
        zorder=4,
        mec="white",
        label=f"{who}: {fresh.told(returns)}",
        clip_on=False,
    )


def replication_mean(
    stats: Sequence[np.ndarray], column: int, points: int = 500
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return mean and standard deviation (n - 1) of one column over replications, on common steps.

    Each run, (generations, 6), is interpolated linearly between its generations, and counts only
    from its first to its last one. Return steps, mean and sd, each (points,), NaN where fewer than
    two runs, or fewer than half of them, count.
    """
    stats = list(stats)
    ends = [stat[-1, STEPS] for stat in stats]
    # runs of one length end a few steps apart: there the mean would jump to that of the last ones
    end = min(ends) if min(ends) > 0.95 * max(ends) else max(ends)
    grid = np.linspace(min(stat[0, STEPS] for stat in stats), end, points)
    values = np.full((len(stats), points), np.nan)
    for row, stat in zip(values, stats, strict=True):
        known = stat[np.isfinite(stat[:, column])]
        if len(known):
            row[:] = np.interp(grid, known[:, STEPS], known[:, column], left=np.nan, right=np.nan)
    count = np.isfinite(values).sum(axis=0)
    enough = count >= max(2, (len(stats) + 1) // 2)
    mean, sd = np.full(points, np.nan), np.full(points, np.nan)
    mean[enough] = np.nanmean(values[:, enough], axis=0)
    sd[enough] = np.nanstd(values[:, enough], axis=0, ddof=1)
    return grid, mean, sd


def _of_runs(curves: Curves) -> str:
    return "1 run" if len(curves) == 1 else f"mean \u00b1 sd of {len(curves)} runs"


def _thinned(stat: np.ndarray) -> np.ndarray:
    if len(stat) <= MAX_POINTS:
        return stat
    return stat[np.linspace(0, len(stat) - 1, MAX_POINTS).astype(int)]


def _finite(fitness: np.ndarray) -> np.ndarray:
    return np.where(np.isfinite(fitness), fitness, np.nan)


def _finish(axes: Axes, title: str, words: _Words) -> None:
    axes.set_title(title)
    axes.set_xlabel(words.steps)
    axes.set_ylabel(words.fitness)
    axes.set_xlim(left=0.0)
    axes.xaxis.set_major_formatter(lambda steps, _position: format_steps(steps))
    axes.ticklabel_format(axis="y", useOffset=False)
    tidy(axes)
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(handles[::-1], labels[::-1], frameon=False)


def format_steps(steps: float) -> str:
    """Format steps: 1500 -> "1.5k", 2e6 -> "2M"."""
    for unit, size in (("G", 1e9), ("M", 1e6), ("k", 1e3)):
        if abs(steps) >= size:
            return f"{steps / size:.6g}{unit}"
    return f"{steps:.6g}"


def _title(folders: Sequence[Path]) -> str:
    """Return what the runs' numbers are: some may come from a time without fresh episodes."""
    runs = [run for folder in folders for run in find_runs(folder, lambda sentence: None)]
    measured = {run.fresh is not None for run in runs}
    if len(measured) == 2:
        return "best robots, in fresh episodes or post-evaluated"
    return ROBOTS if True in measured else "best post-evaluated fitness"


def print_table(title: str, fitness: dict[str, np.ndarray]) -> None:
    """Print a row of numbers for each experiment."""
    from rich import box
    from rich.table import Table

    from botschool.console import Console

    table = Table(title=title, box=box.SIMPLE, title_justify="left")
    table.add_column("experiment", overflow="fold")
    for column in ("mean", "\u00b1 95 %", "sd", "n", "min", "max"):
        table.add_column(column, justify="right", no_wrap=True)
    for name, values in fitness.items():
        numbers = [values.mean(), fresh.half_width(values), _sd(values), len(values)]
        numbers += [values.min(), values.max()]
        table.add_row(name, *(written(number) for number in numbers))
    Console(highlight=False).print(table)


def _sd(values: np.ndarray) -> float:
    return float(values.std(ddof=1)) if len(values) > 1 else float("nan")


def written(value: float) -> str:
    if isinstance(value, int):
        return str(value)
    return "-" if np.isnan(value) else readable(value)


def _draw_bars(axes: Axes, fitness: dict[str, np.ndarray]) -> None:
    labels = []
    for row, ((name, values), colour) in enumerate(zip(fitness.items(), cycle(), strict=False)):
        mean, sd = values.mean(), _sd(values)
        axes.barh(row, mean, height=0.6, color=colour, alpha=0.45)
        spread = 0.2 * np.sin(1.0 + 2.4 * np.arange(len(values)))
        axes.plot(values, row + spread, "o", color=colour, mec="white", mew=0.6, ms=6)
        plus_minus = ""
        if len(values) > 1:
            axes.errorbar(mean, row, xerr=sd, color="black", capsize=6, lw=1.5, zorder=3)
            plus_minus = f" \u00b1 {written(sd)}"
        labels.append(f"{name}\n{written(mean)}{plus_minus}  (n = {len(values)})")
    margin = 0.9 if len(labels) == 1 else 0.5
    tidy_rows(axes, labels, margin, margin)
    axes.axvline(0.0, color="black", lw=0.8)
    axes.set_xlabel(FITNESS)
