"""The table and the picture of docs/reports/bodies_in_space.md, from what spatial_runs measured.

python tools/studies spatial_page       writes the picture and prints the table
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[2]
FOUND = Path(__file__).parent / "data" / "spatial.jsonl"
GOALS = ("1 m/s", "2 m/s", "3 m/s", "20 s")


def read() -> dict[str, list[dict]]:
    """Return the runs of each experiment."""
    runs: dict[str, list[dict]] = {}
    for line in FOUND.read_text().splitlines():
        found = json.loads(line)
        runs.setdefault(found["experiment"], []).append(found)
    return runs


def shown(point: dict | None) -> str:
    """Return a cell: seconds and million steps, or a dash."""
    return f"{point['seconds']:.0f} s, {point['steps'] / 1e6:.0f} M" if point else "-"


def table(runs: dict[str, list[dict]]) -> None:
    """Print a row for each run."""
    print(
        f"| experiment | seed | {' | '.join(GOALS)} | end |\n|---|---|{'---|' * (len(GOALS) + 1)}"
    )
    for name, found in runs.items():
        for run in sorted(found, key=lambda each: each["seed"]):
            cells = [shown(run["met"].get(goal)) for goal in GOALS]
            end = run["end"]
            last = (
                f"{shown(end)}: {end['speed']:.2f} m/s, {end['falls']} falls, {end['life']:.0f} s"
            )
            print(f"| {name} | {run['seed']} | {' | '.join(cells)} | {last} |")


def draw(runs: dict[str, list[dict]]) -> None:
    """Draw the curves of all runs."""
    sys.path.append(str(ROOT / "tools" / "figures"))
    from style import Figure

    figure = Figure(figsize=(8.5, 3.4), layout="constrained")
    plans = (("ant", "Ant: speed of the best so far, m/s", "speed"),
             ("humanoid", "Humanoid: life of the best so far, s", "life"))  # fmt: skip
    for axes, (body, title, what) in zip(figure.subplots(1, 2), plans, strict=True):
        axes.set_title(title)
        axes.set_xlabel("processor seconds of one core")
        for number, name in enumerate(sorted(n for n in runs if body in n)):
            for i, run in enumerate(runs[name]):
                rows = np.array([(p["seconds"], p[what]) for p in run["curve"]])
                label = f"{name}" if i == 0 else None
                axes.plot(*rows.T, color=f"C{number}", lw=1, alpha=0.8, label=label)
        axes.legend(fontsize=8)
        axes.grid(alpha=0.3)
    figure.savefig(ROOT / "docs" / "images" / "bodies_in_space.png", dpi=90)


def main() -> None:
    """See the top of the file."""
    runs = read()
    table(runs)
    draw(runs)
