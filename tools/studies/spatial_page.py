"""The table and the figure of docs/reports/bodies_in_space.md, from what spatial_runs measured."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from study import COLOURS, DATA, REPORTS, Page, Results, panel, table

GOALS = ("1 m/s", "2 m/s", "3 m/s", "20 s")
BODIES = {
    "ant": ("Ant: speed of the best so far, m/s", "speed"),
    "humanoid": ("Humanoid: life of the best so far, s", "life"),
}


def told(point: dict | None) -> str:
    """Return a cell: seconds and million steps, or a dash."""
    return f"{point['seconds']:.0f} s, {point['steps'] / 1e6:.0f} M" if point else "-"


def times(results: Results, names: list[str]) -> str:
    """Return a row for each run."""
    rows = []
    for run in [run for name in names for run in results.of(experiment=name)]:
        end = run["end"]
        how = f"{end['speed']:.2f} m/s, {end['falls']} falls, {end['life']:.0f} s"
        cells = [told(run["met"].get(goal)) for goal in GOALS]
        rows.append([run["experiment"], str(run["seed"]), *cells, f"{told(end)}: {how}"])
    return table(["experiment", "seed", *GOALS, "end"], rows)


def curves(results: Results, names: list[str]) -> Figure:
    """A line for each run, a colour for each experiment."""
    figure = Figure(figsize=(8.5, 3.4), layout="constrained")
    for axes, (body, (title, what)) in zip(figure.subplots(1, 2), BODIES.items(), strict=True):
        for name, colour in zip([n for n in sorted(names) if body in n], COLOURS, strict=False):
            for i, run in enumerate(results.of(experiment=name)):
                rows = np.array([(point["seconds"], point[what]) for point in run["curve"]])
                axes.plot(*rows.T, color=colour, lw=1, alpha=0.8, label="" if i else name)
        panel(axes, title=title, xlabel="processor seconds of one core")
        axes.legend(frameon=False, fontsize=8)
    return figure


def pages() -> list[Page]:
    """Return the page, made from what is kept."""
    results = Results(DATA / "spatial.jsonl")
    names = list(dict.fromkeys(run["experiment"] for run in results.runs))
    figures = {"bodies_in_space": lambda: curves(results, names)}
    return [Page(REPORTS / "bodies_in_space.md", {"runs": times(results, names)}, figures)]
