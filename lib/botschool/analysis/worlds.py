"""Draw how a robot copes with other physics: its return against one number of its world."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from botschool import problems
from botschool.analysis.figure import check_picture, new_figure
from botschool.config import Experiment
from botschool.errors import BotschoolError
from botschool.evolution.evaluate import means
from botschool.problems import Episodes, physics
from botschool.seeds import POST_EVALUATION_SEED
from botschool.terminal import readable


def returns(
    experiment: Experiment,
    robot: np.ndarray,
    name: str,
    value: float,
    seed: int,
    episodes: int,
    workers: int = 1,
) -> np.ndarray:
    """Return the robot's return in each episode where this number of the world has this value.

    What else the experiment says about physics stays. Raises BotschoolError.
    """
    spans = physics.read(experiment.exp.physics) | {name: (value, value)}
    text = ", ".join(f"{key}={low!r}..{high!r}" for key, (low, high) in spans.items())
    exp = replace(experiment.exp, physics=text)
    problem = problems.of(replace(experiment, exp=exp))
    policy = problem.policy(experiment.policy)
    genotype, normalisation = policy.split(robot)
    asked = Episodes.of([seed + POST_EVALUATION_SEED], episodes)
    steps = policy.config.post_steps
    return problem.evaluate(policy, genotype[None], normalisation, asked, steps, workers).fitness


def worlds_command(
    experiment: Experiment,
    robot: np.ndarray,
    file: str,
    text: str,
    output: Path | None,
    seed: int,
    points: int,
    episodes: int,
    workers: int,
) -> None:
    """Measure and draw the robot's returns along one range of physics. Raises BotschoolError."""
    spans = physics.read(text)
    (name, (low, high)) = next(iter(spans.items()), ("", (0.0, 0.0)))
    if len(spans) != 1 or low == high:
        raise BotschoolError(
            f"--physics {text} is not possible: give one range, as in --physics friction=0.2..2."
        )
    check_picture(output)
    places = np.linspace(low, high, points)
    if name == "delay":
        places = np.arange(low, high + 1)
    measured = [
        returns(experiment, robot, name, place, seed, episodes, workers)
        for place in places.tolist()
    ]
    mean = np.array([float(means(each, len(each))[0]) for each in measured])
    deviation = np.array([each.std() for each in measured])
    print(f"{file}: returns in {episodes} episodes")
    for place, middle, around in zip(places, mean, deviation, strict=True):
        print(f"{name} {place:8.4g}   {readable(middle)} \u00b1 {readable(around)}")
    with new_figure(output, height=4.2, width=7.2) as figure:
        axes = figure.add_subplot()
        axes.fill_between(places, mean - deviation, mean + deviation, alpha=0.2, lw=0)
        axes.plot(places, mean, "o-", ms=4)
        own = physics.NUMBERS[name].own
        if low <= own <= high:
            axes.axvline(own, color="0.5", lw=1, ls="--", label="the robot's own")
            axes.legend()
        axes.set(
            xlabel=f"{name}: {physics.NUMBERS[name].meaning}",
            ylabel=f"return, mean and deviation of {episodes} episodes",
            title=f"{experiment.exp.environment}: {file} in other worlds",
        )
    if output is not None:
        print(f"picture: {output}")
