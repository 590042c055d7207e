"""How far runs of the locomotors have come, beside the published runs of 50 M steps.

    python tests/bench/locomotor_curves.py FOLDER --picture docs/images/locomotors.png

FOLDER holds a run in a folder of its own for each robot, named as its file in data/experiments:
`botschool es -f data/experiments/hopper.ini -s 1 -o FOLDER/hopper`. Prints a Markdown table.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from report import Table, machine

from botschool import config
from botschool.analysis.runs import BEST_POST, GENERATION_AVERAGE, STEPS, read_stat
from botschool.evolution.record import RunFiles
from botschool.evolution.run import Run
from botschool.problems import Episodes

DATA = Path(__file__).parents[2] / "data" / "experiments"
PUBLISHED = {
    "hopper": (2261, 264),
    "halfcheetah": (2480, 474),
    "ant": (1576, 184),
    "walker2d": (910, 477),
    "humanoid": (931, 736),
}
"""Mean and standard deviation of the best post-evaluated fitness, 10 seeds (docs/specification.md,
"Published results")."""
SEED = 1
NEW_SEED, NEW_EPISODES = 2_000_000, 50


def projection(stat: np.ndarray, steps: np.ndarray) -> np.ndarray:
    """Best post-evaluated fitness to be expected after more `steps`.

    The straight line along the last two doublings of the steps, on a logarithmic axis, from the
    curve's end: it supposes that each doubling goes on to bring as much as those did.
    """
    logs, end = np.log(stat[:, STEPS]), np.log(stat[-1, STEPS])
    points = np.linspace(end - np.log(4), end, 200)  # equally weighted along the axis
    slope = np.polyfit(points - end, np.interp(points, logs, stat[:, BEST_POST]), 1)[0]
    return stat[-1, BEST_POST] + slope * (np.log(steps) - end)


def new_episodes(experiment, files: RunFiles) -> np.ndarray:
    """Returns of the best post-evaluated robot in episodes that had no part in choosing it."""
    run = Run(experiment, SEED)
    genotype, normalisation = run.policy.split(np.load(files.bestg))
    episodes = Episodes.of([NEW_SEED], NEW_EPISODES)
    outcome = run.problem.evaluate(
        run.policy, genotype[None], normalisation, episodes, experiment.policy.maxsteps
    )
    run.problem.close()
    return outcome.fitness


def draw(curves: dict[str, np.ndarray], budgets: dict[str, float], picture: Path) -> None:
    """A panel for each robot."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13, 3.4), layout="constrained")
    panels = figure.subplots(1, len(curves), squeeze=False)[0]
    for axes, (robot, stat) in zip(panels, curves.items(), strict=True):
        steps, end = stat[:, STEPS] / 1e6, budgets[robot]
        ahead = np.geomspace(steps[-1], end, 50)
        axes.plot(steps, stat[:, GENERATION_AVERAGE], color="#bbbbbb", lw=0.8, label="average")
        axes.plot(steps, stat[:, BEST_POST], color="#0072b2", lw=2, label="best post-evaluated")
        expected = projection(stat, 1e6 * ahead)
        axes.plot(ahead, expected, "--", color="#0072b2", lw=1.2, label="projected")
        mean, deviation = PUBLISHED[robot]
        style = {"fmt": "o", "color": "#d55e00", "capsize": 4, "label": "published, 10 seeds"}
        axes.errorbar(end, mean, deviation, **style)
        axes.set_xscale("log")
        axes.set(title=f"{robot} (seed {SEED})", xlabel="million steps", xlim=(0.05, 1.6 * end))
        axes.set_ylim(bottom=min(0, *stat[:, BEST_POST]) - 50)
        axes.grid(color="#eeeeee")
        axes.spines[["top", "right"]].set_visible(False)
    panels[0].set_ylabel("fitness of an episode")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
    figure.savefig(picture, dpi=110)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--picture", type=Path, help="also draw the curves")
    options = parser.parse_args()
    table = Table(
        "Locomotors, version 5",
        f"Seed {SEED}. New episodes: mean and standard deviation of {NEW_EPISODES} which had no "
        "part in choosing the robot. Projected: best post-evaluated fitness if each doubling of "
        "the steps goes on to bring as much as the last two did. Published: means of 10 seeds at "
        "the file's budget.",
        [
            "robot",
            "steps",
            "best post-evaluated",
            "new episodes",
            "budget",
            "projected",
            "published",
        ],
    )
    curves, budgets = {}, {}
    for robot, (mean, deviation) in PUBLISHED.items():
        files = RunFiles(options.folder / robot, SEED)
        if not files.stat.is_file():
            continue
        experiment = config.load(DATA / f"{robot}.ini")
        stat, budget = read_stat(files.stat), experiment.algo.maxmsteps
        new = new_episodes(experiment, files)
        table.add(
            robot,
            f"{stat[-1, STEPS] / 1e6:.2f} M",
            f"{stat[-1, BEST_POST]:.0f}",
            f"{new.mean():.0f} +- {new.std(ddof=1):.0f}",
            f"{budget:g} M",
            f"{projection(stat, np.array(1e6 * budget)):.0f}",
            f"{mean} +- {deviation}",
        )
        curves[robot], budgets[robot] = stat, budget
    print(f"Machine: {machine()}\n")
    table.show(markdown=True)
    if options.picture:
        draw(curves, budgets, options.picture)


if __name__ == "__main__":
    main()
