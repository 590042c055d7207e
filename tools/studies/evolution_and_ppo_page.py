"""Tables and figures of docs/reports/evolution_and_ppo.md, from runs of evolution_and_ppo.py."""

from __future__ import annotations

import numpy as np
from evolution_and_ppo import (
    FILE,
    METHODS,
    POINTS,
    PROBLEMS,
    TRIED,
    best,
    chosen,
    drawn,
    steps_of_ppo,
)
from matplotlib.figure import Figure
from study import COLOURS, REPORTS, Page, Results, band, legend_above, marked, panel, table

UNITS = ("steps", "seconds")


def reached(results, problem, method: str, unit: str) -> np.ndarray:
    """Mean return in new episodes at the end of the budget, of each seed, sorted."""
    return np.sort([run["curve"][-1] for run in best(results, problem, method, unit)])


def budget(results, problem, unit: str) -> str:
    return f"{steps_of_ppo(results, problem):,}" if unit == "steps" else f"{problem.seconds:g} s"


def medians(results, unit: str) -> str:
    """The median of each method, and between which values it lies for sure."""
    rows = []
    for problem in PROBLEMS:
        found = {method: reached(results, problem, method, unit) for method in METHODS}
        first = max(found.values(), key=np.median)
        cells = []
        for values in found.values():
            text = f"{np.median(values):.1f} ({values[1]:.1f} to {values[-2]:.1f})"
            cells.append(marked(text, values, first))
        rows.append([problem.name, problem.kind, budget(results, problem, unit), *cells])
    return table(["problem", "", f"{unit} of a run", *METHODS], rows)


def settings(results) -> str:
    """The settings that were chosen."""
    rows = []
    for problem in PROBLEMS:
        for method in METHODS:
            told = {}
            for unit in UNITS if method != "PPO" else ("seconds",):
                setting = drawn(problem, method, chosen(results, problem, method, unit))
                told[unit] = ", ".join(f"{k} {v:g}" for k, v in setting.items())
            rows.append([problem.name, method, told["seconds"], told.get("steps", "the same")])
    return table(["problem", "method", "by seconds", "by steps"], rows)


def effort(results) -> str:
    """How many runs there are, and how long they took."""
    tried = sum(run["seed"] in TRIED for run in results.runs)
    minutes = sum(run["seconds"] for run in results.runs) / 60
    return (
        f"{tried} runs that tried settings and {len(results.runs) - tried} others took "
        f"{minutes:.0f} minutes of one core."
    )


def steps_a_second(results) -> str:
    """How many steps of the environment each method takes in a second, learning included."""
    rows = []
    for problem in PROBLEMS:
        cells = []
        for method in METHODS:
            runs = best(results, problem, method, "seconds")
            cells.append(f"{np.median([r['steps'] / r['seconds'] for r in runs]) / 1e6:.2f} M")
        rows.append([problem.name, *cells])
    return table(["problem", *METHODS], rows)


def strengths(results) -> Figure:
    """Each problem a row, each method a dot: its median, and the line from 2nd to 9th seed."""
    figure = Figure(figsize=(11, 5), layout="constrained")
    for axes, unit in zip(figure.subplots(1, 2, sharey=True), UNITS, strict=True):
        for row, problem in enumerate(PROBLEMS):
            every = [reached(results, problem, m, u) for m in METHODS for u in UNITS]
            low, high = min(map(np.min, every)), max(map(np.max, every))
            for number, (method, colour) in enumerate(zip(METHODS, COLOURS, strict=False)):
                values = (reached(results, problem, method, unit) - low) / max(high - low, 1e-9)
                y = row + 0.17 * (number - 1.5)
                axes.plot(values[[1, -2]], [y, y], color=colour, linewidth=2, alpha=0.5)
                axes.plot(np.median(values), y, "o", color=colour, label=method if not row else "")
            if row:
                axes.axhline(row - 0.5, color="0.9", linewidth=0.8)
        panel(axes, title="after equal " + ("steps" if unit == "steps" else "seconds of one core"))
        names = [f"{p.name}\n{p.kind}" for p in PROBLEMS]
        axes.set_yticks(range(len(PROBLEMS)), names)
        axes.set_ylim(len(PROBLEMS) - 0.5, -0.5)
    figure.supxlabel("return in new episodes: 0 the worst run on the problem, 1 the best")
    legend_above(figure, axes, 4)
    return figure


def curves(results) -> Figure:
    """Return in new episodes against seconds of one core: median and middle half."""
    figure = Figure(figsize=(12, 5.4), layout="constrained")
    for axes, problem in zip(figure.subplots(2, 4).ravel(), PROBLEMS, strict=True):
        seconds = problem.seconds * np.geomspace(0.03, 1, POINTS)
        for method, colour in zip(METHODS, COLOURS, strict=False):
            runs = best(results, problem, method, "seconds")
            band(axes, seconds, [run["curve"] for run in runs], colour, method)
        axes.set_xscale("log")
        panel(axes, title=problem.name)
    figure.supxlabel("seconds of one core")
    figure.supylabel("return in new episodes")
    legend_above(figure, axes, 4)
    return figure


def pages() -> list[Page]:
    """Return the page, made from what is kept."""
    results = Results(FILE)
    sections = {
        "steps": medians(results, "steps"),
        "seconds": medians(results, "seconds"),
        "speed": steps_a_second(results),
        "settings": settings(results),
        "effort": effort(results),
    }
    figures = {
        "evolution_and_ppo": lambda: strengths(results),
        "evolution_and_ppo_curves": lambda: curves(results),
    }
    return [Page(REPORTS / "evolution_and_ppo.md", sections, figures)]
