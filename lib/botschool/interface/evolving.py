"""`botschool.evolve`: the runs of `botschool es`, from a program."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from botschool.config import Experiment, OwnConfig
from botschool.errors import BotschoolError
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.progress import messages
from botschool.evolution.record import claimed
from botschool.evolution.run import Options
from botschool.evolution.run import Run as Evolving
from botschool.interface.runs import Run, Runs
from botschool.interface.showing import Folder, bars, interruptible
from botschool.interface.sources import Source, experiment_of, in_python_words, usable, whole


def evolve(
    experiment: Source,
    *,
    seed: int = 1,
    seeds: Iterable[int] | None = None,
    workers: int = 1,
    folder: str | PathLike[str] | None = None,
    steps: int | None = None,
    generations: int | None = None,
    resume: bool = False,
    force: bool = False,
    algorithm: Callable[..., Any] | None = None,
    progress: bool | None = None,
    **hyperparameters: Any,
) -> Run | Runs:
    """Evolve robots and return the run; with `seeds` (an iterable) return the runs of all of them.

    experiment: an experiment file, the name of a problem, or a dict. Further arguments replace its
    hyperparameters: algo="SSS", nhiddens=10, maxmsteps=0.5. workers: cores to use. folder: where
    the files of `botschool es` go, bit for bit the same; without one they go when the run goes.
    steps, generations: stop early. resume: continue the runs in the folder; force: replace them.
    algorithm: your own strategy, a class with ask() -> (n, parameters) and tell(fitness), or a
    function; see docs/python.md. progress: show bars; by default in terminals and notebooks.

    Ctrl-C saves the runs in the folder and raises KeyboardInterrupt; the same call with resume=True
    goes on. Raises BotschoolError.
    """
    with in_python_words():
        chosen = _seeds([seed] if seeds is None else seeds)
        if resume and (force or folder is None):
            raise BotschoolError(
                "resume=True continues the runs of a folder: name the folder, and leave out force."
            )
        made = experiment_of(experiment, hyperparameters, algorithm)
        steps = steps if steps is None else whole("steps", steps)
        generations = generations if generations is None else whole("generations", generations)
        if steps is not None and steps > 1e6 * getattr(made.algo, "maxmsteps", np.inf):
            raise BotschoolError(
                f"steps = {steps:,} is beyond the end of the run, maxmsteps = "
                f"{made.algo.maxmsteps:g} million: set maxmsteps instead."
            )
        place = Folder(folder)
        options = Options(workers, steps, generations, resume=resume, force=force)
        if not _run_all(made, chosen, place.path, options, progress):
            saved = f"is saved in {folder}: resume=True goes on" if folder else "is dropped"
            raise KeyboardInterrupt(f"The evolution was stopped and {saved}.")
        runs = [Run(made, each, place.path, place.owner) for each in chosen]
    return runs[0] if seeds is None else Runs(runs)


def _run_all(
    experiment: Experiment,
    seeds: list[int],
    folder: Path,
    options: Options,
    progress: bool | None,
) -> bool:
    """Evolve all seeds; return False if the user stopped them.

    Runs of a native problem go on side by side, in threads that share the workers.
    """
    kind = Coevolution if experiment.competitive else Evolving
    failed: list[BaseException] = []
    with interruptible() as asked:

        def stopping() -> bool:
            return asked() or bool(failed)

        first = kind(experiment, seeds[0], 1, stopping)
        native = first.problem.native
        workers, side = usable(options.workers, native), 1
        if native and not isinstance(experiment.algo, OwnConfig):  # others may share global state
            side = min(workers, len(seeds))
        waiting = {seeds[0]: first}

        def one(seed: int) -> bool:
            try:
                run = waiting.pop(seed, None) or kind(experiment, seed, 1, stopping)
                run.workers = workers // side
                show = partial(shown.show, seed) if shown else lambda *state: None
                with messages(True, lambda state: show(*state)) as report:
                    return options.evolve(run, folder, report)
            except BaseException as error:
                failed.append(error)
                raise

        with claimed(folder, seeds, options.resume, options.force), bars(progress) as shown:
            if side == 1:
                return all(not stopping() and one(seed) for seed in seeds)
            with ThreadPoolExecutor(side) as pool:
                pending = [pool.submit(lambda s: not stopping() and one(s), s) for s in seeds]
            if failed:
                raise failed[0]
            return all(each.result() for each in pending)


def _seeds(seeds: Iterable[int]) -> list[int]:
    """Return the seeds as a list. Raises BotschoolError."""
    if not isinstance(seeds, Iterable):
        raise BotschoolError(f"seeds is {seeds!r:.40}: write seeds=range(10) for ten, or seed=3.")
    chosen = [whole("seed", seed, 0) for seed in seeds]
    if not chosen or len(set(chosen)) < len(chosen):
        raise BotschoolError("seeds must be different numbers, at least one, as in range(10).")
    return chosen
