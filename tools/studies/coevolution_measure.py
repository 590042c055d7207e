"""What the study of co-evolution measures of its runs: tournaments, chases, a cross test.

Each measurement is kept in FOLDER/measured, and made once.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
from coevolution_plan import PLANS, Plan, StudyRun, complete, runs

from botschool.analysis.populations import Population, Populations
from botschool.analysis.tournament import Contest, play

POINTS = 11
"""Times of a run that are measured: equally many steps apart, from its start to the milestone."""
BEST = 10
"""Individuals of each side that meet in a run's tournament."""
CROSS = 5
"""Likewise in the cross test, of each run's last time."""
WATCHED = 5
"""Chases of a time whose every step is looked at: the best predator and the best prey, the second
best and the second best, ..."""
STEP_SECONDS = 0.1


def times(run: StudyRun, millions: float) -> list[int]:
    """The saved generations that are nearest to POINTS equally spaced numbers of steps."""
    steps = run.steps()
    saved = [generation for generation in run.saved() if generation < len(steps)]
    at = steps[saved] / 1e6
    wanted = np.linspace(0, millions, POINTS)
    return sorted({saved[int(np.abs(at - point).argmin())] for point in wanted})


def populations(run: StudyRun, contest: Contest, millions: float, best: int) -> list[Population]:
    """The best individuals of each of these times; all, if there are fewer."""
    saved = Populations(run.home, run.seed, contest.policy)
    loaded = [saved.load(generation) for generation in times(run, millions)]
    return [population.best(min(best, len(population.prey))) for population in loaded]


def tournament(run: StudyRun, millions: float) -> dict:
    """All times of a run against each other, and how those of the same time behave.

    "predators": their mean fitness against the prey of all times, (times, times). Of each time:
    "caught", the share of the chases that end so, and "steps", their median length, for which a
    chase that does not end so counts as the longest; "speed" of both sides, in m/s, and "distance"
    of their centres, in m, means over the steps of a chase, then over chases.
    """
    experiment = run.plan.experiment(run.variant)
    contest = Contest(experiment, run.seed)
    taking_part = populations(run, contest, millions, BEST)
    fitness = play(contest, [p.predators for p in taking_part], [p.prey for p in taking_part])
    generations = times(run, millions)
    same_time = [fitness[i, i] for i in range(len(generations))]
    watched = [watch(contest, population) for population in taking_part]
    return {
        "generations": generations,
        "millions": _rounded(run.steps()[generations] / 1e6, 2),
        "predators": _rounded(fitness.mean(axis=(2, 3)), 4),
        "caught": [round(float((each > 0).mean()), 3) for each in same_time],
        "steps": [round(length(each, experiment.policy.maxsteps)) for each in same_time],
        "speed": [_rounded(speed, 3) for speed, _ in watched],
        "distance": [round(distance, 3) for _, distance in watched],
    }


def length(fitness: np.ndarray, maxsteps: int) -> float:
    """Median steps of chases of which the predator's fitness is known."""
    return float(np.median(maxsteps * (1 - fitness)))


def watch(contest: Contest, population: Population) -> tuple[np.ndarray, float]:
    """Mean speed of predators and prey in m/s, shape (2,), and mean distance in m."""
    speeds, distances = [], []
    for pair in list(zip(population.predators, population.prey, strict=True))[:WATCHED]:
        steps = contest.problem.play(
            contest.policy, np.stack(pair), None, 0, 0, contest.policy.config.maxsteps
        )
        places = np.array([step.state[:6].reshape(2, 3)[:, :2] for step in steps]) / 1000
        moved = np.linalg.norm(np.diff(places, axis=0), axis=2)
        speeds.append(moved.mean(axis=0) / STEP_SECONDS)
        distances.append(np.linalg.norm(places[:, 0] - places[:, 1], axis=1).mean())
    return np.mean(speeds, axis=0), float(np.mean(distances))


def cross_test(taking_part: list[StudyRun], millions: float) -> list[list[float]]:
    """Mean fitness of the last predators of each run against the last prey of each."""
    contest = Contest(taking_part[0].plan.experiment(taking_part[0].variant), 0)
    last = [populations(run, contest, millions, CROSS)[-1] for run in taking_part]
    each = min(len(population.prey) for population in last)
    last = [population.best(each) for population in last]
    fitness = contest.meet(
        np.concatenate([population.predators for population in last]),
        np.concatenate([population.prey for population in last]),
    )
    count = len(taking_part)
    return _rounded(fitness.reshape(count, each, count, each).mean(axis=(1, 3)), 4)


def of_plan(folder: Path, plan: Plan) -> dict:
    """All that is known of a plan's runs.

    "reached": of each run the million steps and generations that it has. What is measured are the
    runs that have reached "millions": the last milestone that all have, or else the first one.
    """
    everyone = runs(folder, plan)
    millions = complete(folder, plan) or plan.milestones[0]
    done = [run for run in everyone if run.reached() >= millions]
    found = {
        run.name: _kept(
            folder, f"{run.name} {millions:g}", lambda run=run: tournament(run, millions)
        )
        for run in done
    }
    names = [run.name for run in done]
    cross = None
    if len(done) > 1:
        name = f"cross {plan.name} {millions:g} {len(done)}"
        cross = _kept(folder, name, lambda: cross_test(done, millions))
    return {
        "about": plan.about,
        "millions": millions,
        "reached": {
            run.name: [round(run.reached(), 1), max(len(run.steps()) - 1, 0)] for run in everyone
        },
        "runs": found,
        "cross": {"names": names, "predators": cross} if cross else None,
    }


def measured(folder: Path, plans: tuple[Plan, ...] = PLANS) -> dict:
    """{plan: what is known of it}."""
    return {plan.name: of_plan(folder, plan) for plan in plans}


def _kept(folder: Path, name: str, make: Callable[[], object]) -> object:
    """What was measured before under this name, or is now."""
    file = folder / "measured" / f"{name.replace(' ', '_')}.json"
    if file.exists():
        return json.loads(file.read_text(encoding="utf-8"))
    print(f"measuring {name}", flush=True)
    file.parent.mkdir(exist_ok=True)
    found = make()
    file.write_text(json.dumps(found), encoding="utf-8")
    return found


def _rounded(values: np.ndarray, digits: int) -> list:
    return np.round(values, digits).tolist()
