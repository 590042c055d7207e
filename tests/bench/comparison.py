"""botschool beside what a user would pick today: gymnax (JAX), EnvPool, Gymnasium's own loop.

Each contestant has a process of its own that may use the same cores as the others; they take turns.
A contestant whose package is missing is left out, with a line that says how to get it.
"""

from __future__ import annotations

import importlib.util
import multiprocessing
import os
import time
from functools import partial
from importlib.metadata import version

from contestants import (
    ENVIRONMENTS,
    HIDDEN,
    PROBLEMS,
    STEPS,
    Botschool,
    EnvPool,
    Gymnasium,
    Gymnax,
    Weights,
)
from report import Table, rate
from speed import DATA

CONTESTANTS = {
    "botschool": Botschool,
    "gymnax": Gymnax,
    "gymnax, no resets": partial(Gymnax, reset=False),
    "EnvPool": EnvPool,
    "Gymnasium's loop": Gymnasium,
}
ALONE = {
    "gymnax": partial(Gymnax, network=False),
    "EnvPool": partial(EnvPool, network=False),
    "Gymnasium's loop": partial(Gymnasium, network=False),
}
"""The same with random actions instead of networks; botschool has no such form."""
UNLIKE = ("gymnax, no resets", "Gymnasium's loop")
"""Without ends of episodes, or with few networks in a turn: their rewards are no check."""
PACKAGES = {"gymnax": "gymnax", "gymnax, no resets": "gymnax", "EnvPool": "envpool"}
GET = ".venv/bin/python -m pip install -c constraints.txt 'botschool[bench]'"


def missing() -> list[str]:
    """The packages of contestants that are not installed."""
    names = dict.fromkeys(PACKAGES.values())
    return [name for name in names if importlib.util.find_spec(name) is None]


def notice() -> str:
    """A line about them; empty if there are none."""
    left_out = missing()
    if not left_out:
        return ""
    return f"Left out, because not installed: {', '.join(left_out)}. Install with: {GET}"


def _present(contestants: dict) -> dict:
    left_out = missing()
    return {name: make for name, make in contestants.items() if PACKAGES.get(name) not in left_out}


def _serve(make, cores: int, pipe) -> None:
    """A contestant's process: a problem's name prepares, a number plays for so many seconds.

    On one core the seconds are processor time, of all threads.
    """
    clock = time.process_time if cores == 1 else time.perf_counter
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:cores])
    contestant = None
    while (asked := pipe.recv()) is not None:
        if isinstance(asked, str):
            contestant = make(asked, Weights.of(asked, DATA), cores)
            played = contestant.play()
            compiling = getattr(contestant, "compiling", None)
            pipe.send({"compiling": compiling, "ended": played.ended, "reward": played.reward})
        else:
            steps, start = 0, clock()
            while (elapsed := clock() - start) < asked:
                steps += contestant.play().steps
            pipe.send(steps / elapsed)


def measure(contestants: dict, cores: int, seconds: float, repetitions: int) -> dict:
    """{problem: {contestant: {"rate": steps/s, "compiling", "ended", "reward"}}}, best of turns."""
    context = multiprocessing.get_context("spawn")
    pipes, processes = {}, []
    for name, make in contestants.items():
        pipes[name], other = context.Pipe()
        processes.append(context.Process(target=_serve, args=(make, cores, other), daemon=True))
        processes[-1].start()
        other.close()
    measured: dict = {}
    for problem in PROBLEMS:
        of_problem = measured[problem] = {}
        for name, pipe in pipes.items():
            pipe.send(problem)
            of_problem[name] = pipe.recv() | {"rate": 0.0}
        for _ in range(repetitions):
            for name, pipe in pipes.items():
                pipe.send(seconds)
                of_problem[name]["rate"] = max(of_problem[name]["rate"], pipe.recv())
    for pipe in pipes.values():
        pipe.send(None)
    for process in processes:
        process.join()
    return measured


def _rates(measured: dict, names: dict, title: str, about: str) -> Table:
    table = Table(title, about, ["problem", *names])
    for problem, found in measured.items():
        table.add(problem, *(rate(found[name]["rate"]) if name in found else "-" for name in names))
    return table


def versions() -> str:
    """Of the contestants' packages that are there."""
    packages = ["gymnax", "jax", "envpool", "gymnasium"]
    there = [name for name in packages if importlib.util.find_spec(name)]
    return ", ".join(f"{name} {version(name)}" for name in there)


def comparison(seconds: float, repetitions: int) -> list[Table]:
    """With networks on one core and on two, without networks, and what must be known about both."""
    conditions = (
        f"{ENVIRONMENTS} environments, each with a network of its own (the same for all: "
        f"{HIDDEN} tanh neurons, linear outputs, biases); {STEPS} steps of each environment a "
        f"call; best of {repetitions} turns of {seconds:g} s. "
    )
    tables = []
    for cores in (1, 2):
        measured = measure(_present(CONTESTANTS), cores, seconds, repetitions)
        title = f"Steps/s of networks and environments, {cores} core{'s' * (cores - 1)}"
        bound = "the same core" if cores == 1 else f"the same {cores} cores"
        seconds_are = "processor time of the whole process" if cores == 1 else "by the clock"
        about = conditions + f"Each process is bound to {bound}; seconds: {seconds_are}."
        tables.append(_rates(measured, CONTESTANTS, title, about))
        tables[-1].numbers = measured
    alone = measure(_present(ALONE), 1, seconds, repetitions)
    about = "The same environments with random actions that were drawn before."
    tables.append(_rates(alone, ALONE, "Steps/s of environments alone, 1 core", about))
    tables.append(_conditions(tables[0].numbers))
    return tables


def checks(found: list[dict]) -> tuple[str, str]:
    """By which a reader sees that all play the same problems."""
    ends = "; ".join(f"{1000 * each['ended']:.2g}" for each in found)
    return ends, "; ".join(f"{each['reward']:.3g}" for each in found)


def _conditions(measured: dict) -> Table:
    table = Table(
        "The conditions of each side",
        f"{versions()}. Compilation (processor time) is not part of the above. Ends of episodes / "
        f"1000 steps and reward / step, in {', '.join(PROBLEMS)}, show that all play the same: "
        "each draws its own episodes, so they agree but for chance.",
        ["contestant", "precision", "compiling", "ends / 1000 steps", "reward / step"],
    )
    for name, make in _present(CONTESTANTS).items():
        found = [measured[problem][name] for problem in PROBLEMS]
        compiled = [each["compiling"] for each in found if each["compiling"] is not None]
        table.add(
            name,
            getattr(make, "func", make).precision,
            f"{min(compiled):.1f} to {max(compiled):.1f} s a problem"
            if compiled
            else "ahead of time",
            *(("-", "-") if name in UNLIKE else checks(found)),
        )
    return table
