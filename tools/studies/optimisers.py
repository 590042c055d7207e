"""Compare optimisers of other libraries on one problem: the examples of docs/python.md.

    python tools/studies optimisers [STEPS]    runs them with three seeds each (1e6 steps a run)

The code is that of the page, with more generations. Ours run on the same problem beside them.
"""

from __future__ import annotations

import json
import os
import re
import sys
import time
from contextlib import suppress
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from report import machine
from study import COLOURS, GREY, ROOT, Page, band, legend_above, panel, spread, table

import botschool

DATA = Path(__file__).parent / "data" / "optimisers.json"
PAGE = ROOT / "docs" / "python.md"
LIBRARIES = ("cma", "evosax", "nevergrad", "scipy")
OURS = {"sNES": {"popsize": 40}, "OpenAI-ES": {"samplesize": 20, "noiseStdDev": 0.1}}
SEEDS = (1, 2, 3)
STEPS = 1e6
POINTS = 60
FRESH, EPISODES = 200_000, 50


class Enough(Exception):
    """Raised when the steps of a run are spent."""


class Watched:
    """A problem that records what it is asked, until its steps are spent."""

    def __init__(self, problem, seed: int, steps: float) -> None:
        self._problem, self._seed, self._left = problem, seed, steps
        self.parameters = problem.parameters
        self.seconds, self.curve, self.best = 0.0, [(0, -np.inf)], None
        self.first = None
        """CPU seconds when the first evaluation began, after imports and compilations."""

    def initial(self) -> np.ndarray:
        """Another start for each seed."""
        return self._problem.initial(self._seed)

    def evaluate(self, genotypes, seeds):
        """As the problem's; keeps the candidate with the largest return."""
        if self._left <= 0:
            raise Enough
        began = time.process_time()
        self.first = self.first or began
        returns, steps = self._problem.evaluate(genotypes, seeds)
        self.seconds += time.process_time() - began
        self._left -= steps.sum()
        done, top = self.curve[-1]
        if returns.max() > top:
            top, self.best = returns.max(), np.array(np.atleast_2d(genotypes)[returns.argmax()])
        self.curve.append((done + int(steps.sum()), float(top)))
        return returns, steps


def examples() -> dict[str, str]:
    """Return the page's code, by the word in its first line."""
    blocks = re.findall(r"```python\n# (\w+) .*?\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    return dict(blocks)


def problem_of_page():
    """Return the page's problem."""
    line = re.search(
        r"^problem = (botschool\.problem\(.*\))$", PAGE.read_text("utf-8"), re.MULTILINE
    )
    return eval(line[1], {"botschool": botschool})


def library(name: str, code: str, seed: int, steps: float) -> dict:
    """Return what one run of the page's code found; other seeds replace its seed 1."""
    problem = problem_of_page()
    watched = Watched(problem, seed, steps)
    code = re.sub(r"(seed\"?[(=:] ?|key\(|default_rng\(|rng=)1\b", rf"\g<1>{seed}", code)
    code = re.sub(r"generations = \d+", "generations = 10**9 if scipy else 10**6", code)
    scope = {"problem": watched, "scipy": name == "scipy", "range": range}
    with suppress(Enough):
        exec(code, scope)
    total = time.process_time() - watched.first
    return outcome(problem, watched.best, watched.curve, seed, watched.seconds, total)


def own(algo: str, seed: int, steps: float) -> dict:
    """Return what a run of ours found."""
    problem = problem_of_page()
    began = time.process_time()
    run = botschool.evolve(
        problem.experiment, seed=seed, algo=algo, maxmsteps=steps / 1e6, workers=2, **OURS[algo]
    )
    total = time.process_time() - began
    curve = list(zip(run.history["steps"].tolist(), run.history["best"].tolist(), strict=True))
    return outcome(problem, run.best, [(0, -np.inf), *curve], seed, None, total)


def outcome(problem, best, curve, seed, evaluating, total) -> dict:
    """Return the numbers of a run that are kept."""
    steps, tops = np.array(curve).T
    places = np.searchsorted(steps, np.linspace(0, steps[-1], POINTS + 1)[1:])
    return {
        "seed": seed,
        "new": float(problem.returns(best, FRESH + seed, EPISODES).mean()),
        "curve": tops[np.minimum(places, len(tops) - 1)].tolist(),
        "steps": int(steps[-1]),
        "evaluating": evaluating,
        "seconds": total,
    }


def main() -> None:
    """Run everything, and keep it."""
    steps = float(sys.argv[1]) if len(sys.argv) > 1 else STEPS
    code, load = examples(), os.getloadavg()[0]
    runs: dict[str, list[dict]] = {}
    for seed in SEEDS:
        for name in LIBRARIES:
            runs.setdefault(name, []).append(library(name, code[name], seed, steps))
        for algo in OURS:
            runs.setdefault(f"botschool {algo}", []).append(own(algo, seed, steps))
        print({name: round(found[-1]["new"], 1) for name, found in runs.items()}, flush=True)
    loads = f"{load:.0f} to {os.getloadavg()[0]:.0f}"
    kept = {"machine": machine(), "load": loads, "steps": steps, "runs": runs}
    DATA.write_text(json.dumps(kept, indent=1) + "\n", encoding="utf-8")
    for page in pages():
        page.write()


NAMES = {
    "cma": "diagonal CMA-ES of cma",
    "evosax": "SNES of evosax",
    "nevergrad": "TwoPointsDE of nevergrad",
    "scipy": "differential evolution of scipy",
}


def rows(kept: dict) -> str:
    """Return the table of results, and a sentence about the machine."""
    lines = []
    for name, runs in kept["runs"].items():
        seconds = [run["seconds"] for run in runs]
        evaluating = [run["evaluating"] for run in runs if run["evaluating"] is not None]
        lines.append([
            NAMES.get(name, name), spread(np.array([run["new"] for run in runs])),
            f"{np.mean(seconds):.1f}", f"{np.mean(evaluating):.1f}" if evaluating else "",
        ])  # fmt: skip
    columns = [
        "optimiser",
        "best candidate in 50 new episodes",
        "CPU seconds",
        "of these in `evaluate`",
    ]
    return (
        f"{table(columns, lines)}\n\n"
        f"(Mean and standard deviation of {len(SEEDS)} seeds after {kept['steps']:,.0f} "
        "steps each, 40 candidates a generation; without importing and compiling. "
        f"{kept['machine']}; busy with other work, load {kept['load']}. The seconds are "
        "those of all cores together. The examples are not tuned: they show how to call, not which "
        "library is best.)\n\n<!-- BEGIN NOT RELEASED -->\n"
        "`OMP_NUM_THREADS=1 python tools/studies optimisers` "
        "measures it anew.\n<!-- END NOT RELEASED -->"
    )


def figure(kept: dict) -> Figure:
    """Draw median and middle half of the best return so far against steps."""
    made = Figure(figsize=(8, 4.2), layout="constrained")
    axes = made.subplots()
    steps = np.linspace(0, kept["steps"] / 1e3, POINTS + 1)[1:]
    for (name, runs), colour in zip(
        kept["runs"].items(), (*COLOURS, GREY, "#000000"), strict=False
    ):
        band(axes, steps, [run["curve"] for run in runs], colour, NAMES.get(name, name))
    panel(axes, xlabel="thousand steps", ylabel="return of the best candidate so far")
    legend_above(made, axes, 3)
    return made


def pages() -> list[Page]:
    """Return the page, made from what is kept."""
    kept = json.loads(DATA.read_text("utf-8"))
    return [Page(PAGE, {"optimisers": rows(kept)}, {"optimisers": lambda: figure(kept)})]
