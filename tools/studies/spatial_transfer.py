"""How long robots that evolved in space walk in MuJoCo's own simulation, nothing retrained.

    python tools/studies spatial_transfer ROBOT...      prints a row for each genotype

The starts are those of `botschool es -f spatialant_mujoco.ini -p -g ROBOT` (or spatialhumanoid_).
"""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np
from study import EXPERIMENTS

from botschool import config, problems
from botschool.problems import Episodes
from botschool.seeds import POST_EVALUATION_SEED

STARTS = 10
APART = "botschool.envs.wrappers:LimbsApart"


def walked(body: str, saved: np.ndarray, wrappers: str) -> str:
    """Return a cell: seconds until a fall and metres a second in ten starts."""
    experiment = config.load(EXPERIMENTS / f"spatial{body}_mujoco.ini")
    experiment.exp = replace(experiment.exp, wrappers=wrappers)
    problem = problems.of(experiment)
    policy = problem.policy(experiment.policy)
    genotype, scale = policy.split(saved)
    outcome = problem.evaluate(
        policy, genotype[None], scale, Episodes.of([1 + POST_EVALUATION_SEED], STARTS), 1000
    )
    seconds = {"ant": 0.05, "humanoid": 0.015}[body]
    lived = outcome.steps * seconds
    goal = {"ant": 20, "humanoid": 10}[body]
    return (
        f"{int((lived >= goal - 1e-6).sum())} | {np.median(lived):.1f} | "
        f"{np.median(outcome.fitness / outcome.steps):.2f}"
    )


def main(arguments: list[str] | None = None) -> None:
    """Print the rows."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("robots", type=Path, nargs="+")
    cells = "goal of 10 | median s | m/s"
    print(f"| robot | as it is: {cells} | limbs apart: {cells} |\n|---|---|---|---|---|---|---|")
    for path in parser.parse_args(arguments).robots:
        body = "humanoid" if "humanoid" in path.name else "ant"
        saved = np.load(path)
        # parts of the ant touch nothing but the ground in MuJoCo, too
        found = [walked(body, saved, wrappers) for wrappers in ("", APART)[: 1 + (body != "ant")]]
        print(f"| {path.stem} | {' | '.join(found)} |", flush=True)
