"""The loop of an evolutionary run, and its life on disk."""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path

from botschool import problems
from botschool.config import Experiment
from botschool.errors import BotschoolError
from botschool.evolution import checkpoint
from botschool.evolution.evaluate import Evaluator, mean
from botschool.evolution.events import Events
from botschool.evolution.openaies import OpenAIES
from botschool.evolution.record import Record, RunFiles
from botschool.evolution.sss import SSS
from botschool.output import cannot_write, remove_leftovers
from botschool.policy import Policy
from botschool.problems import Interrupted

ALGORITHMS = {"OpenAI-ES": OpenAIES, "SSS": SSS}
EVENT_SECONDS = 10


class Run:
    """An experiment with a seed: made, then advanced generation by generation.

    Everything it computes is a pure function of (experiment, seed): neither the number of workers
    nor interruptions show in its files.
    """

    def __init__(
        self,
        experiment: Experiment,
        seed: int,
        workers: int = 1,
        stopping: Callable[[], bool] = lambda: False,
    ) -> None:
        if experiment.exp.algo not in ALGORITHMS:
            raise BotschoolError(
                f"The algorithm {experiment.exp.algo} is not in this version of botschool yet: "
                f"use {' or '.join(ALGORITHMS)}."
            )
        self.experiment = experiment
        self.seed = seed
        self.stopping = stopping
        self.problem = problems.make(experiment.exp.environment)
        self.policy = Policy(self.problem.name, self.problem.interface, experiment.policy)
        self.algorithm = ALGORITHMS[experiment.exp.algo](
            experiment.algo, partial(self.policy.initial, seed), seed
        )
        self.evaluator = Evaluator(self.problem, self.policy, seed, workers, stopping)
        self.record = Record()

    @property
    def max_steps(self) -> int:
        """The budget, in steps."""
        return max(1, round(self.experiment.algo.maxmsteps * 1e6))

    def advance(self) -> None:
        """One generation. Raises Interrupted on request; a generation that fails is dropped."""
        candidates, seeds = self.algorithm.ask()
        measured = self.evaluator.measure(candidates, seeds)

        best = int(measured.fitness.argmax())
        post = self.evaluator.post_evaluate(candidates[best])
        saved = self.policy.join(candidates[best], self.evaluator.normalisation)
        post_fitness = mean(post.fitness)

        self.algorithm.tell(measured.fitness)
        self.evaluator.refresh()
        self.record.steps += measured.steps + post.steps
        self.record.offer(saved, float(measured.fitness[best]), post_fitness)
        self.record.add(
            float(measured.fitness[best]),
            mean(measured.fitness),
            self.algorithm.average_parameter(),
        )

    def state(self) -> dict:
        """All that a checkpoint holds, as arrays."""
        return {
            f"{part}.{name}": value
            for part in ("algorithm", "evaluator", "record")
            for name, value in getattr(self, part).state().items()
        }

    def restore(self, state: dict) -> None:
        """The reverse of state(). Raises KeyError or ValueError for that of another run."""
        for name, value in self.state().items():
            given = state[name]
            free = 1 if name.startswith("record.") else 0  # dimensions that grow with the run
            if (given.dtype, given.ndim) != (value.dtype, value.ndim) or (
                given.shape[free:] != value.shape[free:]
            ):
                raise ValueError(f"{name} has another type or shape")
        for part in ("algorithm", "evaluator", "record"):
            prefix = part + "."
            values = {k.removeprefix(prefix): v for k, v in state.items() if k.startswith(prefix)}
            getattr(self, part).restore(values)


def evolve(
    run: Run,
    folder: Path,
    steps: int | None = None,
    resume: bool = False,
    report: Callable[[Run], None] = lambda run: None,
) -> bool:
    """Runs until the budget, or `steps`, is spent, saving every `saveeach` minutes and at the end.

    Returns whether it got there; False when it was asked to stop (all is saved then). Errors that
    break a run off save what was finished first.
    """
    files = RunFiles(folder, run.seed)
    if resume and files.checkpoint.exists():
        path = files.checkpoint
        try:
            run.restore(checkpoint.load(path, run.experiment, run.seed))
        except (KeyError, ValueError, IndexError, TypeError):
            raise BotschoolError(
                f"{path} does not fit this run (the environment has changed, or parts are "
                "missing): restore it from a copy, or use --force to start anew."
            ) from None
    budget = run.max_steps if steps is None else min(steps, run.max_steps)
    events = Events(files.events, budget)
    logged = 0
    report(run)

    def log() -> None:
        nonlocal logged
        events.append(logged, run.record.rows(logged))
        logged = run.record.generation

    def save() -> None:
        checkpoint.save(files.checkpoint, run.experiment, run.seed, run.state())
        run.record.write(files)
        log()

    save()
    saved = recorded = time.monotonic()
    try:
        while run.record.steps < budget:
            if run.stopping():
                raise Interrupted
            run.advance()
            report(run)
            now = time.monotonic()
            if now - saved >= 60 * run.experiment.algo.saveeach:
                save()
                saved = recorded = time.monotonic()
            elif now - recorded >= EVENT_SECONDS:
                log()
                recorded = time.monotonic()
        save()
    except Interrupted:
        save()
        return False
    except Exception:
        with suppress(BotschoolError):
            save()
        raise
    finally:
        run.problem.close()
    return True


def claim(folder: Path, seeds: list[int], resume: bool, force: bool) -> None:
    """Makes the folder ready for runs with these seeds.

    Results that exist are kept when resuming, removed with `force`, and an error otherwise.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        _claim(folder, seeds, resume, force)
    except OSError as error:
        raise cannot_write(folder, error.strerror or str(error)) from error


def _claim(folder: Path, seeds: list[int], resume: bool, force: bool) -> None:
    for seed in seeds:
        files = RunFiles(folder, seed)
        existing = files.existing()
        if not existing or (resume and files.checkpoint.exists()):
            continue
        if resume:
            raise BotschoolError(
                f"{existing[0]} exists but {files.checkpoint} does not, so the run cannot be "
                "resumed: use another seed (-s) or folder (-o), or --force to start anew."
            )
        if not force:
            raise BotschoolError(
                f"{existing[0]} exists: use --resume to continue that run, another seed (-s) or "
                "folder (-o) to keep it, or --force to overwrite it."
            )
    for path in [path for seed in seeds for path in RunFiles(folder, seed).all()]:
        remove_leftovers(path)
        if force and path.exists():
            shutil.rmtree(path) if path.is_dir() else path.unlink()
