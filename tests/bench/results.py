"""What the experiments of data/experiments reach, over several seeds: `make results`.

Every run is that of `botschool es -f FILE -s SEED`, two of them side by side on a core each. Prints
a Markdown table for docs/results.md. `--only acrobot pendulum`, `--seeds 1-10`, `--box2d`.
"""

from __future__ import annotations

import argparse
import multiprocessing
import tempfile
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from report import Table, machine

from botschool import config
from botschool.analysis.runs import read_stat
from botschool.evolution.record import RunFiles
from botschool.evolution.run import Run, evolve
from botschool.problems import Episodes

DATA = Path(__file__).parents[2] / "data" / "experiments"
NEW_SEED = 2**40
"""New episodes are those of a seed that no run uses."""


@dataclass
class Row:
    """An experiment file, and what is known of others' results on its problem."""

    file: str
    published: str = "-"
    solved: float | None = None
    """Best post-evaluated fitness from which a run counts as solved."""
    box2d: bool = False


ROWS = [
    Row("acrobot", "-66.3 +- 2.1 (20 M steps); PPO -73.5 +- 18"),
    Row("pendulum", "-206 +- 39 (100 M steps); PPO -172 +- 104"),
    Row("cartpole", "PPO 500", 500),
    Row("cartpole_openaies", "PPO 500", 500),
    Row("mountaincarcontinuous", solved=90),
    Row("swingup"),
    Row("dpole", "725 +- 21"),
    Row("discrim", "about 180 to 360 (50 M steps)"),
    Row("lunarlander", solved=200, box2d=True),
    Row("bipedalwalker", solved=300, box2d=True),
]


@dataclass
class Result:
    """What one run reached."""

    best: float
    """Best post-evaluated fitness."""
    new: float
    """Mean return of that robot in new episodes."""
    solved_after: float
    """Steps until `solved` was reached; infinite if it never was."""
    seconds: float


def run(row: Row, seed: int) -> Result:
    """One whole run, on one core; its files go to a temporary folder."""
    experiment = config.load(DATA / f"{row.file}.ini")
    with tempfile.TemporaryDirectory() as folder:
        start = time.monotonic()
        run = Run(experiment, seed)
        evolve(run, Path(folder))
        seconds = time.monotonic() - start
        stat = read_stat(RunFiles(Path(folder), seed).stat)
    best = run.record.bestg_fitness
    after = np.inf
    if row.solved is not None and best >= row.solved:
        after = stat[np.argmax(stat[:, 2] >= row.solved), 0]
    genotype, normalisation = run.policy.split(run.record.bestg)
    outcome = run.problem.evaluate(
        run.policy,
        genotype[None],
        normalisation,
        Episodes.of([NEW_SEED + seed], 100 if row.box2d else 1000),
        experiment.policy.maxsteps,
    )
    return Result(best, float(outcome.fitness.mean()), float(after), seconds)


def solved(row: Row, results: list[Result]) -> str:
    """How many runs solved the problem, and the steps that took."""
    if row.solved is None:
        return "-"
    after = sorted(r.solved_after for r in results if np.isfinite(r.solved_after))
    count = f"{len(after)} of {len(results)}"
    if not after:
        return f"{count} (>= {row.solved:g})"
    median, most = np.median(after) / 1e6, after[-1] / 1e6
    return f"{count} (>= {row.solved:g}; {median:.2g} M, at most {most:.2g} M)"


def cells(row: Row, results: list[Result]) -> list[str]:
    """The row of the table."""
    experiment = config.load(DATA / f"{row.file}.ini")
    best = np.array([result.best for result in results])
    new = np.array([result.new for result in results])
    digits = 1 if np.abs(best).max() < 1000 else 0
    spread = f" +- {best.std(ddof=1):.{digits}f}" if len(best) > 1 else ""
    return [
        f"{row.file}.ini",
        experiment.exp.algo,
        f"{experiment.algo.maxmsteps:g} M",
        f"{best.mean():.{digits}f}{spread}",
        f"{best.min():.{digits}f}",
        f"{best.max():.{digits}f}",
        f"{new.mean():.{digits}f}",
        solved(row, results),
        row.published,
        f"{np.mean([result.seconds for result in results]):.1f} s",
    ]


def seeds(text: str) -> list[int]:
    """1-10 or 7 -> the seeds."""
    first, _, last = text.partition("-")
    return list(range(int(first), int(last or first) + 1))


def main() -> None:
    parser = argparse.ArgumentParser(description="What the experiments reach, over several seeds.")
    parser.add_argument("--only", nargs="+", metavar="NAME", help="these experiment files")
    parser.add_argument("--seeds", type=seeds, default=seeds("1-10"), help="default: 1-10")
    parser.add_argument("--box2d", action="store_true", help="also those in Box2D (long)")
    parser.add_argument("--processes", type=int, default=2, help="runs side by side (default 2)")
    options = parser.parse_args()
    names = [row.file for row in ROWS]
    for name in options.only or []:
        if name not in names:
            parser.error(f"there is no {name}: choose from {', '.join(names)}.")
    wanted = options.only or [row.file for row in ROWS if options.box2d or not row.box2d]
    chosen = [row for row in ROWS if row.file in wanted]
    table = Table(
        "Results",
        f"Seeds {options.seeds[0]} to {options.seeds[-1]}; {machine()}. Best post-evaluated "
        "fitness of a run: mean +- sd over the runs, smallest, largest. New episodes: the mean of "
        "those robots in 1000 (Box2D: 100) episodes that played no part in choosing them.",
        [
            "experiment",
            "algorithm",
            "steps",
            "mean +- sd",
            "min",
            "max",
            "in new episodes",
            "solved (median and largest steps)",
            "published",
            "time of a run, one core",
        ],
    )
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(options.processes, mp_context=context) as pool:
        for row in chosen:
            results = list(pool.map(run, [row] * len(options.seeds), options.seeds))
            table.add(*cells(row, results))
            print("| " + " | ".join(table.rows[-1]) + " |", flush=True)
    print()
    table.show(markdown=True)


if __name__ == "__main__":
    main()
