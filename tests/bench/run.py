"""Measures what botschool promises about speed, memory and start-up: `make bench`.

Nothing is written unless --json names a file. It is a measurement and no test: it always ends well,
and the words PASS and FALLS SHORT say how each target fared.
"""

from __future__ import annotations

import argparse
import json
import tempfile
from collections.abc import Iterator
from dataclasses import asdict
from functools import partial
from pathlib import Path

import numpy as np
from comparison import comparison, notice
from processes import Neighbours, help_seconds, peak_memory
from report import Table, machine, rate, verdict
from runners import runners, two_workers_on_runners
from speed import (
    CASES,
    DATA,
    Batch,
    GymnasiumLoop,
    Meetings,
    best_call,
    generations_in,
    rates,
    run_times,
    undisturbed,
)

from botschool import _core, config
from botschool.analysis.populations import Population, Populations
from botschool.evolution.coevolution import Coevolution

TWO_WORKERS = 1.8
GENERATION = 60
EVOLVED, EVOLVED_SEED = DATA.parent / "genotypes" / "predprey", 12
MEMORY = 300
HELP = 0.3


def episodes_of_generation(experiment) -> int:
    """How many episodes evaluate one generation."""
    candidates = getattr(experiment.algo, "popsize", 0) or 2 * experiment.algo.samplesize
    return candidates * experiment.policy.episodes


def _episodes() -> str:
    """How many episodes a large batch has."""
    most = CASES[0].episodes
    others = [f"{case.file} {case.episodes}" for case in CASES if case.episodes != most]
    return f"{most} episodes ({', '.join(others)})"


def beside_gymnasium(seconds: float, repetitions: int) -> Table:
    """Native evaluation and Gymnasium's own loop, one core."""
    table = Table(
        "Steps/s of the whole policy-plus-problem evaluation, one core",
        f"Each experiment file's network with random initial genotypes; best of {repetitions} "
        "interleaved repetitions. Native: as many episodes as one generation has, and "
        f"{_episodes()}; the ratio is that of the slower of the two. Gymnasium: a Python loop over "
        "gymnasium.make(id) with the same network (double precision) and genotypes. Original "
        "library: published for another machine of this kind, not measured here.",
        [
            "experiment",
            "steps / episode",
            "native, a generation",
            "native, a large batch",
            "Gymnasium's loop",
            "native / Gymnasium",
            "target",
            "",
            "original library",
        ],
    )
    for case in CASES:
        experiment = case.load()
        small = Batch(experiment, episodes_of_generation(experiment))
        large = Batch(experiment, case.episodes)
        contestants = [small.evaluate, large.evaluate]
        if case.gymnasium:
            contestants.append(GymnasiumLoop(large).evaluate)
        best = [max(results) for results in rates(contestants, seconds, repetitions)]
        native = min(best[:2])
        table.add(
            case.file,
            f"{large.evaluate() / case.episodes:.0f}",
            *(rate(r) for r in best[:2]),
            rate(best[2]) if case.gymnasium else "-",
            f"{native / best[2]:,.0f} x" if case.gymnasium else "-",
            rate(case.target),
            verdict(native >= case.target),
            rate(case.original) if case.original else "-",
        )
    return table


def instruction_sets(seconds: float, repetitions: int) -> Table:
    """Native evaluation with every instruction set of this machine, one core."""
    sets = _core.instruction_sets()
    table = Table(
        "Steps/s with each instruction set of this machine, one core",
        f"Native evaluation of {_episodes()}, as above. All give the same bits; a run takes "
        "the last one.",
        ["experiment", *sets],
    )
    for case in CASES:
        batches = [Batch(case.load(), case.episodes, name) for name in sets]
        measured = rates([batch.evaluate for batch in batches], seconds, repetitions)
        table.add(case.file, *(rate(max(results)) for results in measured))
    return table


def two_workers_evaluating(repetitions: int) -> Table:
    """Evaluation on one worker and on two."""
    table = Table(
        "Two workers against one: evaluation",
        f"Steps/s of the native evaluation of {_episodes()}; the fastest of {repetitions} "
        f"calls each, taking turns.",
        ["experiment", "1 worker", "2 workers", "2 / 1", "target", ""],
    )
    for case in CASES:
        batch = Batch(case.load(), case.episodes)
        one, two = best_call([partial(batch.evaluate, w) for w in (1, 2)], repetitions)
        table.add(
            case.file,
            rate(one),
            rate(two),
            f"{two / one:.2f}",
            str(TWO_WORKERS),
            verdict(two / one >= TWO_WORKERS),
        )
    return table


def two_workers_running(seconds: float, repetitions: int) -> Table:
    """Whole runs on one worker and on two."""
    table = Table(
        "Two workers against one: whole runs",
        f"Steps/s of a run's first generations, about {seconds} s of them, the same on both sides; "
        f"each generation's shortest time in {repetitions} repetitions that take turns; no files. "
        "Evaluating: the share of one worker's time that a second can halve; the rest is the "
        f"algorithm in numpy. At most: 2 / 1 if it were halved.",
        ["experiment", "1 worker", "evaluating", "2 workers", "2 / 1", "at most", "target", ""],
    )
    for case in CASES:
        experiment = case.load()
        if experiment.exp.algo == "coevo2":
            continue  # see coevolution()
        generations = generations_in(experiment, seconds)
        pairs = [
            [run_times(experiment, workers, generations) for workers in (1, 2)]
            for _ in range(repetitions)
        ]
        one, two = (undisturbed(list(side)) for side in zip(*pairs, strict=True))
        ratio = one.whole.sum() / two.whole.sum()
        share = one.evaluating.sum() / one.whole.sum()
        table.add(
            case.file,
            rate(one.steps.sum() / one.whole.sum()),
            f"{100 * share:.0f} %",
            rate(two.steps.sum() / two.whole.sum()),
            f"{ratio:.2f}",
            f"{1 / (1 - share / 2):.2f}",
            str(TWO_WORKERS),
            verdict(ratio >= TWO_WORKERS),
        )
    return table


def fill(population: Population, run: Coevolution) -> None:
    """Replaces the random networks of both sides, each repeated until there are enough."""
    for side, networks in enumerate((population.predators, population.prey)):
        run.algorithm.parameters[side] = np.resize(networks, run.algorithm.parameters[0].shape)


def meetings(seconds: float, repetitions: int) -> Table:
    """ErPredprey with networks of one's own, and as in co-evolution."""
    table = Table(
        "ErPredprey: who has which network, one core",
        f"Steps/s of the evaluation; best of {repetitions} interleaved repetitions. Of their own: "
        "random networks, another two in each episode. Otherwise the ten best of each side in "
        "data/genotypes/predprey, with noise of 0.02: 80 of one side against ten of the other.",
        ["networks", "steps/s", "ns a step"],
    )
    case = next(case for case in CASES if case.file == "predprey")
    contestants = {
        "of their own": Batch(case.load(), case.episodes),
        "80 predators x 10 prey": Meetings(EVOLVED, EVOLVED_SEED, 80, 10),
        "10 predators x 80 prey": Meetings(EVOLVED, EVOLVED_SEED, 10, 80),
    }
    measured = rates([each.evaluate for each in contestants.values()], seconds, repetitions)
    for name, results in zip(contestants, measured, strict=True):
        table.add(name, rate(max(results)), f"{1e9 / max(results):.0f}")
    return table


def coevolution(popsize: int, generations: int) -> Table:
    """Generations of co-evolution, one core."""
    table = Table(
        "Generations of co-evolution, one core",
        f"predprey.ini with seed 1 and popsize {popsize}, no files, once each. The populations are "
        "filled with the ten best of each side in data/genotypes/predprey; first everyone meets "
        f"everyone. The target is {GENERATION} s a generation. Evaluating: the share of the time "
        "that is the native call.",
        ["begins with generation", "", "seconds", "steps", "steps/s", "evaluating", ""],
    )
    experiment = config.load(DATA / "predprey.ini")
    experiment.algo.popsize = popsize
    kept = Populations(EVOLVED, EVOLVED_SEED, Coevolution(experiment, 1).policy)
    names = ["everyone meets everyone", "predators evolve", "prey evolve"][: 1 + generations]
    for number in (kept.generations[len(kept.generations) // 2], kept.generations[-1]):
        times = run_times(experiment, 1, len(names), partial(fill, kept.load(number)))
        for name, steps, whole, evaluating in zip(
            names, times.steps, times.whole, times.evaluating, strict=True
        ):
            table.add(
                f"{number}",
                name,
                f"{whole:.1f}",
                rate(steps),
                rate(steps / whole),
                f"{100 * evaluating / whole:.1f} %",
                verdict(whole < GENERATION) if name.endswith("evolve") else "",
            )
    return table


def memory_and_start(seconds: float, repetitions: int) -> Table:
    """Peak memory of runs, time of --help."""
    table = Table(
        "Memory and start-up of the command",
        "Peak memory sums the peaks of all processes of a run, shared pages counted in each. "
        f"--help: median of {repetitions}.",
        ["what", "measured", "target", ""],
    )
    with tempfile.TemporaryDirectory() as folder:
        general = Path(folder) / "general.ini"
        text = (DATA / "acrobot.ini").read_text(encoding="utf-8")
        general.write_text(text.replace("Acrobot-v1", "MountainCar-v0"), encoding="utf-8")
        for name, file in (
            ("acrobot.ini, 2 workers (threads)", DATA / "acrobot.ini"),
            ("MountainCar-v0 in Gymnasium, 2 workers (processes)", general),
        ):
            arguments = ["es", "-f", str(file), "-w", "2", "-o", f"{folder}/{file.stem}"]
            peak = peak_memory(arguments, seconds)
            table.add(
                f"peak memory, {name}",
                f"{peak[0]:.0f} MiB, processes: {peak[1]}" if peak else "- (needs Linux)",
                f"< {MEMORY} MiB",
                verdict(peak[0] < MEMORY) if peak else "",
            )
    taken = help_seconds(repetitions)
    table.add("botschool --help", f"{taken:.2f} s", f"< {HELP} s", verdict(taken < HELP))
    return table


PARTS = {
    "others": (comparison, (0.1, 2), (0.5, 3)),
    "gymnasium": (beside_gymnasium, (0.1, 2), (0.3, 5)),
    "instructions": (instruction_sets, (0.05, 2), (0.15, 5)),
    "workers": (two_workers_evaluating, (20,), (200,)),
    "runs": (two_workers_running, (0.15, 2), (0.5, 7)),
    "meetings": (meetings, (0.05, 2), (0.5, 5)),
    "coevolution": (coevolution, (20, 0), (80, 2)),
    "runners": (runners, (0.2, 2), (1.0, 5)),
    "runnerworkers": (two_workers_on_runners, (3,), (20,)),
    "memory": (memory_and_start, (2, 3), (8, 10)),
}
"""What is measured: a function that gives tables, its arguments with --quick and without."""


def measured(names: list[str], quick: bool) -> Iterator[Table]:
    """The tables of these parts, one after the other."""
    for name in names:
        part, rough, thorough = PARTS[name]
        found = part(*(rough if quick else thorough))
        yield from [found] if isinstance(found, Table) else found


def main() -> None:
    parser = argparse.ArgumentParser(description="Speed, memory and start-up of botschool.")
    parser.add_argument("--quick", action="store_true", help="rougher, in a few minutes")
    parser.add_argument("--only", nargs="+", choices=PARTS, metavar="PART", help=" ".join(PARTS))
    parser.add_argument("--markdown", action="store_true", help="tables in Markdown")
    parser.add_argument("--json", type=Path, metavar="FILE", help="also write all numbers there")
    options = parser.parse_args()
    print(f"Machine: {machine()}\n")
    tables, neighbours = [], Neighbours()
    for table in measured(options.only or list(PARTS), options.quick):
        tables.append(table)
        table.show(options.markdown)
    print(neighbours.sentence())
    print(notice())
    if options.json:
        data = {
            "machine": machine(),
            "note": neighbours.sentence(),
            "tables": [asdict(table) for table in tables],
        }
        options.json.write_text(json.dumps(data, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
