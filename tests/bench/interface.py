"""What `botschool.problem(...).evaluate` adds to the engine's own call.

python tests/bench/interface.py [REPETITIONS]    prints the table alone
"""

from __future__ import annotations

import sys
import time

import numpy as np
from report import Table, rate, verdict

import botschool
from botschool.problems import Episodes

PROBLEMS = ("CartPole-v1", "Acrobot-v1", "Pendulum-v1", "PlanarHopper-v5")
BATCHES = (100, 1000)
MOST = 1.03
MAXSTEPS = 200


def interface(repetitions: int) -> Table:
    """Both calls take turns on random genotypes; the shortest of each counts."""
    table = Table(
        f"`problem.evaluate` beside the engine's own call; target: at most {MOST:.2f} of its time",
        f"Random genotypes, an episode of at most {MAXSTEPS} steps each, one core; the shortest of "
        f"{repetitions} calls that take turns.",
        ["problem", "genotypes", "steps", "steps/s", "ratio", "added, in µs", ""],
    )
    for name in PROBLEMS:
        problem = botschool.problem(name, hidden=32, maxsteps=MAXSTEPS)
        for batch in BATCHES:
            steps, engine, ours = times(problem, batch, repetitions)
            ratio = ours / engine
            table.add(
                *(name, f"{batch}", f"{steps:,}", rate(steps / ours), f"{ratio:.3f}"),
                *(f"{1e6 * (ours - engine):.1f}", verdict(ratio <= MOST)),
            )
    return table


def times(problem, batch: int, repetitions: int) -> tuple[int, float, float]:
    """Return the steps of a call, and the shortest seconds of the engine's call and of ours."""
    genotypes = np.stack([problem.initial(1, i) for i in range(batch)])
    own, policy = problem._problem, problem._policy
    episodes = Episodes.of(np.full(batch, 7), 1)
    call, limit = own.engine(policy).evaluate, own.steps(MAXSTEPS)
    given = (episodes.candidate[None], episodes.seed, episodes.episode, None, limit, 1, False)
    best = [np.inf, np.inf]
    for _ in range(repetitions):
        for side, function in enumerate((
            lambda: call(genotypes, None, *given, own._options),
            lambda: problem.evaluate(genotypes, 7, workers=1),
        )):  # fmt: skip
            began = time.perf_counter()
            _, steps, *_ = function()
            best[side] = min(best[side], time.perf_counter() - began)
    return int(steps.sum()), *best


if __name__ == "__main__":
    interface(int(sys.argv[1]) if len(sys.argv) > 1 else 300).show(markdown=True)
