"""What it gains to evaluate a generation's post-evaluation with the next one's candidates."""

from __future__ import annotations

import time

from report import Table, rate
from speed import CASES, SEED, generations_in

from botschool.config import Experiment
from botschool.evolution.limit import Limit
from botschool.evolution.run import Run


def together_or_apart(seconds: float, repetitions: int) -> Table:
    """The same generations, in one evaluation each and in two; one core."""
    table = Table(
        "A post-evaluation together with the next generation's candidates, or apart; one core",
        f"Steps/s of a run's first generations, about {seconds} s of them, the same on both sides; "
        f"the shortest of {repetitions} repetitions that take turns; no files. Normalised runs "
        "evaluate apart the generations that collect data for it.",
        ["experiment", "generations", "apart", "together", "together / apart"],
    )
    for case in CASES:
        experiment = case.load()
        if experiment.exp.algo == "coevo2":
            continue  # has no post-evaluations
        generations = generations_in(experiment, seconds)
        best = {False: 0.0, True: 0.0}
        for _ in range(repetitions):
            for together in best:
                best[together] = max(best[together], speed(experiment, generations, together))
        table.add(
            case.file,
            f"{generations}",
            rate(best[False]),
            rate(best[True]),
            f"{best[True] / best[False]:.2f}",
        )
    return table


def speed(experiment: Experiment, generations: int, together: bool) -> float:
    """Steps per second of a run's first generations."""
    run = Run(experiment, SEED)
    run.together = together
    run.limit = Limit(generations=generations)
    start = time.perf_counter()
    for _ in range(generations):
        run.advance(goes_on=True)
    run.settle()
    return run.record.steps / (time.perf_counter() - start)
