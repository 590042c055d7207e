"""Which hyperparameters matter, and on which problem?"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Data, Field, Figure, Lab, Statement
from botschool.labs.judging import CANNOT_TELL, FRESH, Judged
from botschool.labs.measuring import permutation_test, play_again


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Return reported fitness; mean and standard deviation of returns in 100 new episodes."""
    returns = play_again(run, seed=1, episodes=100)
    return {
        "reported": float(np.asarray(run["stat"])[-1, 2]),
        "fresh": float(returns.mean()),
        "spread": float(returns.std(ddof=1)),
    }


BASE = "base"
PROBLEMS: dict[str, dict[str, Any]] = {
    "Acrobot": {"environment": "Acrobot-v1", "maxsteps": 500, "msteps": 1, "noise": 0.05},
    "Pendulum": {"environment": "Pendulum-v1", "maxsteps": 200, "msteps": 2, "noise": 0.1},
}
CHANGES: dict[str, dict[str, float]] = {
    BASE: {},
    "nhiddens": {"nhiddens": 40},
    "episodes": {"episodes": 8},
    "samplesize": {"samplesize": 5},
    "stepsize": {"stepsize": 0.3},
    "noiseStdDev": {"noiseStdDev": 0.02},
    "wdecay": {"wdecay": 1},
}
SIX = tuple(name for name in CHANGES if name != BASE)
LEVEL, NEAR = 0.05 / len(SIX), (0.005, 0.0125)
"""p below LEVEL counts with six tests; within NEAR either answer is right."""


def condition(problem: str, change: str) -> Condition:
    """Return a condition: ten runs with one hyperparameter changed."""
    told = PROBLEMS[problem]
    policy: dict[str, Any] = {
        "episodes": 2,
        "pepisodes": 5,
        "maxsteps": told["maxsteps"],
        "nhiddens": 10,
        "bias": 1,
        "afunction": 2,
    }
    algo: dict[str, Any] = {
        "maxmsteps": told["msteps"],
        "samplesize": 20,
        "stepsize": 0.05,
        "noiseStdDev": told["noise"],
        "wdecay": 0,
    }
    for key, value in CHANGES[change].items():
        (policy if key in policy else algo)[key] = value
    return Condition(
        f"{problem} {change}",
        {
            "exp": {"environment": told["environment"], "algo": "OpenAI-ES"},
            "policy": policy,
            "algo": algo,
        },
        x=float(list(CHANGES).index(change)),
    )


def tests(data: Data, problem: str) -> dict[str, float]:
    """Return the p of each change against the base."""
    base = data[f"{problem} {BASE}"]["fresh"]
    return {name: permutation_test(data[f"{problem} {name}"]["fresh"], base) for name in SIX}


def strongest(problem: str) -> Callable[[Data, Answers], Judged]:
    """Judge which change has the smallest p, if that is small enough for six tests."""

    def judge(data: Data, answers: Answers) -> Judged:
        p = tests(data, problem)
        least = min(p.values())
        winners = {name for name, value in p.items() if value <= 1.5 * least + 5e-4}
        right = winners if least < LEVEL else {CANNOT_TELL}
        if NEAR[0] < least < NEAR[1]:
            right = winners | {CANNOT_TELL}
        told = f"look for the smallest of the six p; it must be below {LEVEL:.4f} to count."
        return lambda answer: answer in right, told

    return judge


def count(data: Data, answers: Answers) -> Judged:
    """Judge how many changes matter on Pendulum."""
    p = list(tests(data, "Pendulum").values())
    low, high = (sum(value < level for value in p) for level in NEAR)
    return lambda answer: low <= answer <= high, f"count which of your six p are below {LEVEL:.4f}."


def luck(data: Data, answers: Answers) -> Judged:
    """Judge how much of the reported fitness is luck."""
    runs = [data[f"Acrobot {name}"] for name in CHANGES]
    found = float(np.concatenate([each["reported"] - each["fresh"] for each in runs]).mean())
    told = "compute the mean of reported - fresh over all your Acrobot runs again."
    return lambda answer: abs(answer - found) <= 0.2 + 0.02 * abs(found), told


def episodes(data: Data, answers: Answers) -> Judged:
    """Judge how many episodes it takes to rank ten robots."""
    runs = data[f"Pendulum {BASE}"]
    apart = max(float(runs["fresh"].std(ddof=1)), 1e-9)
    found = (4 * float(runs["spread"].mean()) / apart) ** 2
    told = "it is (4 x mean spread / standard deviation of fresh) squared, of the base's ten runs."
    return lambda answer: abs(answer - found) <= 1.5 + 0.05 * found, told


CONDITIONS = tuple(condition(problem, change) for problem in PROBLEMS for change in CHANGES)
ACROBOT = tuple(c.name for c in CONDITIONS if c.name.startswith("Acrobot"))
PENDULUM = tuple(c.name for c in CONDITIONS if c.name.startswith("Pendulum"))
LAB = Lab(
    number=4,
    title="Which hyperparameters matter, and on which problem?",
    conditions=CONDITIONS,
    predictions=(
        Field("first-acrobot", "choice", "What matters most on Acrobot"),
        Field("first-pendulum", "choice", "What matters most on Pendulum"),
        Field("luck-expected", "number", "How much of the reported fitness is luck", -500, 500),
        Field("why", "text", "Why you predict this", words=10),
    ),
    fields=(
        Field("acrobot", "choice", "What matters most on Acrobot"),
        Field("pendulum", "choice", "What matters most on Pendulum"),
        Field("count", "number", "How many matter on Pendulum", 0, 6),
        Field("luck", "number", "What luck adds on Acrobot", -500, 500),
        Field("episodes", "number", "The episodes that ranking takes", 0, 1e9),
    ),
    measures={"reported": 1e-6, "fresh": 1e-3, "spread": 1e-3},
    reference=reference,
    unseen=(CONDITIONS[1], CONDITIONS[-1]),
    columns=(
        *FRESH,
        Column(
            "mean luck",
            lambda values: (float((values["reported"] - values["fresh"]).mean()),),
            lambda true: 0.2 + 0.01 * abs(true[0]),
        ),
    ),
    statements=(
        Statement("acrobot", 6, ACROBOT, strongest("Acrobot")),
        Statement("pendulum", 6, PENDULUM, strongest("Pendulum")),
        Statement("count", 4, PENDULUM, count),
        Statement("luck", 4, ACROBOT, luck),
        Statement("episodes", 5, PENDULUM[:1], episodes),
    ),
    figure=Figure("fresh", PENDULUM, ("return", "fitness", "reward")),
    rubric=(
        "The reason of the prediction says what one of the hyperparameters does.",
        "The student says why six tests need a stricter limit than one.",
        "What surprised the student is a fact of the runs, with its number.",
    ),
    robot="evolutions",
    shown=("Acrobot base", "Pendulum base"),
    best=lambda values: values["fresh"],
    redone=10,
)
