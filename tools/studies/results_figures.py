"""The figures of docs/reports/results.md and bodies.md, from data/."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from evolved import BOX2D, ROWS, grid
from matplotlib.figure import Figure
from planar_runs import GAIT, RUNNERS

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00")
"""Okabe and Ito's: they differ for colour-blind readers too."""
GREY = "#666666"


def panel(axes, **labels) -> None:
    """The look that all have in common."""
    axes.set(**labels)
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)


def curves(axes, steps, rows, colour: str, label: str | None = None) -> None:
    """A thin line for each seed, a thick one for their median."""
    rows = np.array(rows, dtype=float)
    axes.plot(steps, rows.T, color=colour, linewidth=0.6, alpha=0.5)
    axes.plot(steps, np.median(rows, axis=0), color=colour, linewidth=2.2, label=label)


def evolved(parts: dict) -> Figure:
    """Learning curves of every experiment."""
    found = parts["evolved"]["data"] | parts.get("box2d", {"data": {}})["data"]
    rows = [row for row in ROWS + BOX2D if row.file in found]
    columns = 4 if len(rows) > 6 else 3
    lines = -(-len(rows) // columns)
    figure = Figure(figsize=(3.1 * columns, 2.6 * lines), layout="constrained")
    panels = figure.subplots(lines, columns, squeeze=False).ravel()
    for axes, row in zip(panels, rows, strict=False):
        of = found[row.file]
        curves(axes, grid(of["steps"]) / 1e6, [run["curve"] for run in of["runs"]], COLOURS[0])
        if row.level is not None:
            axes.axhline(row.level, color=COLOURS[1], linestyle="--", linewidth=1.2)
        panel(axes, title=f"{row.file}.ini", xscale="log")
        axes.xaxis.set_major_formatter("{x:g}")
    for axes in panels[len(rows) :]:
        axes.set_visible(False)
    figure.supxlabel("million steps")
    figure.supylabel("best post-evaluated so far")
    return figure


def speed(parts: dict) -> Figure:
    """Steps/s of all contestants on one core."""
    measured = parts["speed"]["data"]["others"][0]["numbers"]
    names = list(next(iter(measured.values())))
    figure = Figure(figsize=(9, 3.8), layout="constrained")
    axes = figure.subplots()
    width = 0.8 / len(names)
    for i, name in enumerate(names):
        rates = [found[name]["rate"] for found in measured.values()]
        places = np.arange(len(rates)) + (i - (len(names) - 1) / 2) * width
        bars = axes.bar(places, rates, width * 0.92, color=COLOURS[i], label=name)
        axes.bar_label(bars, [short(rate) for rate in rates], fontsize=7, padding=2)
    axes.set_xticks(range(len(measured)), list(measured))
    panel(axes, yscale="log", ylabel="steps / s, one core", ylim=(1e4, None))
    axes.grid(visible=False, axis="x")
    axes.legend(frameon=False, ncols=len(names), loc="lower center", bbox_to_anchor=(0.5, 1))
    return figure


def short(rate: float) -> str:
    """A number above a bar: 12 M, 480 k."""
    unit, letter = (1e6, "M") if rate >= 1e6 else (1e3, "k")
    return f"{rate / unit:.2g} {letter}" if rate / unit < 10 else f"{rate / unit:.0f} {letter}"


def es_and_ppo(parts: dict) -> Figure | None:
    """Acrobot: both against steps and against time."""
    es = parts["evolved"]["data"]["acrobot"]
    runs = parts["trained"]["data"]["Acrobot-v1"]
    if "curve" not in runs[0]:
        return None
    figure = Figure(figsize=(9, 3.6), layout="constrained")
    steps = grid(es["steps"])
    ppo_steps = np.mean([run["steps"] for run in runs], axis=0)
    best = [np.maximum.accumulate(run["curve"]) for run in runs]
    for axes, label, seconds in zip(
        figure.subplots(1, 2, sharey=True), ("steps", "seconds on one core"), (False, True),
        strict=True,
    ):  # fmt: skip
        for colour, name, at, rows, of in (
            (COLOURS[0], "OpenAI-ES", steps, [run["curve"] for run in es["runs"]], es["runs"]),
            (COLOURS[1], "PPO", ppo_steps, best, runs),
        ):
            time = np.mean([run["seconds"] for run in of])
            curves(axes, at / at[-1] * time if seconds else at, rows, colour, name)
        panel(axes, xscale="log", xlabel=label)
    figure.axes[0].set_ylabel("best post-evaluated so far")
    figure.axes[0].legend(frameon=False, loc="lower right")
    return figure


def ppo_compare(parts: dict) -> Figure:
    """Training curves of two PPOs."""
    found = parts["ppo"]["data"]
    figure = Figure(figsize=(10, 4), layout="constrained")
    for axes, (problem, of) in zip(figure.subplots(1, len(found)), found.items(), strict=True):
        for colour, (library, those) in zip(COLOURS, of["libraries"].items(), strict=False):
            rows = np.array(those["curves"])
            steps = np.arange(1, rows.shape[1] + 1) * of["steps"] / rows.shape[1] / 1000
            axes.fill_between(steps, rows.min(0), rows.max(0), alpha=0.2, color=colour, lw=0)
            axes.plot(steps, rows.T, color=colour, linewidth=0.5, alpha=0.5)
            axes.plot(steps, rows.mean(0), color=colour, linewidth=2.2, label=library)
        panel(axes, title=problem, xlabel="thousand steps")
        axes.legend(frameon=False, loc="lower right")
    figure.axes[0].set_ylabel("return, last 20 training episodes")
    return figure


def planar(parts: dict) -> Figure:
    """Learning curves of the planar runners, and below when their feet touch the ground."""
    found = parts["planar"]["data"]
    figure = Figure(figsize=(10, 5.6), layout="constrained")
    upper, lower = figure.subplots(2, len(found))
    for above, below, (file, of) in zip(upper, lower, found.items(), strict=True):
        curves(above, grid(of["steps"]) / 1e6, [run["curve"] for run in of["runs"]], COLOURS[0])
        panel(above, title=f"{file}.ini", xscale="log", xlabel="million steps")
        above.xaxis.set_major_formatter("{x:g}")
        for run in of["runs"]:
            feet = run["gait"].values()
            for i, (colour, steps) in enumerate(zip(COLOURS, feet, strict=False)):
                place = run["seed"] - 0.4 + 0.8 * i / len(feet)
                seconds = RUNNERS[file].substep * RUNNERS[file].substeps
                touches = [(k * seconds, seconds) for k, touch in enumerate(steps) if touch == "1"]
                below.broken_barh(touches, (place, 0.8 / len(feet)), color=colour)
        panel(below, xlabel="seconds", yticks=[run["seed"] for run in of["runs"]], xlim=(0, GAIT))
        below.invert_yaxis()
    upper[0].set_ylabel("best post-evaluated so far")
    lower[0].set_ylabel("seed")
    return figure


FIGURES = {
    "evolved": (evolved, ("evolved",)),
    "speed": (speed, ("speed",)),
    "es_and_ppo": (es_and_ppo, ("evolved", "trained")),
    "ppo_compare": (ppo_compare, ("ppo",)),
    "planar": (planar, ("planar",)),
}
"""Name -> who draws it, and the parts that it needs."""


def draw(parts: dict, folder: Path) -> list[str]:
    """Draws what the data suffice for; returns the names of the files."""
    drawn = []
    for name, (figure, needed) in FIGURES.items():
        made = figure(parts) if set(needed) <= set(parts) else None
        if made:
            made.savefig(folder / f"{name}.png", dpi=110, metadata={"Software": None})
            drawn.append(f"{name}.png")
    return drawn
