"""The runs of a sheet: made, read, and proven by doing them again."""

from __future__ import annotations

import io
import json
import os
import sys
import time
from collections.abc import Callable
from contextlib import nullcontext, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from botschool.config import to_dict
from botschool.errors import BotschoolError
from botschool.evolution.limit import Limit
from botschool.evolution.record import STAT, RunFiles
from botschool.evolution.replicate import replicate
from botschool.evolution.run import Options, Run
from botschool.labs.declare import Condition, Lab
from botschool.labs.sheet import Sheet, base_seed, seeds_of
from botschool.output import save_bytes

ABOUT = "runs.json"
"""In the folder of runs: the prediction that their seeds follow from."""


@dataclass(frozen=True)
class SavedRun:
    """A run as its files tell it."""

    condition: Condition
    seed: int
    stat: np.ndarray
    """(generations, 6), as STAT names the columns."""
    genotype: np.ndarray

    def plain(self) -> dict[str, Any]:
        """What measure.py is given."""
        return {
            "condition": self.condition.name,
            "seed": self.seed,
            "stat": self.stat,
            "genotype": self.genotype,
            "experiment": to_dict(self.condition.load()),
        }


def read_run(condition: Condition, folder: Path, seed: int) -> SavedRun | None:
    """The run of that seed; None if it is not there, is damaged or has not come to its end."""
    files = RunFiles(folder / condition.name, seed)
    try:
        if max(files.stat.stat().st_size, files.bestg.stat().st_size) > 50_000_000:
            return None
        stat = np.load(files.stat, allow_pickle=False).reshape(-1, len(STAT))
        genotype = np.load(files.bestg, allow_pickle=False)
    except (OSError, ValueError, EOFError):
        return None
    if stat.dtype != np.float64 or genotype.dtype != np.float64 or genotype.ndim != 1:
        return None
    if not (len(stat) and np.isfinite(stat).all() and np.isfinite(genotype).all()):
        return None
    steps = round(condition.experiment["algo"]["maxmsteps"] * 1e6)
    ended = stat[-1, 0] >= steps or len(stat) >= (condition.generations or np.inf)
    return SavedRun(condition, seed, stat, genotype) if ended else None


def own_runs(lab: Lab, sheet: Sheet, folder: Path) -> dict[str, list[SavedRun]]:
    """The finished runs whose seeds follow from the sheet: condition -> runs."""
    seeds = seeds_of(sheet, lab)
    return {
        c.name: [run for seed in seeds[c.name] if (run := read_run(c, folder, seed))]
        for c in lab.conditions
    }


def make_runs(lab: Lab, sheet: Sheet, folder: Path, workers: int, replications: int) -> bool:
    """Make all runs that are not there; return False when the user stopped it."""
    seeds = seeds_of(sheet, lab, replications)
    _claim(lab, sheet, folder)
    total = replications * len(lab.conditions)
    done = {c.name: [s for s in seeds[c.name] if read_run(c, folder, s)] for c in lab.conditions}
    ready = sum(map(len, done.values()))
    print(f"{total} {lab.robot}, seeds from your name and your prediction; {ready} are there.")
    began, made = time.monotonic(), 0
    for number, condition in enumerate(lab.conditions, 1):
        todo = len(seeds[condition.name]) - len(done[condition.name])
        if not todo:
            continue
        options = Options(
            workers=workers,
            generations=condition.generations,
            resume=True,
            terminal=sys.stdout.isatty(),
        )
        quiet = nullcontext() if options.terminal else redirect_stdout(io.StringIO())
        with quiet:
            place = folder / condition.name
            finished = replicate(condition.load(), seeds[condition.name], place, options)
        if not finished:
            print("Stopped; what is done is saved. The same command goes on.")
            return False
        made += todo
        left = (time.monotonic() - began) / made * (total - ready - made)
        bar = "=" * round(20 * (ready + made) / total)
        print(
            f"[{bar:<20}] {ready + made} of {total}  {condition.name} "
            f"({number} of {len(lab.conditions)} conditions)  {_time(left)} left",
            flush=True,
        )
    return True


def _claim(lab: Lab, sheet: Sheet, folder: Path) -> None:
    """Note the prediction beside the runs. Raises BotschoolError when there are runs of another."""
    about = folder / ABOUT
    if told := changed(lab, sheet, folder):
        raise BotschoolError(f"{told} To start anew, move {folder} away and run again.")
    folder.mkdir(parents=True, exist_ok=True)
    text = json.dumps({"seed": base_seed(sheet, lab), "prediction": sheet.prediction}, indent=1)
    save_bytes(about, f"{text}\n".encode())


def changed(lab: Lab, sheet: Sheet, folder: Path) -> str:
    """A sentence when the runs belong to another prediction, name or course; else ""."""
    try:
        about = json.loads((folder / ABOUT).read_text(encoding="utf-8"))
        seed, prediction = int(about["seed"]), str(about["prediction"])
    except (OSError, ValueError, KeyError, TypeError):
        return ""
    if seed == base_seed(sheet, lab):
        return ""
    if prediction == sheet.prediction:
        return "The runs belong to another name or course: put back what sheet.md had there."
    return (
        f"The prediction has changed since the runs were made: they belong to '{prediction[:300]}'."
    )


def _time(seconds: float) -> str:
    return f"{seconds // 60:.0f} min {seconds % 60:.0f} s" if seconds >= 60 else f"{seconds:.0f} s"


def genuine(run: SavedRun) -> bool:
    """Whether the saved robot gets the fitness that the run's files tell, to the bit."""
    made = Run(run.condition.load(), run.seed)
    try:
        genotype, normalisation = made.policy.split(run.genotype)
        return bool(made.evaluator.post_fitness(genotype, normalisation) == run.stat[-1, 2])
    except BotschoolError:
        return False


def evolved(condition: Condition, seed: int) -> SavedRun:
    """The run, made here."""
    run = Run(condition.load(), seed)
    run.limit = Limit(steps=run.max_steps, generations=condition.generations or np.inf)
    while not run.limit.reached(run):
        run.advance(goes_on=True)
    run.settle()
    stat = run.record.rows()[:, : len(STAT)]
    return SavedRun(condition, seed, stat, np.array(run.record.bestg))


def same(one: SavedRun, other: SavedRun) -> bool:
    """Whether two runs are equal, bit by bit."""
    return (
        one.stat.tobytes() == other.stat.tobytes()
        and one.genotype.tobytes() == other.genotype.tobytes()
    )


def drawn(
    runs: dict[str, list[SavedRun]], count: int, draw: Callable[[int], bytes] = os.urandom
) -> list[SavedRun]:
    """Runs to make again, so that nobody knows before which they are."""
    pool = [run for each in runs.values() for run in each]
    rng = np.random.default_rng(int.from_bytes(draw(16), "big"))
    return [pool[i] for i in rng.permutation(len(pool))[:count]]
