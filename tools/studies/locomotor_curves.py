"""How far runs of the locomotors have come, beside the published runs of 50 M steps.

    python tools/studies locomotor_curves FOLDER            prints the table
    python tools/studies locomotor_curves FOLDER --write    renews documents and robots

FOLDER holds a folder of runs for each robot, named as the robot, made with linear policies:
`botschool es -f data/experiments/hopper_linear.ini -s 1 -o FOLDER/hopper`. --write renews the rows
of these robots between the LOCOMOTORS markers of docs/reports/bodies.md and of
data/genotypes/README.md, the best robot of each in data/genotypes, and the figure:
docs/images/locomotors.png of all five, or docs/images/locomotors_ROBOT.png of fewer.
"""

from __future__ import annotations

import argparse
import re
import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from report import Table, machine

from botschool import config
from botschool.analysis.runs import BEST_POST, STEPS, read_stat
from botschool.evolution.record import RunFiles
from botschool.policies.policy import Policy
from botschool.problems import Episodes, make
from botschool.wrappers import parse

ROOT = Path(__file__).parents[2]
DATA = ROOT / "data"
PUBLISHED = {
    "hopper": (2261, 264),
    "halfcheetah": (2480, 474),
    "walker2d": (910, 477),
    "ant": (1576, 184),
    "humanoid": (931, 736),
}
"""Mean and standard deviation of the best post-evaluated fitness, 10 seeds (docs/specification.md,
"Published results")."""
BUDGET = {"humanoid": 100e6}
NEW_SEED, NEW_EPISODES = 2_000_000, 50
LONGEST = 1000
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9")


@dataclass
class Seed:
    """A run, and its best post-evaluated robot in episodes that had no part in choosing it."""

    seed: int
    files: RunFiles
    stat: np.ndarray
    bonus: float
    """The alive bonus of the search, a step."""
    paid: np.ndarray
    """Returns with the wrappers of the search, as `botschool es -p` prints them."""
    returns: np.ndarray
    """Without."""
    steps: np.ndarray
    metres: np.ndarray

    @property
    def done(self) -> float:
        """Steps of the run."""
        return float(self.stat[-1, STEPS])

    @property
    def curve(self) -> np.ndarray:
        """Best post-evaluated fitness so far, a value a generation, without the alive bonus: of a
        robot that falls a little more than this."""
        return self.stat[:, BEST_POST] - self.bonus * LONGEST

    @property
    def best(self) -> float:
        """Best post-evaluated fitness, likewise."""
        return float(self.curve[-1])


def experiment_of(robot: str):
    """The experiment of its runs."""
    return config.load(DATA / "experiments" / f"{robot}_linear.ini")


def seeds_of(folder: Path, robot: str) -> list[Seed]:
    """The runs of a robot that a folder holds."""
    experiment = experiment_of(robot)
    problem = make(experiment.exp.environment)
    wrapped = make(experiment.exp.environment, wrappers=experiment.exp.wrappers)
    bonus = sum(each.named.get("bonus", 0) for each in parse(experiment.exp.wrappers))
    policy = Policy(problem.name, problem.interface, experiment.policy)
    episodes = Episodes.of([NEW_SEED], NEW_EPISODES)
    found = []
    for path in sorted((folder / robot).glob("statS*.npy")):
        seed = int(re.findall(r"\d+", path.stem)[0])
        files, stat = RunFiles(folder / robot, seed), read_stat(path)
        if not len(stat) or not files.bestg.is_file():
            continue
        genotype, normalisation = policy.split(np.load(files.bestg))
        robots = policy, genotype[None], normalisation
        paid = wrapped.evaluate(*robots, episodes, LONGEST).fitness
        returns, steps, metres = [], [], []
        for episode in range(NEW_EPISODES):
            one = episodes.select(slice(episode, episode + 1))
            outcome = problem.evaluate(*robots, one, LONGEST)
            returns.append(outcome.fitness[0])
            steps.append(outcome.steps[0])
            metres.append(problem._env.unwrapped._place[0])
        measured = map(np.array, (paid, returns, steps, metres))
        found.append(Seed(seed, files, stat, bonus, *measured))
    wrapped.close()
    problem.close()
    return sorted(found, key=lambda s: s.seed)


def table_of(runs: dict[str, list[Seed]]) -> Table:
    """A row for each run."""
    table = Table(
        "Locomotors, version 5, linear policies",
        f"Best post-evaluated robots in {NEW_EPISODES} new episodes which had no part in choosing "
        "them: mean return and standard deviation, mean way ahead and length of an episode "
        f"({LONGEST} steps are 16.5 s). Published: 10 seeds after 50 M steps, Humanoid 100 M.",
        ["robot", "seed", "steps", "best post-evaluated", "new episodes", "way", "steps / episode",
         "published"],
    )  # fmt: skip
    for robot, seeds in runs.items():
        mean, deviation = PUBLISHED[robot]
        for run in seeds:
            table.add(
                robot,
                str(run.seed),
                f"{run.done / 1e6:.2f} M",
                f"{run.best:.0f}",
                f"{run.returns.mean():.0f} +- {run.returns.std(ddof=1):.0f}",
                f"{run.metres.mean():.1f} m",
                f"{run.steps.mean():.0f}",
                f"{mean} +- {deviation}",
            )
    return table


def draw(runs: dict[str, list[Seed]], picture: Path) -> None:
    """A panel for each robot (one or all), a line for each seed."""
    from matplotlib.figure import Figure

    width, columns = (13, 7) if len(runs) > 1 else (7, 4)
    figure = Figure(figsize=(width, 3.4), layout="constrained")
    panels = figure.subplots(1, len(runs), squeeze=False)[0]
    for axes, (robot, seeds) in zip(panels, runs.items(), strict=True):
        end, (mean, deviation) = BUDGET.get(robot, 50e6) / 1e6, PUBLISHED[robot]
        for run, colour in zip(seeds, COLOURS, strict=False):
            steps = run.stat[:, STEPS] / 1e6
            axes.plot(steps, run.curve, color=colour, lw=1.8, label=f"seed {run.seed}")
        style = {"fmt": "o", "color": "black", "capsize": 4, "label": "published, 10 seeds"}
        axes.errorbar(end, mean, deviation, **style)
        axes.set_xscale("log")
        axes.set(title=robot, xlabel="million steps", xlim=(0.05, 1.6 * end))
        axes.grid(color="#eeeeee")
        axes.spines[["top", "right"]].set_visible(False)
    panels[0].set_ylabel("best post-evaluated fitness")
    handles = panels[0].get_legend_handles_labels()
    figure.legend(*handles, loc="outside lower center", ncols=columns)
    figure.savefig(picture, dpi=110)


def put(path: Path, renewed: dict[str, list[str]]) -> None:
    """Replaces the rows of these robots in the table that a document has between its markers."""
    begin, end = "<!-- BEGIN LOCOMOTORS -->", "<!-- END LOCOMOTORS -->"
    before, _, rest = path.read_text(encoding="utf-8").partition(begin)
    table, found, after = rest.partition(end)
    if not found:
        raise SystemExit(f"{path} lacks the markers {begin} and {end}.")
    lines = table.splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith("|---") or "---:" in line)
    stop = next((i for i in range(start, len(lines)) if not lines[i].startswith("|")), len(lines))
    old = {robot: [line for line in lines[start + 1 : stop] if named(line, robot)]
           for robot in PUBLISHED}  # fmt: skip
    rows = [row for robot in PUBLISHED for row in renewed.get(robot, old[robot])]
    text = "\n".join([*lines[: start + 1], *rows, *lines[stop:]])
    path.write_text(f"{before}{begin}{text}\n{end}{after}", encoding="utf-8")


def named(row: str, robot: str) -> bool:
    """Whether a row of a table is this robot's: its first cell begins with its name."""
    return re.match(rf"\| {robot}(_|\b)", row) is not None


def write(runs: dict[str, list[Seed]]) -> None:
    """Tables and figure into the documents, the best robots into data/genotypes."""
    images = ROOT / "docs" / "images"
    if runs.keys() == PUBLISHED.keys():
        draw(runs, images / "locomotors.png")
    else:
        for robot, seeds in runs.items():
            draw({robot: seeds}, images / f"locomotors_{robot}.png")
    cells = table_of(runs).rows
    put(
        ROOT / "docs" / "reports" / "bodies.md",
        {r: [f"| {' | '.join(row)} |" for row in cells if row[0] == r] for r in runs},
    )
    rows = {}
    for robot, seeds in runs.items():
        best = max(seeds, key=lambda run: run.best)
        name = f"{robot}_linear"
        shutil.copyfile(best.files.bestg, DATA / "genotypes" / f"{name}.npy")
        rows[robot] = [
            f"| {name}.npy | {name}.ini | `botschool es -f data/experiments/{name}.ini "
            f"-s {best.seed} --steps {best.done:.0f}` (++) | {best.done:,.0f} | "
            f"{best.paid.mean():.0f} |"
        ]
    put(DATA / "genotypes" / "README.md", rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--write", action="store_true", help="renew documents and robots")
    options = parser.parse_args()
    runs = {robot: seeds_of(options.folder, robot) for robot in PUBLISHED}
    runs = {robot: seeds for robot, seeds in runs.items() if seeds}
    if not runs:
        raise SystemExit(f"{options.folder} holds no runs of {', '.join(PUBLISHED)}.")
    print(f"Machine: {machine()}\n")
    table_of(runs).show(markdown=True)
    if options.write:
        write(runs)
