"""Define the functions that Dask calls on workers. They take bytes and return bytes.

A worker process keeps what it received: the experiment, from which it makes the problem and the
policy, and tables (centres, populations) by their digests. It asks for tables that it lacks.
"""

from __future__ import annotations

import multiprocessing
import threading
import time
from collections.abc import Callable
from multiprocessing.util import Finalize
from typing import Any

import numpy as np

from botschool import __version__, config, problems
from botschool.cluster import files, wire
from botschool.cluster.members import SPACE, Shelf
from botschool.config import Experiment
from botschool.errors import BotschoolError
from botschool.evolution.algorithms.ascent import Ascent
from botschool.evolution.algorithms.drawing import Cloud
from botschool.policies.policy import Policy
from botschool.problems import Episodes, Problem
from botschool.seeds import generator

PROBE = 987_654_321
PROBED = 20
"""Steps of each episode of a probe."""

_one_at_a_time = threading.Lock()  # each evaluation uses all threads of the worker
_tables: dict[bytes, Any] = {}
_shelf = Shelf(SPACE)
_ascents: dict[bytes, tuple[tuple[bytes, ...], Ascent, Cloud]] = {}
"""The newest ascent: its start, the names of the fitness values it was told, and its cloud."""
_made: dict[bytes, tuple[Problem, Policy]] = {}


def hello(message: bytes) -> bytes:
    """Return what this worker is.

    That is its version, its threads, its files that differ from the request's, and the bits of a
    probe of the experiment.
    """
    return _answer(message, _hello)


def evaluate(message: bytes) -> bytes:
    """Evaluate a chunk of episodes; return fitness and steps of each, and the seconds it took."""
    return _answer(message, _evaluate)


def _answer(message: bytes, function: Callable[[dict], dict]) -> bytes:
    """Return the function's result, our sentence or another error's text as an answer."""
    try:
        with _one_at_a_time:
            request = wire.unpack(message)
            for name, data in request["tables"].items():
                _tables[name] = wire.table(data)
                _shelf.put(name, len(data))
            if not all(isinstance(name, bytes) for name in request["needs"]):
                raise ValueError("the name of a table is not bytes")
            lacking = [name for name in request["needs"] if name not in _tables]
            if lacking:
                return wire.pack({"lacks": lacking})
            _shelf.use(request["needs"])
            answer = function(request)
            for name in _shelf.trim():
                del _tables[name]
            return wire.pack(answer)
    except BotschoolError as error:
        return wire.pack({"sentence": str(error)})
    except (Exception, SystemExit) as error:
        return wire.pack({"failure": " ".join(f"{type(error).__name__}: {error}".split())})


def _hello(request: dict) -> dict:
    _experiment(request["experiment"])
    experiment = config.from_dict(_tables[request["experiment"]])
    differs = files.differing(request["files"])
    same = b"" if differs else bits(experiment)
    return {"version": __version__, "threads": _threads(), "differs": differs, "bits": same}


def bits(experiment: Experiment) -> bytes:
    """Return a digest of what this machine computes: the start of two episodes, and normal numbers.

    Machines with other digests would give other results. The probe has its own environment, because
    after an unfinished episode PyBullet's next one can differ in its last digits.
    """
    problem = problems.of(experiment)
    policy = problem.policy(experiment.policy)
    genotypes = np.array([policy.initial(PROBE, index) for index in range(2)])
    seeds = np.full(2, PROBE, dtype=np.uint64)
    numbers = np.arange(2)
    episodes = Episodes(numbers.astype(np.int32), seeds, numbers.astype(np.uint32))
    normalisation = None
    if policy.config.normalize:
        normalisation = np.repeat([0.0, 1.0], problem.interface.observations)
    outcome = problem.evaluate(policy, genotypes, normalisation, episodes, PROBED)
    normal = generator(PROBE, 0).standard_normal(100_000)
    return wire.digest(b"".join(a.tobytes() for a in (outcome.fitness, outcome.steps, normal)))


def _evaluate(request: dict) -> dict:
    problem, policy = _experiment(request["experiment"])
    began = time.perf_counter()
    parts = [_rows(part) for part in request["parts"]]
    genotypes = parts[0] if len(parts) == 1 else np.concatenate(parts)
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
    """Return the genotypes of a part: sent directly, sent as tables, or drawn again."""
    if "sent" in part:
        return part["sent"].astype(np.float64)
    if "each" in part:
        return np.array([_tables[name] for name in part["each"]], dtype=np.float64)
    return _cloud(part["table"], tuple(part["told"])).rows(part["rows"])


def _cloud(name: bytes, told: tuple[bytes, ...]) -> Cloud:
    """Return a recipe's cloud: a table, or an ascent's cloud after these fitness values."""
    if isinstance(_tables[name], Cloud):
        return _tables[name]
    known, ascent, cloud = _ascents.get(name, (None, None, None))
    if known == told:
        return cloud
    if known is None or told[: len(known)] != known:
        known, ascent = (), Ascent(_tables[name])
    for fitness in told[len(known) :]:
        ascent.offspring()
        ascent.climb(_tables[fitness])
    _ascents.clear()
    _ascents[name] = told, ascent, ascent.cloud()
    return _ascents[name][2]


def _experiment(name: bytes) -> tuple[Problem, Policy]:
    """Return the problem and the policy of an experiment received before."""
    if name not in _made:
        experiment = config.from_dict(_tables[name])
        problem = problems.of(experiment)
        if not problem.native:
            _may_have_children(problem)
        _made[name] = problem, problem.policy(experiment.policy)
    return _made[name]


def _threads() -> int:
    """Return the number of threads that this worker may use."""
    from distributed import get_worker

    return get_worker().state.nthreads


def _may_have_children(problem: Problem) -> None:
    """Allow child processes.

    Dask starts workers as daemons, which may have none, but episodes in Python use a process per
    thread. These processes end with the worker, because they watch it.
    """
    process: Any = multiprocessing.current_process()
    process._config["daemon"] = False
    Finalize(None, problem.close, exitpriority=10)
