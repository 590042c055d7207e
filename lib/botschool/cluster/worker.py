"""What workers do: the functions that Dask calls there. They take bytes and give bytes.

A worker process keeps what it has been sent: the experiment, from which it makes the problem and
the policy, and tables (centres, populations) by their digests. What it lacks it asks for.
"""

from __future__ import annotations

import multiprocessing
import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from multiprocessing.util import Finalize
from typing import Any

import numpy as np

from botschool import __version__, config, problems
from botschool.cluster import wire
from botschool.errors import BotschoolError
from botschool.policy import Policy
from botschool.problems import Episodes, Problem
from botschool.seeds import generator

TABLES = 32
"""Tables that a worker keeps, the newest."""
PROBE = 987_654_321
PROBED = 20
"""Steps of each episode of a probe."""

_one_at_a_time = threading.Lock()  # each evaluation uses all threads of the worker
_tables: OrderedDict[bytes, Any] = OrderedDict()
_made: dict[bytes, tuple[Problem, Policy]] = {}


def hello(message: bytes) -> bytes:
    """Who this worker is: version, threads, and the bits of a probe of the experiment."""
    return _answer(message, _hello)


def evaluate(message: bytes) -> bytes:
    """A chunk of episodes: fitness and steps of each, and the seconds they took."""
    return _answer(message, _evaluate)


def _answer(message: bytes, function: Callable[[dict], dict]) -> bytes:
    """Errors are answers too: of ours the sentence, of others what they say."""
    try:
        with _one_at_a_time:
            request = wire.unpack(message)
            for name, data in request["tables"].items():
                _tables[name] = wire.table(data)
            lacking = [name for name in request["needs"] if name not in _tables]
            if lacking:
                return wire.pack({"lacks": lacking})
            for name in request["needs"]:
                _tables.move_to_end(name)
            answer = function(request)
            while len(_tables) > TABLES:
                _tables.popitem(last=False)
            return wire.pack(answer)
    except BotschoolError as error:
        return wire.pack({"sentence": str(error)})
    except (Exception, SystemExit) as error:
        return wire.pack({"failure": " ".join(f"{type(error).__name__}: {error}".split())})


def _hello(request: dict) -> dict:
    problem, policy = _experiment(request["experiment"])
    return {"version": __version__, "threads": _threads(), "bits": bits(problem, policy)}


def bits(problem: Problem, policy: Policy) -> bytes:
    """A digest of what this machine computes: the beginning of two episodes, and normal numbers.

    Machines with other digests would give other results.
    """
    genotypes = np.array([policy.initial(PROBE, index) for index in range(2)])
    seeds = np.full(2, PROBE, dtype=np.uint64)
    numbers = np.arange(2)
    episodes = Episodes(numbers.astype(np.int32), seeds, numbers.astype(np.uint32))
    normalisation = np.repeat([0.0, 1.0], policy.spec.inputs) if policy.spec.normalize else None
    outcome = problem.evaluate(policy, genotypes, normalisation, episodes, PROBED)
    normal = generator(PROBE, 0).standard_normal(100_000)
    return wire.digest(b"".join(a.tobytes() for a in (outcome.fitness, outcome.steps, normal)))


def _evaluate(request: dict) -> dict:
    problem, policy = _experiment(request["experiment"])
    began = time.perf_counter()
    genotypes = np.concatenate([_rows(part) for part in request["parts"]])
    normalisation = request["normalisation"]
    normalisation = None if normalisation is None else _tables[normalisation]
    candidate, collect = request["candidate"], request["collect"]
    episodes = Episodes(candidate, request["seed"], request["episode"], collect)
    outcome = problem.evaluate(
        policy, genotypes, normalisation, episodes, request["maxsteps"], _threads()
    )
    return {
        "fitness": outcome.fitness,
        "steps": outcome.steps,
        "moments": outcome.moments if collect is not None else None,
        "seconds": time.perf_counter() - began,
    }


def _rows(part: dict) -> np.ndarray:
    """The genotypes of a part: rows of a table, all of it, or as they were sent."""
    if "rows" not in part:
        return part["sent"].astype(np.float64)
    table, rows = _tables[part["table"]], part["rows"]
    if isinstance(table, np.ndarray):
        return (table if rows is None else table[rows]).astype(np.float64)
    return table.rows(np.arange(len(table)) if rows is None else rows)


def _experiment(name: bytes) -> tuple[Problem, Policy]:
    """Problem and policy of an experiment that has been sent."""
    if name not in _made:
        experiment = config.from_dict(_tables[name])
        problem = problems.of(experiment)
        if not problem.native:
            _may_have_children(problem)
        _made[name] = problem, Policy(problem.name, problem.interface, experiment.policy)
    return _made[name]


def _threads() -> int:
    """Threads that this worker may use."""
    from distributed import get_worker

    return get_worker().state.nthreads


def _may_have_children(problem: Problem) -> None:
    """Episodes in Python have a process for each thread; Dask starts workers as daemons, which may
    have none. The problem's end with their parent: they watch it, and it ends them."""
    multiprocessing.current_process()._config["daemon"] = False
    Finalize(None, problem.close, exitpriority=10)
