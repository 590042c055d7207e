"""Make and read the runs of a sheet, and draw runs to make again."""

from __future__ import annotations

import json
import os
import runpy
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from botschool.errors import BotschoolError
from botschool.labs.declare import Lab
from botschool.labs.saved import SavedRun
from botschool.labs.sheet import MAX_BYTES, Sheet, base_seed, seeds_of
from botschool.output import save_bytes
from botschool.sandbox.inside import read_inside

ABOUT = "runs.json"
"""File in the folder of runs; it holds the prediction from which their seeds follow."""

LEARN = "learn.py"
"""File with the student's own functions, in the laboratory's folder."""


def own_runs(lab: Lab, sheet: Sheet, folder: Path) -> dict[str, list[SavedRun]]:
    """Return the finished runs whose seeds follow from the sheet: condition -> runs."""
    seeds = seeds_of(sheet, lab)
    return {
        c.name: [run for seed in seeds[c.name] if (run := c.maker.read(c, seed, folder / c.name))]
        for c in lab.conditions
    }


def make_runs(lab: Lab, sheet: Sheet, folder: Path, workers: int, replications: int) -> bool:
    """Make all missing runs; return False if the user stopped."""
    seeds = seeds_of(sheet, lab, replications)
    _claim(lab, sheet, folder)
    total = replications * len(lab.conditions)
    done = {
        name: sum(run.seed in seeds[name] for run in runs)
        for name, runs in own_runs(lab, sheet, folder).items()
    }
    ready = sum(done.values())
    print(f"{total} runs, seeds from your name and your prediction; {ready} are there.")
    student = own_functions(folder.parent / LEARN)
    began, made = time.monotonic(), 0
    for number, condition in enumerate(lab.conditions, 1):
        wanted, place = seeds[condition.name], folder / condition.name
        if done[condition.name] == len(wanted):
            continue
        if not condition.maker.make_all(condition, wanted, place, workers, student):
            print("Stopped; what is done is saved. The same command goes on.")
            return False
        made += len(wanted) - done[condition.name]
        left = (time.monotonic() - began) / made * (total - ready - made)
        bar = "=" * round(20 * (ready + made) / total)
        print(
            f"[{bar:<20}] {ready + made} of {total}  {condition.name} "
            f"({number} of {len(lab.conditions)} conditions)  {_time(left)} left",
            flush=True,
        )
    return True


def _claim(lab: Lab, sheet: Sheet, folder: Path) -> None:
    """Store the prediction beside the runs.

    Raises BotschoolError if the folder holds runs of another prediction.
    """
    about = folder / ABOUT
    if told := changed(lab, sheet, folder):
        raise BotschoolError(f"{told} To start anew, move {folder} away and run again.")
    folder.mkdir(parents=True, exist_ok=True)
    text = json.dumps({"seed": base_seed(sheet, lab), "prediction": sheet.prediction}, indent=1)
    save_bytes(about, f"{text}\n".encode())


def changed(lab: Lab, sheet: Sheet, folder: Path) -> str:
    """Return a sentence if the runs belong to another prediction, name or course; else ""."""
    try:
        about = json.loads(read_inside(folder, ABOUT, 10 * MAX_BYTES))
        seed, prediction = int(about["seed"]), str(about["prediction"])
    except Exception:  # a damaged file can fail in any way
        return ""
    if seed == base_seed(sheet, lab):
        return ""
    if prediction == sheet.prediction:
        return "The runs belong to another name or course: put back what sheet.md had there."
    before = prediction.split()
    pairs = zip(before, sheet.prediction.split(), strict=False)
    equal = next((i for i, (old, new) in enumerate(pairs) if old != new), 0)
    said = " ".join(before[max(0, equal - 5) : equal + 15])
    return f"The prediction has changed since the runs were made. They belong to '... {said} ...'."


def _time(seconds: float) -> str:
    return f"{seconds // 60:.0f} min {seconds % 60:.0f} s" if seconds >= 60 else f"{seconds:.0f} s"


def drawn(
    runs: dict[str, list[SavedRun]], count: int, draw: Callable[[int], bytes] = os.urandom
) -> list[SavedRun]:
    """Return runs to make again, drawn at random so that nobody can foresee them."""
    pool = [run for each in runs.values() for run in each]
    rng = np.random.default_rng(int.from_bytes(draw(16), "big"))
    return [pool[i] for i in rng.permutation(len(pool))[:count]]


def own_functions(path: Path) -> Callable[..., Any] | None:
    """Return a function that calls the student's functions by name, in this process.

    Return None if the student has no such file.
    """
    if not path.is_file():
        return None
    space = runpy.run_path(str(path))

    def call(name: str, *arguments: Any) -> Any:
        if name not in space:
            raise BotschoolError(f"{path} has no function {name}.")
        try:
            return space[name](*arguments)
        except NotImplementedError:
            raise BotschoolError(f"Write {name} in {path} first.") from None

    return call
