"""Make runs that evolve, read them, and prove them by evaluating their robots again."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext, redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np

from botschool import problems
from botschool.errors import BotschoolError
from botschool.evolution.algorithms.sides import everyone, mean
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.evaluate import Evaluator
from botschool.evolution.limit import Limit
from botschool.evolution.record import STAT, RunFiles
from botschool.evolution.replicate import replicate
from botschool.evolution.run import Options, Run
from botschool.labs.declare import STRATEGY, Condition
from botschool.labs.saved import SavedRun, numbers, stat_of


def make_all(
    condition: Condition, seeds: list[int], folder: Path, workers: int, student: Any
) -> bool:
    """Make or continue all runs that are not finished; return False if the user stopped."""
    terminal = sys.stdout.isatty()
    options = Options(
        workers=workers, generations=condition.generations, resume=True, terminal=terminal
    )
    quiet = nullcontext() if terminal else redirect_stdout(io.StringIO())
    place = folder.resolve()
    with quiet, own_strategy(place.parent.parent) if condition.own else nullcontext():
        return replicate(condition.load(), seeds, place, options)


@contextmanager
def own_strategy(folder: Path) -> Iterator[None]:
    """Let Python import the student's own strategy from the laboratory's folder."""
    here = Path.cwd()
    os.chdir(folder)
    sys.modules.pop(STRATEGY, None)
    try:
        yield
    finally:
        if os.getcwd() in sys.path:
            sys.path.remove(os.getcwd())
        os.chdir(here)


def read(condition: Condition, seed: int, folder: Path) -> SavedRun | None:
    """Return the run with this seed; None if it is missing, damaged or not finished."""
    files, algo = RunFiles(folder, seed), condition.load().algo
    stat, genotype = stat_of(files.stat), numbers(files.bestg, 1)
    if stat is None or genotype is None:
        return None
    steps = round(algo.maxmsteps * 1e6) if hasattr(algo, "maxmsteps") else np.inf
    generations = condition.generations or getattr(algo, "ngenerations", 0) or np.inf
    if stat[-1, 0] < steps and len(stat) < generations:
        return None
    populations = {}
    for generation in milestones(condition):
        found = numbers(files.populations(generation), 2)
        if found is None:
            return None
        populations[generation] = found
    return SavedRun(condition, seed, stat, genotype, populations)


def milestones(condition: Condition) -> list[int]:
    """Return the generations whose populations a co-evolution saves; [] for other runs."""
    experiment = condition.load()
    if not experiment.competitive:
        return []
    last, each = experiment.algo.ngenerations, experiment.algo.saveeach
    return sorted({*range(0, last + 1, each), last})


def made(condition: Condition, seed: int, student: Any = None) -> SavedRun:
    """Make the run here and return it."""
    experiment = condition.load()
    wanted, populations = milestones(condition), {}
    run = (Coevolution if wanted else Run)(experiment, seed)
    if not wanted:
        run.limit = Limit(steps=run.max_steps, generations=condition.generations or np.inf)
    while not run.limit.reached(run):
        run.advance(goes_on=True)
        if run.record.generation in wanted:
            populations[run.record.generation] = _individuals(run)
    run.settle()
    stat = run.record.rows()[:, : len(STAT)]
    return SavedRun(condition, seed, stat, np.array(run.record.bestg), populations)


def _individuals(run: Any) -> np.ndarray:
    """Return the populations of both sides, in the order of their file."""
    networks, _ = run.algorithm.individuals(None)
    return np.concatenate(networks)


def genuine(run: SavedRun) -> bool:
    """Return whether the saved robots get exactly the fitness that the run's files state."""
    if run.populations:
        return _met_alike(run)
    evaluator = evaluator_of(run.condition, run.seed)
    try:
        genotype, normalisation = evaluator.policy.split(run.genotype)
        return bool(evaluator.post_fitness(genotype, normalisation) == run.stat[-1, 2])
    except BotschoolError:
        return False


def evaluator_of(condition: Condition, seed: int) -> Evaluator:
    """Return an evaluator for the candidates of a run. This imports no strategy."""
    experiment = condition.load()
    problem = problems.of(experiment)
    return Evaluator(problem, problem.policy(experiment.policy), seed)


def _met_alike(run: SavedRun) -> bool:
    """Return whether the run's populations are genuine.

    The first ones must follow from the seed. Later ones must get the fitness that the files state.
    """
    again = Coevolution(run.condition.load(), run.seed)
    again.advance()
    first = _individuals(again)
    for generation, networks in run.populations.items():
        if networks.shape != first.shape:
            return False
        if generation == 0:
            if networks.tobytes() != first.tobytes():
                return False
            continue
        predators, prey = np.split(networks, 2)
        met = everyone(lambda *pairs: again._meet(lambda: False, *pairs)[0], predators, prey)
        told = run.stat[generation - 1]
        if (mean(met[0]), mean(met)) != (told[3], told[4]):
            return False
    last = run.populations[max(run.populations)]
    return run.genotype.tobytes() == np.concatenate([last[0], last[len(last) // 2]]).tobytes()
