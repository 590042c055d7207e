"""Compare the results of two folders, and draw results as boxes."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from math import comb
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from botschool.analysis.figure import check_picture, cycle, new_figure, tidy_rows
from botschool.analysis.plots import FITNESS
from botschool.analysis.runs import common_title, named, problem_of, read_fitness, warn
from botschool.analysis.trainings import has_trainings
from botschool.errors import BotschoolError
from botschool.rl.folder import find_runs
from botschool.seeds import Numbers, generator
from botschool.terminal import readable

if TYPE_CHECKING:
    from matplotlib.axes import Axes

RESAMPLES = 10_000
"""Samples of a bootstrap, and random assignments of a permutation test."""
EXACT = 20_000
"""The test tries all assignments if there are no more than these."""
LEVEL = 0.05
SIZES = ((0.71, "a large"), (0.64, "a medium"), (0.56, "a small"), (0.0, "hardly any"))
"""Smallest share of pairs -> name of the effect (Vargha and Delaney 2000)."""


@dataclass(frozen=True)
class Comparison:
    """What two samples say about each other."""

    medians: tuple[float, float]
    intervals: tuple[tuple[float, float], tuple[float, float]]
    """95 % of a bootstrap of each median."""
    difference: float
    """Second median minus the first."""
    interval: tuple[float, float]
    """95 % of a bootstrap of the difference."""
    p: float
    """Share of the assignments of runs to folders whose mean ranks differ at least as much."""
    least: float
    """Smallest p that so many runs can give."""
    better: float
    """Share of the pairs in which the second one's run is better; equal ones count half."""


def compare(first: np.ndarray, second: np.ndarray) -> Comparison:
    """Return the comparison of two samples; the same numbers give the same result."""
    numbers = generator(0, 0)
    samples = [_medians(values, numbers) for values in (first, second)]
    assignments = comb(len(first) + len(second), len(first))
    return Comparison(
        medians=(float(np.median(first)), float(np.median(second))),
        intervals=(_middle(samples[0]), _middle(samples[1])),
        difference=float(np.median(second) - np.median(first)),
        interval=_middle(samples[1] - samples[0]),
        p=_permutation_test(first, second, numbers),
        least=2 / assignments,
        better=_share(first, second),
    )


def _medians(values: np.ndarray, numbers: Numbers) -> np.ndarray:
    return np.median(values[numbers.integers(len(values), size=(RESAMPLES, len(values)))], axis=1)


def _middle(values: np.ndarray) -> tuple[float, float]:
    low, high = np.quantile(values, (0.025, 0.975))
    return float(low), float(high)


def _share(first: np.ndarray, second: np.ndarray) -> float:
    """Return the share of pairs in which the second value is larger (Vargha and Delaney's A)."""
    pairs = second[:, None] - first[None]
    return float((pairs > 0).mean() + 0.5 * (pairs == 0).mean())


def _permutation_test(first: np.ndarray, second: np.ndarray, numbers: Numbers) -> float:
    both, n = np.concatenate([first, second]), len(first)
    below = (both[:, None] > both[None]).sum(axis=1)
    ranks = 2 * below + (both[:, None] == both[None]).sum(axis=1)  # twice the mean rank: whole
    middle = n * int(ranks.sum())
    if comb(len(both), n) <= EXACT:
        chosen = np.array(list(combinations(range(len(both)), n)))
        sums = ranks[chosen].sum(axis=1)
    else:
        rows = [numbers.permutation(len(both))[:n] for _ in range(RESAMPLES)]
        sums = np.append(ranks[np.array(rows)].sum(axis=1), ranks[:n].sum())
    apart = np.abs(len(both) * sums - middle)
    return float((apart >= abs(len(both) * int(ranks[:n].sum()) - middle)).mean())


def compare_command(folders: tuple[Path, Path], output: Path | None) -> None:
    """Print the comparison of two folders, and draw both as boxes. Raises BotschoolError."""
    if folders[0].resolve() == folders[1].resolve():
        raise BotschoolError(f"{folders[0]} is compared with itself: name two folders.")
    check_picture(output)
    results = read_results(folders)
    (a, first), (b, second) = results.items()
    about = {problem_of(folder).partition(",")[0] for folder in folders}
    if len(about - {""}) > 1:
        print(f"note: these are runs on {' and '.join(sorted(about))}.", file=sys.stderr)
    found = compare(first, second)
    width = max(len(a), len(b), 10)
    print(f"{'':{width}}  runs  median of the best robots' fitness (95 % interval)")
    for name, values, k in ((a, first, 0), (b, second, 1)):
        median, interval = readable(found.medians[k]), _written(found.intervals[k])
        print(f"{name:{width}}  {len(values):4}  {median} ({interval})")
    difference = f"{readable(found.difference)} ({_written(found.interval)})"
    print(f"{'difference':{width}}        {difference}")
    print(f"permutation test of mean ranks: p = {found.p:.3g}")
    print(f"in {found.better:.0%} of all pairs, the run of {b} is better than the run of {a}")
    print(verdict(found, a, b, len(first), len(second)))
    if output is not None:
        draw_results(results, folders, output)
        print(f"picture: {output}")


def verdict(found: Comparison, a: str, b: str, n: int, m: int) -> str:
    """Return the meaning of a comparison of n runs with m runs, as a sentence."""
    if found.least > LEVEL:
        return (
            f"{n} and {m} runs cannot show a difference: even the clearest result would have "
            f"p = {found.least:.2g}. Make at least 4 runs of each (-n)."
        )
    if found.p > LEVEL:
        return (
            f"These runs do not show that {a} and {b} differ. That does not prove them equal: "
            "more runs may show a difference."
        )
    winner, loser, share = (b, a, found.better) if found.better > 0.5 else (a, b, 1 - found.better)
    size = next(word for least, word in SIZES if share >= least)
    return f"{winner} is better than {loser}, {size} effect: chance alone rarely gives this."


def _written(interval: tuple[float, float]) -> str:
    return f"{readable(interval[0])} to {readable(interval[1])}"


def read_results(folders: Sequence[Path]) -> dict[str, np.ndarray]:
    """Return name -> the fitness of the best robot of each run, or agent of each training."""
    found = {}
    for name, folder in named(folders).items():
        if has_trainings(folder):
            values = [run.evaluations().best for run in find_runs(folder)]
        else:
            values = list(read_fitness(folder, warn).values())
        found[name] = np.array(values)
    return found


def plot_boxes(folders: Sequence[Path | str], output: Path | None) -> None:
    """Draw the fitness of the best robot of each run as a box a folder."""
    check_picture(output)
    paths = [Path(folder) for folder in folders]
    draw_results(read_results(paths), paths, output)


def draw_results(
    results: dict[str, np.ndarray], folders: Sequence[Path], output: Path | None
) -> None:
    """Draw a box for each name; None opens a window."""
    with new_figure(output, height=max(3.0, 1.4 + 0.7 * len(results))) as figure:
        axes = figure.add_subplot()
        _draw_boxes(axes, results)
        about = [problem_of(folder) for folder in folders]
        axes.set_title(common_title(about, "best robot of each run"))


def _draw_boxes(axes: Axes, results: dict[str, np.ndarray]) -> None:
    labels = []
    for row, ((name, values), colour) in enumerate(zip(results.items(), cycle(), strict=False)):
        low, lower, median, upper, high = np.quantile(values, (0, 0.25, 0.5, 0.75, 1))
        axes.plot((low, high), (row, row), color="black", lw=1, zorder=0.9)
        axes.barh(row, upper - lower, left=lower, height=0.55, color="white", ec="black")
        axes.barh(row, upper - lower, left=lower, height=0.55, color=colour, alpha=0.35)
        axes.plot((median, median), (row - 0.27, row + 0.27), color="black", lw=2.5)
        spread = 0.16 * np.sin(1.0 + 2.4 * np.arange(len(values)))
        axes.plot(values, row + spread, "o", color=colour, mec="white", mew=0.6, ms=6, zorder=3)
        labels.append(f"{name}\nmedian {readable(median)} (n = {len(values)})")
    tidy_rows(axes, labels, 0.6, 0.6)
    axes.set_xlabel(f"{FITNESS}; box: quartiles, line: median")
