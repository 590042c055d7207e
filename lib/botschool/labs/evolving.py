"""Runs that evolve: made, read and looked at again."""

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
    """Make the runs that are not there, or go on; False when the user stopped it."""
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
    """Let the student's own strategy be imported from the laboratory's folder."""
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
    """The run of that seed; None if it is not there, is damaged or has not come to its end."""
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
    """Co-evolution: the generations whose populations are saved."""
    experiment = condition.load()
    if not experiment.competitive:
        return []
    last, each = experiment.algo.ngenerations, experiment.algo.saveeach
    return sorted({*range(0, last + 1, each), last})


def made(condition: Condition, seed: int, student: Any = None) -> SavedRun:
    """The run, made here."""
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
    """The populations of both sides, as their file has them."""
    networks, _ = run.algorithm.individuals(None)
    return np.concatenate(networks)


def genuine(run: SavedRun) -> bool:
    """Whether the saved robots get the fitness that the run's files tell, to the bit."""
    if run.populations:
        return _met_alike(run)
    evaluator = evaluator_of(run.condition, run.seed)
    try:
        genotype, normalisation = evaluator.policy.split(run.genotype)
        return bool(evaluator.post_fitness(genotype, normalisation) == run.stat[-1, 2])
    except BotschoolError:
        return False


def evaluator_of(condition: Condition, seed: int) -> Evaluator:
    """What measures the candidates of a run. It imports no strategy."""
    experiment = condition.load()
    problem = problems.of(experiment)
    return Evaluator(problem, problem.policy(experiment.policy), seed)


def _met_alike(run: SavedRun) -> bool:
    """Whether the first populations follow from the seed, and later ones meet as told."""
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
