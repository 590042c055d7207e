"""Advance an evolutionary run and keep it on disk."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from botschool import problems
from botschool.cluster import Open
from botschool.config import Experiment
from botschool.errors import BotschoolError
from botschool.evolution import checkpoint, fresh
from botschool.evolution.algorithm import ALGORITHMS
from botschool.evolution.evaluate import Evaluator, mean
from botschool.evolution.events import Events
from botschool.evolution.limit import Limit
from botschool.evolution.record import Record, RunFiles
from botschool.output import cannot_write, save_npy
from botschool.problems import Interrupted, Problem
from botschool.problems.base import say, say_unrepeatable
from botschool.terminal import readable

EVENT_SECONDS = 10


class Run:
    """An experiment with a seed: created, then advanced generation by generation.

    All its results are a pure function of (experiment, seed): neither the number of workers nor
    interruptions change its files.
    """

    checkpointed: tuple[str, ...] = ("algorithm", "evaluator", "record")
    """Attributes that a checkpoint holds."""
    growing: tuple[str, ...] = ("record.", "algorithm.told")
    """Beginnings of the names of checkpoint arrays that get longer during the run."""
    saving = 0.0
    """Seconds that the last save took."""
    progress = 0.0
    """Share of the present generation that is done."""
    algorithm: Any
    record: Any
    fresh: np.ndarray | None = None
    """Returns of the best robot in fresh episodes, once the run is at its end."""
    budget: Limit
    """The end of the run by its experiment."""
    limit: Limit
    """The end of this call: the budget, or an earlier end that the user chose."""
    report: Callable[[Run], None]
    """The run calls this during a generation when there is progress to show."""

    def __init__(
        self,
        experiment: Experiment,
        seed: int,
        workers: int = 1,
        stopping: Callable[[], bool] = lambda: False,
        problem: Problem | None = None,
    ) -> None:
        """Create the run; problem: the experiment's, if other machines evaluate."""
        self.experiment = experiment
        self.seed = seed
        self.workers = workers
        self.stopping = stopping
        self.problem = problem or problems.of(experiment)
        self.check()
        self.policy = self.problem.policy(experiment.policy)
        if self.policy.unreached:
            say(self.policy.unreached)
        self.report: Callable[[Run], None] = lambda run: None
        self.begin()

    def initial(self) -> np.ndarray:
        """Return the random genotype that evolution starts from, as it would be saved."""
        return self.policy.join(self.policy.initial(self.seed), self.evaluator.normalisation)

    def check(self) -> None:
        """Raise BotschoolError for a problem or a policy that the algorithm cannot evolve."""

    def begin(self) -> None:
        """Make the algorithm, its evaluator, the record and the budget."""
        entry, config = ALGORITHMS[self.experiment.exp.algo], self.experiment.algo
        entry.check(config, self.policy)
        self.algorithm = entry.make(config, partial(self.policy.initial, self.seed), self.seed)
        self.evaluator = Evaluator(
            self.problem, self.policy, self.seed, self.workers, self.stopping, entry.behaves
        )
        self.record = Record()
        self.budget = self.limit = Limit(steps=self.max_steps)

    @property
    def max_steps(self) -> int:
        """Return the budget in steps."""
        return max(1, round(self.experiment.algo.maxmsteps * 1e6))

    def due(self, seconds: float) -> bool:
        """Return whether to save, this many seconds after the last save."""
        return seconds >= 60 * self.experiment.algo.saveeach

    def write(self, files: RunFiles, ended: bool) -> None:
        """Write the run files; ended: the run ends here, at least for now."""
        self.record.write(files)

    def numbers(self) -> str:
        """Return its results in short."""
        last = self.record.last
        return (
            f"best {readable(last['best fitness'])}  "
            f"post-evaluated {readable(last['best post-evaluated'])}  "
            f"mean {readable(last['average'])}"
        )

    def line(self) -> str:
        """Return a line about the last generation."""
        record, last = self.record, self.record.last
        return (
            f"seed {self.seed}  generation {record.generation}  steps {record.steps} "
            f"({100 * self.limit.share(self):.1f}%)  {self.numbers()}  "
            f"of this generation {readable(last['best of generation'])}  "
            f"parameter {last['average parameter']:.3f}"
        )

    def result(self, files: RunFiles) -> str:
        """Return a sentence about the whole run."""
        record, found = self.record, self.fresh
        sentence = (
            f"seed {self.seed}: best {readable(record.best_fitness)}, best post-evaluated "
            f"{readable(record.bestg_fitness)} after {record.steps} steps; best robot: "
            f"{files.bestg}"
        )
        if found is None:
            return sentence
        return f"{sentence}, {fresh.told(found)} in {len(found)} fresh episodes (95 % interval)"

    def ending(self, files: RunFiles, finished: bool) -> str:
        """Return the last message of a run; "" if there is none."""
        if not finished:
            return (
                f"seed {self.seed}: stopped after {self.record.generation} generations; all "
                "is saved, add --resume to the same command to continue."
            )
        return self.result(files) if self.record.generation else ""

    def advance(self) -> None:
        """Run one generation. Raises Interrupted on request; a generation that fails is dropped."""
        candidates, seeds = self.algorithm.ask()
        measured = self.evaluator.measure(candidates, seeds)
        best = int(measured.fitness.argmax())
        saved = self.policy.join(np.asarray(candidates[best]), self.evaluator.normalisation)
        post = self.evaluator.post_evaluate(candidates[best])
        self.algorithm.tell(*measured.told())
        self.evaluator.refresh()
        fitness = float(measured.fitness[best])
        self.record.steps += measured.steps + post.steps
        self.record.offer(saved, fitness, mean(post.fitness))
        self.record.add(fitness, mean(measured.fitness), self.algorithm.average_parameter())
        self.report(self)

    def state(self) -> dict:
        """Return everything that a checkpoint holds, as arrays."""
        return {
            f"{owner}.{name}": value
            for owner in self.checkpointed
            for name, value in getattr(self, owner).state().items()
        }

    def restore(self, state: dict) -> None:
        """Restore a state. Raises KeyError or ValueError for the state of another run."""
        for name, value in self.state().items():
            given = state[name]
            free = 1 if name.startswith(self.growing) else 0  # the first dimension
            if (given.dtype, given.ndim) != (value.dtype, value.ndim) or (
                given.shape[free:] != value.shape[free:]
            ):
                raise ValueError(f"{name} has another type or shape")
            counts = given.dtype.kind in "iu" and (given < 0).any()
            lost = not free and np.isfinite(value).all() and not np.isfinite(given).all()
            if counts or lost:
                raise ValueError(f"{name} holds values that no run saves")
        for owner in self.checkpointed:
            prefix = owner + "."
            values = {k.removeprefix(prefix): v for k, v in state.items() if k.startswith(prefix)}
            getattr(self, owner).restore(values)

    def measure(self, files: RunFiles) -> None:
        """Measure the best robot in fresh episodes, and save their returns. Raises Interrupted."""
        if self.record.generation:
            genotype, vectors = self.policy.split(self.record.bestg)
            self.fresh = self.evaluator.fresh_returns(genotype, vectors, fresh.EPISODES)
            fresh.save(files.fresh, self.fresh)

    def reproduces(self) -> bool:
        """Return whether the best robot on record still gets its fitness, to the bit.

        If not, this version evaluates robots differently from the one that wrote the record, or the
        environment does not repeat.
        """
        record = self.record
        if not record.generation:
            return True
        try:
            genotype, normalisation = self.policy.split(record.bestg)
        except BotschoolError:  # it belongs to another network
            return False
        return self.evaluator.post_fitness(genotype, normalisation) == record.bestg_fitness


def evolve(
    run: Run,
    folder: Path | str,
    steps: int | None = None,
    resume: bool = False,
    report: Callable[[Run], None] = lambda run: None,
    generations: int | None = None,
    keep_every: int | None = None,
) -> bool:
    """Run until the budget, or `steps` or `generations`, is spent; save when due and at the end.

    Returns True at that point, and False if the user stopped the run (everything is saved then). On
    an error, the generations that were finished are saved first. `report` is called after each
    generation, and may be called during one. With `keep_every` the best genotype so far is kept in
    a file of its own every `keep_every` generations, beginning with the initial genotype.
    """
    files = RunFiles(Path(folder), run.seed)
    try:
        files.folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(files.folder, error.strerror or str(error)) from error
    if keep_every:
        report = keeping(files, keep_every, report)
    resumed = resume and files.checkpoint.exists()
    if run.problem.robot is not None:
        run.problem.robot.keep(files.robot, resumed)
    if resumed:
        checkpoint.resume(files.checkpoint, run)
    limit = run.budget.and_also(steps, generations)
    events = Events(files.events, limit.steps if limit.steps < math.inf else 0)
    logged = 0
    run.report, run.limit = report, limit
    report(run)

    def log() -> None:
        nonlocal logged
        if events.lost():
            logged = 0
        events.append(logged, run.record.rows(logged), run.record.columns)
        logged = run.record.generation

    def save(ended: bool = False) -> None:
        began = time.monotonic()
        checkpoint.save(files.checkpoint, run.experiment, run.seed, run.state())
        run.write(files, ended)
        log()
        run.saving = time.monotonic() - began

    save()
    with suppress(OSError):
        files.fresh.unlink()  # of the robot that was the best before
    saved = recorded = time.monotonic()
    try:
        if resumed:
            _say_if_unrepeatable(run)
        while not limit.reached(run):
            if run.stopping():
                raise Interrupted
            run.advance()
            now = time.monotonic()
            if run.due(now - saved):
                save()
                saved = recorded = time.monotonic()
            elif now - recorded >= EVENT_SECONDS:
                log()
                recorded = time.monotonic()
        save(ended=True)
        run.measure(files)
        _say_if_unrepeatable(run)
    except Interrupted:
        save(ended=True)
        return False
    except Exception as error:
        try:
            save(ended=True)
        except BotschoolError as unsaved:
            raise checkpoint.rescued(run, unsaved) from error
        raise
    finally:
        run.problem.close()
    return True


@dataclass(frozen=True)
class Options:
    """The way to run an experiment, such as the number of workers."""

    workers: int = 1
    steps: int | None = None
    """Stop after this many steps, as after `generations`; None: when the budget is spent."""
    generations: int | None = None
    keep_every: int | None = None
    """Keep the best genotype so far every this many generations."""
    resume: bool = False
    """Continue existing runs; `force` replaces them."""
    force: bool = False
    terminal: bool = False
    """Show progress bars instead of lines."""
    cluster: Open | None = None
    """A cluster that replaces `workers`."""

    def evolve(self, run: Run, folder: Path, report: Callable[[Run], None]) -> bool:
        """Evolve a run with these options; return whether it reached its end."""
        return evolve(
            run, folder, self.steps, self.resume, report, self.generations, self.keep_every
        )


def keeping(files: RunFiles, every: int, report: Callable[[Run], None]) -> Callable[[Run], None]:
    """Return a `report` that also saves the best post-evaluated genotype every `every` generations.

    It is saved before any checkpoint contains its generation, so a resumed run lacks none.
    Generation 0 has the random genotype that evolution starts from.
    """

    def kept(run: Run) -> None:
        generation = run.record.generation
        if generation % every == 0:
            best = run.record.bestg if generation else run.initial()
            save_npy(files.kept(generation), best)
        report(run)

    return kept


def _say_if_unrepeatable(run: Run) -> None:
    """Say so if the best robot does not get its fitness again: the first episodes may have hidden
    it, and a resumed run is another process.
    """
    if not run.problem.native:
        with suppress(BotschoolError):
            if not run.reproduces():
                say_unrepeatable(run.problem.name)
