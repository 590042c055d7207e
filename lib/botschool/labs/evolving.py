"""Make runs that evolve, read them, and prove them by evaluating their robots again.

The arithmetic of a student's own strategy may differ in the last bits between machines, so a
repeated run of it need not be equal. Instead, the strategy runs in the sandbox, without being
imported here, and is told the fitness values of the checkpoint. Its candidates must then get this
fitness, in generations drawn at random.
"""

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
from botschool.evolution.algorithms.own import POPSIZE
from botschool.evolution.algorithms.sides import everyone, mean
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.evaluate import Evaluator
from botschool.evolution.limit import Limit
from botschool.evolution.record import STAT, RunFiles
from botschool.evolution.replicate import replicate
from botschool.evolution.run import Options, Run
from botschool.grading.declare.checks import Wrong
from botschool.grading.run.confined import MachineFault
from botschool.grading.run.student import Student
from botschool.labs.declare import STRATEGY, Condition
from botschool.labs.saved import MAX_BYTES, SavedRun, member, numbers, stat_of
from botschool.wrappers import keywords

GENERATIONS = 5
"""Generations of a run to evaluate again, besides the one of its best robot."""
EQUAL = 0.9
"""Share of the candidates that must get exactly the same fitness."""
LONGER = 2
"""Largest ratio of a generation's steps to the steps in its stat file, either way."""


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
        run.advance()
        if run.record.generation in wanted:
            populations[run.record.generation] = _individuals(run)
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


def told_fitness(run: SavedRun, folder: Path) -> np.ndarray | None:
    """Return all fitness values that the checkpoint holds; None if it is missing or damaged."""
    return numbers(
        RunFiles(folder / run.condition.name, run.seed).checkpoint,
        1,
        lambda content: member(content, "algorithm.told", MAX_BYTES),
    )


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
