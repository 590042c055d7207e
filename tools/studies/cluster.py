"""What a cluster costs and how far it scales, for docs/reports/cluster.md.

    .venv/bin/python tools/studies cluster            # measures all, some minutes, then writes
    .venv/bin/python tools/studies cluster constants overhead    # only these parts
    .venv/bin/python tools/studies cluster page       # only writes, from data/cluster.json

Constants are processor time, of which other programs take little away; whole turns are measured by
the clock, the shortest of several.
"""

from __future__ import annotations

import argparse
import itertools
import json
import statistics
import time
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from unittest import mock

import cluster_page
import numpy as np
import psutil
from cluster_model import Load, Wire, makespan
from processes import Neighbours
from report import commit, machine

from botschool import config
from botschool.cluster import Open, dispatch
from botschool.config import Experiment
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.run import Limit, Run
from botschool.problems import Episodes, Interrupted
from clusters import Cable, port_of
from clusters import Cluster as Machines

ROOT = Path(__file__).parents[2]
DATA = cluster_page.DATA
SEED = 1


@dataclass(frozen=True)
class Case:
    """An experiment of data/experiments, and how a turn of it takes some tenths of a second."""

    file: str
    batches: int
    """Batches of episodes from which its constants are taken, as it is."""
    heavier: dict
    """Hyperparameters of the algorithm, for whole generations."""
    robot: str = ""
    """A saved robot from which it starts, as episodes of the first ones are short."""

    def load(self, heavier: bool = False) -> Experiment:
        """The experiment."""
        found = config.load(ROOT / "data" / "experiments" / f"{self.file}.ini")
        return replace(found, algo=replace(found.algo, **self.heavier)) if heavier else found

    def run(self, heavier: bool = False, problem=None) -> Run:
        """A run of it, before its first generation; without limit."""
        experiment = self.load(heavier)
        kind = Coevolution if experiment.competitive else Run
        run = kind(experiment, SEED, problem=problem)
        run.limit = Limit()
        if self.robot and not heavier:
            saved = np.load(ROOT / "data" / "genotypes" / self.robot)
            run.algorithm.centre, run.evaluator.normalisation = run.policy.split(saved)
        return run


CASES = (
    Case("acrobot", 40, {"samplesize": 15_000}),
    Case("discrim", 10, {"samplesize": 1000}),
    Case("predprey", 2, {"popsize": 16, "selsize": 4, "samplesize": 40}),
    Case("hopper", 4, {"samplesize": 100}, "hopper.npy"),
)


class Watched:
    """What a run evaluates, batch by batch; it is stopped after so many."""

    def __init__(self, run: Run, batches: int, count: Callable[[], Any] = lambda: None) -> None:
        """count: asked before each batch."""
        self.counts: list = []
        """What it gave."""
        self.began: list[float] = []
        """When, by the clock."""
        self.seconds: list[float] = []
        """Processor time of this process, in each."""
        self.steps: list[np.ndarray] = []
        self.candidates: list[int] = []
        evaluate = run.problem.evaluate

        def watched(policy, genotypes, *rest):
            if len(self.steps) == batches:
                raise Interrupted
            self.counts.append(count())
            self.began.append(time.perf_counter())
            before = time.process_time()
            outcome = evaluate(policy, genotypes, *rest)
            self.seconds.append(time.process_time() - before)
            self.steps.append(outcome.steps)
            parts = genotypes if isinstance(genotypes, tuple) else [genotypes]
            self.candidates.append(sum(map(len, parts)))
            return outcome

        run.problem.evaluate = watched
        before = time.process_time()
        try:
            while True:
                run.advance(goes_on=True)
        except Interrupted:
            self.ended = time.perf_counter()
            self.apart = time.process_time() - before - sum(self.seconds)
            """Processor time of all that is not evaluation."""
        del run.problem.evaluate

    @property
    def turns(self) -> list[int]:
        """Places of the batches that evaluate a generation, or a side's turn; neither the first
        one, which may differ, nor post-evaluations."""
        sizes = [len(each) for each in self.steps]
        return [i for i in range(1, len(sizes)) if sizes[i] == max(sizes[1:])]


def constants(case: Case, heavier: bool = False) -> Load:
    """Of a turn on one core."""
    run = case.run(heavier)
    watched = Watched(run, batches_of(run) if heavier else case.batches)
    turns, native = watched.turns, run.problem.native
    lanes = 16 if native else 1
    passed = sum(makespan(watched.steps[i], lanes) for i in turns)
    each, drawing = of_candidates(run)
    lengths = np.concatenate([watched.steps[i] for i in turns])
    return Load(
        steps=np.random.default_rng(SEED).choice(lengths, min(5000, len(lengths)), replace=False),
        episodes=len(watched.steps[turns[0]]),
        post=0 if native else run.policy.config.pepisodes,
        candidates=watched.candidates[turns[0]],
        parameters=run.policy.genotype_size // run.problem.interface.robots,
        step=sum(watched.seconds[i] for i in turns) / passed,
        lanes=lanes,
        algorithm=watched.apart / (len(turns) + 1),
        each=each,
        drawing=drawing,
    )


def of_candidates(run: Run) -> tuple[float, float]:
    """Seconds of the algorithm for one candidate more; and to draw one normal number."""
    rng, count, rounds = np.random.default_rng(1), 400_000, 20
    began = time.process_time()
    rng.standard_normal(count)
    drawing = (time.process_time() - began) / count
    if isinstance(run, Coevolution):
        return 0.0, drawing
    began = time.process_time()
    for _ in range(rounds):
        candidates, _ = run.algorithm.ask()
        run.algorithm.tell(rng.standard_normal(len(candidates)))
    return (time.process_time() - began) / rounds / len(candidates), drawing


@contextmanager
def opened(workers: int):
    """A cluster on this machine."""
    with Open(f"local:{workers}")(lambda sentence: None) as cluster:
        yield cluster


def wire(cluster) -> Wire:
    """Of a cluster with one worker. What a chunk costs is the processor time, of command and
    scheduler, which are one process here, and of the worker, that many small chunks take more than
    a few large ones.
    """
    problem = cluster.problem(CASES[0].load(heavier=True))
    problem._shortest = 0
    run = CASES[0].run(True, problem)
    run.advance()
    costs = []
    for _ in range(3):
        few, many = spent(run, problem, 16384), spent(run, problem, 256)
        costs.append((many - few)[:2] / (many - few)[2])
    chunk, there = np.median(costs, axis=0).tolist()
    return Wire(chunk, max(0.0, there), latency(problem, run))


def spent(run: Run, problem, episodes: int) -> np.ndarray:
    """For a generation in chunks of so many episodes: processor time of this process, of the
    worker besides evaluation, and the number of chunks."""
    connection, own = problem._connection, psutil.Process()
    with (
        mock.patch.object(dispatch, "size", lambda *given: episodes),
        mock.patch.object(connection, "submit", wraps=connection.submit) as submitted,
    ):
        before = time.process_time(), seconds_of(own.children(True)) - problem.watch.busy
        run.advance()
        after = time.process_time(), seconds_of(own.children(True)) - problem.watch.busy
        return np.array([*np.subtract(after, before), submitted.call_count])


def seconds_of(processes: list[psutil.Process]) -> float:
    """Their processor time so far."""
    return sum(sum(each.cpu_times()[:2]) for each in processes)


def latency(problem, run: Run) -> float:
    """Seconds from the sending of one short episode to its outcome, without its computation: the
    shortest of many."""
    genotype, found = run.policy.initial(SEED)[None], []
    for number in range(60):
        before, began = problem.watch.busy, time.perf_counter()
        problem.evaluate(run.policy, genotype, None, Episodes.of([number], 1), 20)
        found.append(time.perf_counter() - began - (problem.watch.busy - before))
    return min(found)


WORKERS = (1, 2, 4, 6, 8)
TURNS = 3
"""Turns after the first one that are measured; later ones have other episodes."""


def batches_of(run: Run) -> int:
    """Batches in which those are."""
    return (TURNS + 1) * (1 if run.problem.native else 2)


def turns() -> dict:
    """{experiment: {workers: seconds of a turn by the clock}}, the shorter of two times the same
    turns, on one and the same cluster; and what the wire costs."""
    found: dict = {case.file: {} for case in CASES}
    with opened(max(WORKERS)) as cluster:
        for workers in reversed(WORKERS):
            shrink(cluster, workers)
            if workers == 1:
                found["wire"] = asdict(wire(cluster))
            for case in CASES:
                problem = cluster.problem(case.load(heavier=True))
                problem._shortest = 0
                times = []
                for _ in range(2):
                    run = case.run(True, problem)
                    watched = Watched(run, batches_of(run))
                    times.append((watched.ended - watched.began[watched.turns[0]]) / TURNS)
                found[case.file][workers] = min(times)
                print(f"   {case.file}, {workers} workers: {min(times):.3f} s", flush=True)
    return found


def shrink(cluster, workers: int) -> None:
    """Leaves the cluster so many workers."""
    connection = cluster._connection
    connection._cluster.scale(workers)
    while len(connection.members) != workers:
        connection.refresh()
        time.sleep(0.05)


HEAVY = {"discrim": {"samplesize": 8000}, "hopper": {"samplesize": 400}}
"""Experiments whose generations take longer than a second on two cores."""


def overhead(pairs: int = 9) -> dict:
    """Generations on `--cluster local:2` beside the same ones with -w 2, by turns: by the clock,
    and processor time of all processes."""
    found = {}
    with opened(2) as cluster:
        for case in CASES:
            if case.file not in HEAVY:
                continue
            case = replace(case, heavier=HEAVY[case.file])
            problem = cluster.problem(case.load(True))
            sides = [case.run(True), case.run(True, problem)]
            sides[0].workers = sides[0].evaluator._workers = 2
            rows = []
            for _ in range(pairs + 1):
                rows.append([used(each) for each in sides])
            sides[0].problem.close()
            rows = rows[1:]  # the first has the start of the processes in it
            clock = [there[0] / here[0] for here, there in rows]
            work = [sum(row[side][1] for row in rows) for side in (0, 1)]
            found[case.file] = {
                "generation": statistics.median(row[0][0] for row in rows),
                "clock": statistics.median(clock),
                "all clocks": clock,
                "processor": work[1] / work[0],
            }
            print(f"   {case.file}: {found[case.file]}", flush=True)
    return found


def used(run: Run) -> tuple[float, float]:
    """Seconds of a generation by the clock, and of all processors."""
    own = psutil.Process()

    def processors() -> float:
        return seconds_of([own, *own.children(recursive=True)])

    began, before = time.perf_counter(), processors()
    run.advance(goes_on=True)
    return time.perf_counter() - began, processors() - before


def traffic() -> dict:
    """Bytes for each candidate of the experiments as they are, on two workers: of messages, and all
    that passes between command and scheduler."""
    found = {}
    with TemporaryDirectory() as folder, Machines(Path(folder)) as machines:
        machines.start_workers(2)
        for case in CASES:
            cable = Cable(port_of(machines.address))
            with Open(f"tcp://127.0.0.1:{cable.port}")(lambda sentence: None) as cluster:
                problem = cluster.problem(case.load())
                problem._shortest = 0
                run = replace(case, robot="").run(False, problem)
                watch = problem.watch
                watched = Watched(
                    run,
                    12 if case.file == "predprey" else 20,
                    lambda cable=cable, watch=watch: (watch.sent + watch.received, cable.passed),
                )
                first, last = watched.turns[0], watched.turns[-1]
                before, after = watched.counts[first], watched.counts[last]
                played = sum(watched.candidates[first:last])
                found[case.file] = {
                    "candidates": watched.candidates[first],
                    "parameters": run.policy.genotype_size // run.problem.interface.robots,
                    "messages": (after[0] - before[0]) / played,
                    "all": (after[1] - before[1]) / played,
                }
                print(f"   {case.file}: {found[case.file]}", flush=True)
            cable.close()
    return found


def all_constants() -> dict:
    """Loads as dicts, {experiment: as it is}, {experiment: with more candidates}."""
    found = {"as it is": {}, "heavier": {}}
    for (name, loads), case in itertools.product(found.items(), CASES):
        load = asdict(constants(case, name == "heavier"))
        load["steps"] = load["steps"].tolist()
        loads[case.file] = load
        print(f"   {case.file}, {name}", flush=True)
    return found


PARTS = {
    "constants": all_constants,
    "turns": turns,
    "overhead": overhead,
    "traffic": traffic,
}


def measure(name: str) -> None:
    """One part; the others in the file stay."""
    print(f"-- {name}", flush=True)
    neighbours = Neighbours()
    data = json.loads(DATA.read_text()) if DATA.exists() else {}
    data[name] = {
        "data": PARTS[name](),
        "measured": {
            "commit": commit(),
            "date": time.strftime("%Y-%m-%d", time.gmtime()),
            "machine": machine(),
            "note": neighbours.sentence(),
        },
    }
    DATA.parent.mkdir(parents=True, exist_ok=True)
    text = json.dumps(data, separators=(",", ":"))
    DATA.write_text(text.replace(',"', ',\n"') + "\n", encoding="utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description="Measures and writes the report's tables.")
    parser.add_argument("parts", nargs="*", choices=[*PARTS, "page"], default=[*PARTS])
    for name in parser.parse_args().parts:
        if name != "page":
            measure(name)
    cluster_page.write()
