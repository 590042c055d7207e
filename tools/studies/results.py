"""Measures what docs/reports/results.md shows, and the planar runners of bodies.md: `make results`.

Each part leaves a file in data/ (with commit, date and machine); tables and figures of the
pages are made from these files alone. `--only speed` measures one part anew. The machine should
have nothing else to do.
"""

from __future__ import annotations

import argparse
import time
from dataclasses import asdict
from functools import partial

import evolved
import planar_runs
import ppo_compare
import run
import trained
from comparison import notice
from processes import Neighbours
from results_page import PLANAR_SPEED, SPEED, pages
from study import DATA, keep, stamp


def speed(parts: tuple[str, ...], quick: bool) -> dict:
    """Tables of `make bench`, by their part."""
    tables = {part: list(run.measured([part], quick)) for part in parts}
    print(notice())
    return {part: [asdict(table) for table in those] for part, those in tables.items()}


PARTS = {
    "evolved": lambda quick: evolved.evolved(
        evolved.ROWS, 2 if quick else 10, 0.3 if quick else float("inf")
    ),
    "box2d": lambda quick: evolved.evolved(
        evolved.BOX2D, 2 if quick else 4, 0.01 if quick else float("inf")
    ),
    "planar": lambda quick: planar_runs.planar_runs(
        range(1, 3 if quick else 11), 0.3 if quick else float("inf")
    ),
    "speed": partial(speed, SPEED),
    "planarspeed": partial(speed, PLANAR_SPEED),
    "trained": lambda quick: trained.trained(2 if quick else 5, 2000 if quick else None),
    "ppo": lambda quick: ppo_compare.compared(2 if quick else 5),
}
"""What is measured: quick -> data, for a file of the same name."""


def measure(name: str, quick: bool) -> None:
    """One part, and its file."""
    print(f"-- {name}", flush=True)
    neighbours, start = Neighbours(), time.monotonic()
    data = PARTS[name](quick)
    told = {
        "minutes": round((time.monotonic() - start) / 60, 1),
        "note": neighbours.sentence(),
    }
    keep(DATA / f"{name}.json", {"measured": stamp() | told, "data": data})
    print(f"   {told['minutes']} minutes. {told['note']}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description="Measures and writes docs/reports/results.md.")
    parser.add_argument("--only", nargs="+", choices=PARTS, metavar="PART", help=" ".join(PARTS))
    parser.add_argument("--quick", action="store_true", help="to try the command, not to publish")
    options = parser.parse_args()
    for name in PARTS if not options.only else options.only:
        measure(name, options.quick)
    for page in pages():
        page.write()
