"""Define the functions that Dask calls on workers.

Both are pure: every worker that has this machine's files gives the same answer, so whatever is lost
is asked again.
"""

from __future__ import annotations

import json
import multiprocessing
import threading
import time
from functools import cache
from hashlib import blake2b
from multiprocessing.util import Finalize
from typing import Any

import numpy as np
from distributed import get_worker

from botschool import __version__, config, problems
from botschool.cluster import files
from botschool.config import Experiment
from botschool.errors import BotschoolError
from botschool.policies.policy import Policy
from botschool.problems import Episodes, Outcome, Problem
from botschool.seeds import generator

PROBE = 987_654_321
PROBED = 20
"""Steps of each episode of a probe."""

_one_at_a_time = threading.Lock()  # each evaluation uses all threads of the worker


def hello(asked: dict[str, Any]) -> dict[str, Any]:
    """Return what this worker is: its version, its files that differ from those asked for, and the
    bits of a probe of the experiment.

    Question and answer are dicts, because a worker of another version must understand them, too.
    """
    with _one_at_a_time:
        _made(asked["experiment"])
        differs = files.differing(asked["files"])
        same = b"" if differs else bits(config.from_dict(json.loads(asked["experiment"])))
    return {"version": __version__, "differs": differs, "bits": same}


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
    data = b"".join(array.tobytes() for array in (outcome.fitness, outcome.steps, normal))
    return blake2b(data, digest_size=12).digest()


def evaluate(
    experiment: str,
    genotypes: np.ndarray,
    normalisation: np.ndarray | None,
    episodes: Episodes,
    maxsteps: int,
) -> tuple[Outcome | BotschoolError, float]:
    """Evaluate a chunk of an experiment's episodes; return its outcome, or the environment's error,
    and the seconds it took.
    """
    with _one_at_a_time:
        began = time.perf_counter()
        problem, policy = _made(experiment)
        genotypes = genotypes.astype(np.float64)
        threads = get_worker().state.nthreads
        try:
            outcome: Outcome | BotschoolError = problem.evaluate(
                policy, genotypes, normalisation, episodes, maxsteps, threads
            )
        except BotschoolError as error:
            outcome = error
        except SystemExit as error:  # it would end the worker
            raise RuntimeError(f"SystemExit: {error}") from None
        return outcome, time.perf_counter() - began


@cache
def _made(experiment: str) -> tuple[Problem, Policy]:
    """Return the problem and the policy of an experiment in JSON."""
    found = config.from_dict(json.loads(experiment))
    problem = problems.of(found)
    if not problem.native:
        _may_have_children(problem)
    return problem, problem.policy(found.policy)


def _may_have_children(problem: Problem) -> None:
    """Allow child processes.

    Dask starts workers as daemons, which may have none, but episodes in Python use a process per
    thread. These processes end with the worker, because they watch it.
    """
    process: Any = multiprocessing.current_process()
    process._config["daemon"] = False
    Finalize(None, problem.close, exitpriority=10)
