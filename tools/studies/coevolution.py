"""The study of co-evolution: five ways to evolve predators and prey, five seeds each.

    python tools/studies coevolution run      evolves for hours; goes on after Ctrl-C
    python tools/studies coevolution state    how far each run is
    python tools/studies coevolution page     measures what is there and writes the report

What is compared is in coevolution_plan.py. Runs lie in results/coevolution, or --folder. A run is
compared with runs only that have done as many steps. `--plan full` is for these runs alone; what
the page says of plans that the folder has no runs of stays.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from coevolution_measure import measured
from coevolution_page import KEPT, load, pages
from coevolution_plan import PLANS, Plan, complete, runs
from coevolution_queue import Queue
from study import ROOT, keep, stamp

from botschool.errors import BotschoolError
from botschool.lock import locked


def run(folder: Path, plans: tuple[Plan, ...], processes: int) -> int:
    """The exit code: 0 if all is done."""
    folder.mkdir(parents=True, exist_ok=True)
    if hasattr(os, "nice"):
        os.nice(19)
    try:
        with locked(folder, "the study"):
            return 0 if Queue(folder, plans).work(processes) else 1
    except BotschoolError as error:
        print(error, file=sys.stderr)
        return 2


def state(folder: Path, plans: tuple[Plan, ...]) -> None:
    """Prints how far the runs are."""
    for plan in plans:
        done = complete(folder, plan)
        print(f"{plan.name}: all have reached {f'{done:g} M' if done else 'no milestone'}")
        for each in runs(folder, plan):
            if each.reached():
                print(f"  {each.name}: {each.reached():.0f} M steps")


def page(folder: Path, plans: tuple[Plan, ...]) -> None:
    """Measures and writes; the data go to tools/studies/data/coevolution.json."""
    begun = tuple(plan for plan in plans if any(each.reached() for each in runs(folder, plan)))
    found = {name: {"measured": stamp()} | of for name, of in measured(folder, begun).items()}
    keep(KEPT, {"plans": load()["plans"] | found})
    for each in pages():
        each.write()


def main() -> int:
    parser = argparse.ArgumentParser(description="The study of co-evolution.")
    parser.add_argument("what", choices=("run", "state", "page"))
    parser.add_argument("--folder", type=Path, default=ROOT / "results" / "coevolution")
    parser.add_argument("--plan", choices=[plan.name for plan in PLANS], help="default: all")
    parser.add_argument("--processes", type=int, default=1, help="runs at a time")
    options = parser.parse_args()
    plans = tuple(plan for plan in PLANS if options.plan in (None, plan.name))
    if options.what == "run":
        return run(options.folder, plans, options.processes)
    (state if options.what == "state" else page)(options.folder, plans)
    return 0
