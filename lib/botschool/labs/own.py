"""Prove runs of a student's own strategy, without importing it here.

Its arithmetic may differ in the last bits between machines, so a repeated run need not be equal.
Instead, the strategy runs in the sandbox and is told the fitness values of the checkpoint. Its
candidates must then get this fitness, in generations drawn at random.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from botschool.evolution.algorithms.own import POPSIZE
from botschool.evolution.evaluate import Evaluator, mean
from botschool.evolution.record import RunFiles
from botschool.grading.declare.checks import Wrong
from botschool.grading.run.confined import MachineFault
from botschool.grading.run.student import Student
from botschool.labs.evolving import evaluator_of
from botschool.labs.saved import MAX_BYTES, SavedRun, member
from botschool.sandbox.inside import read_inside
from botschool.wrappers import keywords

GENERATIONS = 5
"""Generations of a run to evaluate again, besides the one of its best robot."""
EQUAL = 0.9
"""Share of the candidates that must get exactly the same fitness."""
LONGER = 2
"""Largest ratio of a generation's steps to the steps in its stat file, either way."""


def told_fitness(run: SavedRun, folder: Path) -> np.ndarray | None:
    """Return all fitness values that the checkpoint holds; None if it is missing or damaged."""
    file = RunFiles(folder / run.condition.name, run.seed).checkpoint
    try:
        content = read_inside(file.parent, file.name, MAX_BYTES)
        if len(content) > MAX_BYTES:
            return None
        told = member(content, "algorithm.told", MAX_BYTES)
    except (OSError, ValueError, KeyError):
        return None
    good = told.dtype == np.float64 and told.ndim == 1 and np.isfinite(told).all()
    return told if good else None


def replayed(run: SavedRun, folder: Path, student: Student, rng: np.random.Generator) -> str:
    """Replay a run with its strategy in the sandbox; return what is wrong, "" if nothing."""
    told = told_fitness(run, folder)
    if told is None:
        return "its checkpoint is missing or damaged"
    evaluator = evaluator_of(run.condition, run.seed)
    best = int((run.stat[:, 2] == run.stat[-1, 2]).argmax())
    took = np.diff(run.stat[:, 0], prepend=0)
    drawn = {best, int(took.argmax()), *rng.permutation(len(run.stat))[:GENERATIONS].tolist()}
    experiment, at = run.condition.experiment, 0
    options = experiment["algo"].get("options", "")
    rows = keywords(options).get("popsize", POPSIZE)
    initial = np.array([evaluator.policy.initial(run.seed, i) for i in range(rows)])
    function = experiment["exp"]["algo"].partition(":")[2]
    given: Any = initial
    try:
        for generation, line in enumerate(run.stat):
            asked = student.run(_ask, function, options, run.seed, generation, given, said=function)
            candidates = np.asarray(asked["candidates"], dtype=float)
            given = told[at : at + len(candidates)]
            at += len(candidates)
            if len(given) < len(candidates) or (given.max(), mean(given)) != (line[3], line[4]):
                return f"generation {generation} has another fitness than its stat file tells"
            if generation == best and not np.allclose(
                candidates[given.argmax()], run.genotype, rtol=1e-6, atol=1e-9
            ):
                return "strategy.py does not lead to its robot"
            if generation in drawn:
                seeds = np.full(len(candidates), int(asked["seed"]), dtype=np.uint64)
                if said := _measured_again(evaluator, candidates, seeds, given, took[generation]):
                    return f"{said} in generation {generation}"
    except Wrong as error:
        return str(error)
    except (MachineFault, MemoryError):
        raise
    except Exception:  # the submission can forge what its child sends
        return "strategy.py gives no candidates"
    return "" if at == len(told) else "its checkpoint is of another run"


def _measured_again(
    evaluator: Evaluator, candidates: np.ndarray, seeds: np.ndarray, told: np.ndarray, took: float
) -> str:
    """Evaluate a generation again; return what is wrong with it, "" if nothing."""
    again = evaluator.measure(candidates, seeds)
    if (again.fitness == told).mean() < EQUAL:
        return "strategy.py gives other candidates"
    steps = again.steps + evaluator.post_evaluate(candidates[told.argmax()], stoppable=False).steps
    if not steps <= took * LONGER <= steps * LONGER**2:
        return f"its stat file tells {took:.0f} steps instead of {steps}"
    return ""


def _ask(
    student: Any, function: str, options: str, seed: int, generation: int, given: Any
) -> dict[str, Any]:
    """Runs in the child: tell the strategy the fitness, then ask it for candidates.

    For generation 0, make the strategy instead of telling it.
    """
    if generation == 0:
        from botschool.evolution.algorithms.own import Own, OwnConfig

        found = getattr(student, function)
        config = OwnConfig(options=options)
        student.evolving = Own(f"strategy:{function}", config, given.__getitem__, seed, found)
    else:
        student.evolving.tell(given)
    candidates, seeds = student.evolving.ask()
    return {"candidates": candidates, "seed": int(seeds[0])}
