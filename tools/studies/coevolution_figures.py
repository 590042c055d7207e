"""The figures of the study in docs/reports/coevolution.md."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from study import COLOURS, GREY, panel

from botschool.analysis.tournament import ROLES

SIDE_COLOURS = {ROLES[0]: COLOURS[1], ROLES[1]: COLOURS[0]}


def mean_curves(axes, millions, rows, colour: str, label: str) -> None:
    """A thin line for each seed, a thick one for their mean, as far as all have come.

    millions, rows: of each seed the steps of its times, and what was measured then, (times,).
    """
    for at, row in zip(millions, rows, strict=True):
        axes.plot(at, row, color=colour, linewidth=0.6, alpha=0.5)
    at = np.linspace(0, min(each[-1] for each in millions), max(map(len, rows)))
    average = np.mean([np.interp(at, *each) for each in zip(millions, rows, strict=True)], axis=0)
    axes.plot(at, average, color=colour, linewidth=2.2, label=label)


def progress(groups: list) -> Figure:
    """A column for each algorithm: above what evolution shows, below what it hides."""
    figure = Figure(figsize=(2.6 * len(groups) + 0.6, 5), layout="constrained")
    rows = figure.subplots(2, len(groups), sharex=True, sharey=True, squeeze=False)
    for (above, below), group in zip(rows.T, groups, strict=True):
        millions = [run["millions"] for run in group.runs]
        for role in ROLES:
            matrices, colour = group.matrices(role), SIDE_COLOURS[role]
            mean_curves(above, millions, [np.diag(each) for each in matrices], colour, role)
            mean_curves(below, millions, [each.mean(axis=1) for each in matrices], colour, role)
        panel(above, title=group.variant, ylim=(0, 1))
        panel(below, xlabel="million steps")
    rows[0, 0].set_ylabel("fitness against those\nof the same time")
    rows[1, 0].set_ylabel("fitness against those\nof all times of the run")
    rows[0, 0].legend(frameon=False, fontsize=8)
    return figure


BEHAVIOUR = {
    "caught": ("share of chases that end with a catch", (0, 1)),
    "steps": ("median steps of a chase", (0, 2050)),
    "distance": ("distance of both, m", (0, None)),
    "predators": ("speed of predators, m/s", (0, 0.41)),
    "prey": ("speed of prey, m/s", (0, 0.51)),
}


def of_runs(group, name: str) -> list[np.ndarray]:
    """A measure of behaviour at the times of each run."""
    if name in ROLES:
        return [np.array(run["speed"])[:, ROLES.index(name)] for run in group.runs]
    return [np.array(run[name]) for run in group.runs]


def behaviour(groups: list) -> Figure:
    """A panel for each measure, a line for each algorithm: the mean over its seeds."""
    figure = Figure(figsize=(11, 5.6), layout="constrained")
    panels = figure.subplots(2, 3).ravel()
    for axes, (name, (title, limits)) in zip(panels, BEHAVIOUR.items(), strict=False):
        for colour, group in zip(COLOURS, groups, strict=False):
            millions = [run["millions"] for run in group.runs]
            mean_curves(axes, millions, of_runs(group, name), colour, group.variant)
        panel(axes, title=title, ylim=limits)
        axes.title.set_fontsize(10)
        if name == "steps":
            axes.axhline(100, color=GREY, linewidth=0.8, linestyle="--")
    for axes in panels[2:5]:
        axes.set_xlabel("million steps")
    panels[5].axis("off")
    lines, names = panels[0].get_legend_handles_labels()
    panels[5].legend(lines, names, frameon=False, loc="center left")
    return figure


FIGURES = {"progress": progress, "behaviour": behaviour}
