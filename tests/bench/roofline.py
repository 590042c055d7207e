"""How near native evaluation comes to what a core can multiply and add."""

from __future__ import annotations

import os
import subprocess
import sys

from report import Table, rate
from speed import CASES, Batch, rates

from botschool.policies.policy import Policy

_SGEMM = """
import sys, time
import numpy as np
a, b = np.random.default_rng(1).standard_normal((2, 512, 512)).astype(np.float32)
best, end = 0.0, time.process_time() + float(sys.argv[1])
while time.process_time() < end:
    start = time.process_time()
    a @ b
    best = max(best, 512**3 / (time.process_time() - start))
print(best)
"""

_THREADS = (
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "OMP_NUM_THREADS",
    "VECLIB_MAXIMUM_THREADS",
)


def core_multiply_adds(seconds: float) -> float:
    """Multiply-adds a second of one core: numpy's single-precision matrix product, best call.

    It is measured in a process whose linear algebra has one thread.
    """
    one = os.environ | dict.fromkeys(_THREADS, "1")
    command = [sys.executable, "-c", _SGEMM, str(seconds)]
    done = subprocess.run(command, env=one, capture_output=True, text=True, check=True)
    return float(done.stdout)


def multiply_adds(policy: Policy) -> int:
    """Of a step: one for each weight of each robot's network."""
    spec, config = policy.spec, policy.config
    hidden = spec.nhiddens * spec.nlayers
    biases = spec.bias * (hidden + spec.outputs * spec.nbins)
    deviations = spec.outputs if spec.action_noise == 2 else 0
    return config.nrobots * (policy.nparameters - biases - deviations)


def roofline(seconds: float, repetitions: int) -> Table:
    """The networks' multiply-adds a second against the core's."""
    core = core_multiply_adds(4 * seconds)
    table = Table(
        "Roofline: multiply-adds of the networks against what a core can do",
        f"A core's {core / 1e9:.1f} G multiply-adds/s are the best product of two 512 x 512 "
        "single-precision matrices in numpy, in one thread, which fuses multiplying and adding "
        "where the core can. Ours are never fused, so that all machines give the same bits: half "
        "is the most that can be had. Only weights count; activations, sensors and physics come "
        "on top.",
        ["experiment", "multiply-adds / step", "steps/s", "multiply-adds/s", "share of the core"],
    )
    for case in CASES:
        batch = Batch(case.load(), case.episodes)
        fastest = max(rates([batch.evaluate], seconds, repetitions)[0])
        each = multiply_adds(batch.policy)
        share = f"{100 * each * fastest / core:.1f} %"
        table.add(case.file, str(each), rate(fastest), f"{each * fastest / 1e9:.2f} G", share)
    return table
