"""How far trainings of PyBullet's Humanoid by SAC have come.

    python tools/studies humanoid FOLDER            prints the table
    python tools/studies humanoid FOLDER --write    renews docs/reports/bodies.md and its figure

FOLDER holds trainings of `botschool rl train --algo sac --env HumanoidBulletEnv-v5 -o FOLDER`. One
that was stopped is told with the steps of its last post-evaluation.
"""

from __future__ import annotations

import argparse
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from locomotor_curves import COLOURS, LONGEST, NEW_EPISODES, NEW_SEED, PUBLISHED, ROOT
from report import Table, machine

from botschool.rl.agent import Agent, play
from botschool.rl.folder import Evaluations, find_runs

WALKS = 5.0
"""Metres from which on an episode is one of walking: far more than a fall ahead."""


@dataclass
class Trained:
    """A training, and its best post-evaluated agent in new episodes."""

    seed: int
    evaluations: Evaluations
    returns: np.ndarray
    steps: np.ndarray
    metres: np.ndarray


def measured(run) -> Trained:
    """New episodes, which had no part in choosing the agent."""
    agent, env = Agent.load(run.best), run.make_env()
    returns, steps, metres = [], [], []
    for episode in range(NEW_EPISODES):
        (total,), (count,) = play(agent, [env], [NEW_SEED + episode])
        returns.append(total)
        steps.append(count)
        metres.append(env.unwrapped._place[0])
    env.close()
    found = map(np.array, (returns, steps, metres))
    return Trained(run.settings().seed, run.evaluations(), *found)


def table_of(trained: list[Trained]) -> Table:
    """A row for each training."""
    mean, deviation = PUBLISHED["humanoid"]
    table = Table(
        "Humanoid, version 5, by SAC",
        f"The model with the best post-evaluation in {NEW_EPISODES} new episodes: mean return and "
        "standard deviation, mean way ahead and length of an episode "
        f"({LONGEST} steps are 16.5 s), and in how many of them it goes more than {WALKS:g} m. "
        f"The post-evaluations are of {trained[0].evaluations.returns.shape[1]} episodes. "
        f"Published for evolution with 250 directions: {mean} +- {deviation} after 100 M steps.",
        ["seed", "steps", "best post-evaluation", "new episodes", "way", "steps / episode",
         "walks"],
    )  # fmt: skip
    for one in trained:
        table.add(
            str(one.seed),
            f"{one.evaluations.steps[-1] / 1e6:.2f} M",
            f"{one.evaluations.best:.0f}",
            f"{one.returns.mean():.0f} +- {one.returns.std(ddof=1):.0f}",
            f"{one.metres.mean():.1f} m",
            f"{one.steps.mean():.0f}",
            f"{np.sum(one.metres > WALKS)} of {NEW_EPISODES}",
        )
    return table


def draw(trained: list[Trained], picture: Path) -> None:
    """Post-evaluations of each training."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7, 3.2), layout="constrained")
    axes = figure.subplots()
    for one, colour in zip(trained, COLOURS, strict=False):
        steps, means = one.evaluations.steps / 1e6, one.evaluations.returns.mean(axis=1)
        axes.plot(steps, means, "o-", ms=4, color=colour, lw=1.8, label=f"seed {one.seed}")
    mean = PUBLISHED["humanoid"][0]
    axes.axhline(mean, color="black", lw=1, ls="--", label="published, evolution, 100 M")
    axes.set(xlabel="million steps", ylabel="post-evaluated", xlim=(0, None), ylim=(-50, None))
    axes.grid(color="#eeeeee")
    axes.spines[["top", "right"]].set_visible(False)
    figure.legend(loc="outside lower center", ncols=4)
    figure.savefig(picture, dpi=110)


def write(trained: list[Trained]) -> None:
    """The table into docs/reports/bodies.md, and the figure."""
    draw(trained, ROOT / "docs" / "images" / "humanoid.png")
    table, page = table_of(trained), ROOT / "docs" / "reports" / "bodies.md"
    block = f"\n{table.markdown()}\n\n({table.about})\n"
    text, count = re.subn(
        "(<!-- BEGIN HUMANOID -->\n).*?(<!-- END HUMANOID -->)",
        lambda found: f"{found[1]}{block}\n{found[2]}",
        page.read_text(encoding="utf-8"),
        flags=re.DOTALL,
    )
    if not count:
        raise SystemExit(f"{page} lacks the markers of HUMANOID.")
    page.write_text(text, encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--write", action="store_true", help="renew the document")
    options = parser.parse_args()
    trained = sorted(map(measured, find_runs(options.folder)), key=lambda one: one.seed)
    if not trained:
        raise SystemExit(f"{options.folder} holds no trainings.")
    print(f"Machine: {machine()}\n")
    table_of(trained).show(markdown=True)
    if options.write:
        write(trained)
