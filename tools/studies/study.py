"""What studies share: sections and figures of pages, kept data, many runs, numbers over seeds."""

from __future__ import annotations

import json
import math
import multiprocessing
import re
import time
from collections.abc import Callable, Iterable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from report import Table, commit, machine

from botschool.evolution.run import Run
from botschool.problems import Episodes, Outcome

ROOT = Path(__file__).parents[2]
DATA = Path(__file__).parent / "data"
EXPERIMENTS = ROOT / "data" / "experiments"
REPORTS = ROOT / "docs" / "reports"
IMAGES = ROOT / "docs" / "images"
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00")
"""Okabe and Ito's: they differ for colour-blind readers too."""
GREY = "#666666"
NEW_SEED = 2**40
"""New episodes are those of a seed that no run uses."""
PROCESSES = 2


# Pages


@dataclass
class Page:
    """A document, the text of its sections (`<!-- NAME -->` to `<!-- end -->`), and its figures."""

    path: Path
    sections: dict[str, str]
    figures: dict[str, Callable[[], Figure]] = field(default_factory=dict)
    """Who draws docs/images/NAME.png."""
    dpi: int = 110

    def filled(self, text: str) -> str:
        """Return the document's text with its sections made anew."""
        for name, made in self.sections.items():
            text, count = re.subn(
                rf"(<!-- {name} -->\n).*?(<!-- end -->)",
                lambda marks, made=made: f"{marks[1]}{made}\n{marks[2]}",
                text,
                flags=re.DOTALL,
            )
            if count != 1:
                raise SystemExit(f"{self.path} has the section <!-- {name} --> {count} times.")
        return text

    def write(self) -> None:
        """Write the sections, and draw the figures."""
        text = self.filled(self.path.read_text(encoding="utf-8"))
        self.path.write_text(text, encoding="utf-8")
        for name, draw in self.figures.items():
            place = IMAGES / f"{name}.png"
            draw().savefig(place, dpi=self.dpi, metadata={"Software": None})
        print(self.path.relative_to(ROOT), *(f"{name}.png" for name in self.figures))


def table(columns: list[str], rows: list[list[str]]) -> str:
    """Return a table as Markdown."""
    return Table("", "", columns, rows).markdown()


def panel(axes, **labels) -> None:
    """Give axes the look that all figures have in common."""
    axes.set(**labels)
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)


def legend_above(figure: Figure, axes, columns: int) -> None:
    """Put the names of these axes' lines above all panels."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, frameon=False, ncols=columns, loc="outside upper center")


def band(axes, at, rows, colour: str, label: str) -> None:
    """Draw the median of curves as a line, and their middle half as a band."""
    low, middle, high = np.nanpercentile(np.array(rows, dtype=float), (25, 50, 75), axis=0)
    axes.fill_between(at, low, high, color=colour, alpha=0.15, lw=0)
    axes.plot(at, middle, color=colour, linewidth=1.8, label=label)


# Data


def stamp() -> dict[str, str]:
    """Return where and when something is measured."""
    date = time.strftime("%Y-%m-%d", time.gmtime())
    return {"commit": commit(), "date": date, "machine": machine()}


def keep(path: Path, data: dict) -> None:
    """Write a file of measurements, a line for each thing, so that a difference can be read."""
    text = json.dumps(data, separators=(",", ":"))
    path.write_text(text.replace(',"', ',\n"') + "\n", encoding="utf-8")


class Results:
    """A file of runs, a line of JSON each; what is in it is not done again."""

    def __init__(self, path: Path) -> None:
        self.path = path
        lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
        self.runs: list[dict] = [json.loads(line) for line in lines]

    def of(self, **wanted) -> list[dict]:
        """Return the runs that have these values, by rising seeds."""
        found = [run for run in self.runs if wanted.items() <= run.items()]
        return sorted(found, key=lambda run: run["seed"])

    def do(self, name: dict, run: Callable[[], dict]) -> dict:
        """Return the run of this name; do it if it is not there."""
        if found := self.of(**name):
            return found[0]
        self.runs.append(name | run())
        with self.path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(self.runs[-1]) + "\n")
        shown = {key: value for key, value in self.runs[-1].items() if key != "curve"}
        print(*shown.values(), flush=True)
        return self.runs[-1]


# Runs


def side_by_side(function: Callable, *arguments: Iterable) -> list:
    """Return what a function gives for each, two at a time, a core each."""
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(PROCESSES, mp_context=context) as pool:
        return list(pool.map(function, *arguments))


def played(run: Run, saved: np.ndarray, seed: int, episodes: int, steps: int = 0) -> Outcome:
    """Return new episodes of a robot that a run has saved."""
    genotype, scale = run.policy.split(saved)
    steps = steps or run.policy.config.maxsteps
    new = Episodes.of([seed], episodes)
    return run.problem.evaluate(run.policy, genotype[None], scale, new, steps)


def at_steps(rows: np.ndarray, steps: np.ndarray, digits: int) -> list[float | None]:
    """Return the best post-evaluated fitness of a run at these steps; None before the first."""
    places = np.searchsorted(rows[:, 0], steps, side="right") - 1
    return [None if i < 0 else round(float(rows[i, 2]), digits) for i in places]


# Numbers


def spread(values, digits: int = 1) -> str:
    """Return mean +- standard deviation, in words."""
    values = np.asarray(values, dtype=float)
    deviation = f" +- {values.std(ddof=1):.{digits}f}" if len(values) > 1 else ""
    return f"{values.mean():.{digits}f}{deviation}"


def differ(a, b) -> float:
    """Return Mann and Whitney's two-sided p, with the normal approximation and ties."""
    both = np.concatenate([a, b])
    ranks = np.array([(both < x).sum() + ((both == x).sum() + 1) / 2 for x in both])
    n, m = len(a), len(b)
    _, ties = np.unique(both, return_counts=True)
    share = (ties**3 - ties).sum() / ((n + m) * (n + m - 1))
    variance = n * m / 12 * (n + m + 1 - share)
    if variance == 0:
        return 1.0
    distance = abs(ranks[:n].sum() - n * (n + m + 1) / 2)
    return math.erfc(max(0, distance - 0.5) / math.sqrt(2 * variance))


def marked(text: str, values: np.ndarray, best: np.ndarray) -> str:
    """Return a cell, bold if the best values are not surely better than these."""
    return f"**{text}**" if differ(values, best) >= 0.05 else text
