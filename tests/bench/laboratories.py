"""Do whole laboratories, in full size, and print what running and checking them takes.

    python tests/bench/laboratories.py [3 4 ...] [--workers 2] [--name Ada]

The simulated students of tests/lab_answers do them: prediction, runs, measurements, figure and
conclusion. A row is printed for each: seconds by the clock of the runs and of `--quick`, processor
seconds of the check, and the points. The runs may take 600 s of two cores, a look 60 s, a check
60 s of one core.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1]))

from botschool.labs.check import Check
from botschool.labs.declare import NUMBERS, PARTS, load_lab
from botschool.labs.runs import make_runs
from lab_students import conclude, predicted


def timed(work: Callable, *arguments) -> tuple[Any, float, float]:
    """Return work's result, its seconds by the clock and this process's processor seconds."""
    clock, processor = time.perf_counter(), time.process_time()
    result = work(*arguments)
    return result, time.perf_counter() - clock, time.process_time() - processor


def main() -> None:
    """Do the laboratories one after another."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("numbers", type=int, nargs="*", default=NUMBERS)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--name", default="Ada")
    arguments = parser.parse_args()
    print("laboratory   runs s  quick s  check s  check CPU s  points", flush=True)
    for number in arguments.numbers:
        lab = load_lab(number)
        short = replace(lab, conditions=tuple(c.shortened(lab.quick) for c in lab.conditions))
        with tempfile.TemporaryDirectory() as folder:
            place = predicted(lab, folder, arguments.name)
            sheet, look = place.sheet(), place.folder / "runs-quick"
            _, quick, _ = timed(make_runs, short, sheet, look, arguments.workers, 3)
            _, runs, _ = timed(
                make_runs, lab, sheet, place.runs, arguments.workers, lab.replications
            )
            conclude(place)
            found, checked, own = timed(Check(place).all)
        points = f"{found.points:g} of {sum(PARTS.values()):g}"
        row = f"{number:10} {runs:8.0f} {quick:8.0f} {checked:8.0f} {own:12.0f}  {points}"
        print(row, *(m for part in found.parts for m in part.messages), flush=True)


if __name__ == "__main__":
    main()
