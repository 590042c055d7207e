"""Draw the fitness around a robot: along two random directions of the space of genotypes."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

from botschool import problems
from botschool.analysis.figure import check_picture, new_figure
from botschool.config import Experiment
from botschool.errors import BotschoolError
from botschool.evolution.evaluate import means
from botschool.policies.policy import Policy
from botschool.problems import Episodes, Problem
from botschool.seeds import POST_EVALUATION_SEED, generator
from botschool.terminal import readable

RANDOM = 3
"""First word of the stream that draws the directions."""


def directions(seed: int, genotype: np.ndarray) -> np.ndarray:
    """Return two orthogonal directions, (2, parameters), each as long as the genotype."""
    first, second = generator(seed, RANDOM).standard_normal((2, len(genotype)))
    second -= first * (np.sum(first * second) / np.sum(first**2))
    size = np.sqrt(np.sum(genotype**2)) or 1.0
    return np.array([each * (size / np.sqrt(np.sum(each**2))) for each in (first, second)])


def measure(
    problem: Problem,
    policy: Policy,
    robot: tuple[np.ndarray, np.ndarray | None],
    places: np.ndarray,
    seed: int,
    episodes: int,
    workers: int = 1,
) -> np.ndarray:
    """Return the fitness at each pair of places along the two directions, (places, places).

    Row: place along the second direction. All points play the same episodes.
    """
    genotype, normalisation = robot
    along = directions(seed, genotype)
    rows, begun = [], time.monotonic()
    for place in places:
        row = genotype + places[:, None] * along[0] + place * along[1]
        asked = Episodes.of([seed + POST_EVALUATION_SEED] * len(places), episodes)
        steps = policy.config.post_steps
        found = problem.evaluate(policy, row, normalisation, asked, steps, workers)
        rows.append(means(found.fitness, episodes))
        if len(rows) == 1 and (left := (time.monotonic() - begun) * len(places)) > 5:
            print(f"This takes about {left:.0f} s.", file=sys.stderr)
    return np.array(rows)


def landscape_command(
    experiment: Experiment,
    robot: np.ndarray,
    name: str,
    output: Path | None,
    seed: int,
    points: int,
    reach: float,
    episodes: int,
    workers: int,
) -> None:
    """Measure and draw the landscape around a saved robot. Raises BotschoolError."""
    if experiment.competitive:
        raise BotschoolError(
            f"{experiment.exp.environment} has two sides, whose fitness depends on the other one: "
            "a landscape is for one robot."
        )
    check_picture(output)
    problem = problems.of(experiment)
    policy = problem.policy(experiment.policy)
    places = np.linspace(-reach, reach, points)
    try:
        fitness = measure(problem, policy, policy.split(robot), places, seed, episodes, workers)
    finally:
        problem.close()
    middle = points // 2
    own, best = float(fitness[middle, middle]), float(fitness.max())
    print(
        f"{name}: {readable(own)} in {episodes} episodes; the best of {points}x{points} points: "
        f"{readable(best)}; {np.sum(fitness >= 0.9 * own)} of them reach 90 % of the robot"
    )
    title = f"{experiment.exp.environment}: fitness around {name}"
    _draw(fitness, places, title, output)
    if output is not None:
        print(f"picture: {output}")


def _draw(fitness: np.ndarray, places: np.ndarray, title: str, output: Path | None) -> None:
    with new_figure(output, height=6.0, width=7.2) as figure:
        axes = figure.add_subplot()
        edge = places[-1] + (places[1] - places[0]) / 2
        extent = (-edge, edge, -edge, edge)
        image = axes.imshow(fitness, origin="lower", extent=extent, cmap="viridis")
        if fitness.min() < fitness.max():
            axes.contour(places, places, fitness, 6, colors="white", linewidths=0.6, alpha=0.6)
        axes.plot(0, 0, "o", ms=9, mfc="none", mec="#D55E00", mew=2.5, label="the robot")
        unit = "random direction (1: the genotype's length)"
        axes.set(xlabel=f"first {unit}", ylabel=f"second {unit}", title=title)
        axes.legend(loc="upper right")
        figure.colorbar(image, label="mean return", shrink=0.85)
