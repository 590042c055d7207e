"""Which elite share learns fastest, and does REINFORCE need fewer episodes?"""

from __future__ import annotations

from typing import Any

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Data, Field, Figure, Lab, Statement
from botschool.labs.judging import Judged, larger, p_value
from botschool.labs.measuring import interval

SOLVED = 195.0


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Return the episodes until an iteration is solved on average, and whether one is."""
    stat = np.asarray(run["stat"])
    solved = stat[:, 3] >= SOLVED
    at = solved.argmax() if solved.any() else -1
    return {"episodes": float(stat[at, 5]), "solved": float(solved.any())}


LEARNERS: dict[str, list[Any]] = {
    "elite 50": ["elite_weights", 50],
    "elite 70": ["elite_weights", 70],
    "elite 90": ["elite_weights", 90],
    "reinforce": ["reinforce_weights", 0.98],
}


def condition(name: str, learner: list[Any] | None) -> Condition:
    """Return a condition: CartPole with at most 200 steps; learner None: a plain gradient."""
    experiment: dict[str, Any] = {
        "exp": {"environment": "CartPole-v0", "algo": "PPO"},
        "policy": {"pepisodes": 20},
        "algo": {"maxmsteps": 0.3},
        "ppo": {
            "n_envs": 8,
            "n_steps": 512,
            "batch_size": 4096,
            "n_epochs": 4,
            "gamma": 0.98,
            "gae_lambda": 1.0,
            "clip_range": None,
            "learning_rate": 0.01,
            "normalize_advantage": False,
            "vf_coef": 0.0,
            "net_arch": [32],
        },
    }
    more = {"learner": learner} if learner else {}
    place = float(list(LEARNERS).index(name))
    return Condition(name, experiment | more, x=place, kind="training")


def solved(data: Data, answers: Answers) -> Judged:
    """Judge how many of all trainings solve the problem."""
    found = sum(float(values["solved"].sum()) for values in data.values())
    return lambda answer: abs(answer - found) < 0.01, "add up the column of the solved."


def median(values: Any) -> tuple[float, ...]:
    """Return the median of the episodes."""
    return (float(np.median(values["episodes"])),)


ALL = tuple(LEARNERS)
LAB = Lab(
    number=12,
    title="Which elite share learns fastest, and does REINFORCE need fewer episodes?",
    conditions=tuple(condition(*each) for each in LEARNERS.items()),
    predictions=(
        Field("predicted-elite", "choice", "Which elite learns faster"),
        Field("predicted-reinforce", "choice", "Who needs fewer episodes"),
        Field("predicted-episodes", "number", "The median episodes of elite 70", 1, 100_000),
        Field("why", "text", "Why you predict this", words=10),
    ),
    fields=(
        Field("elite", "choice", "Percentile 50 against 90"),
        Field("p-elite", "number", "The p of 50 against 90", 0, 1),
        Field("reinforce", "choice", "Percentile 70 against REINFORCE"),
        Field("p-reinforce", "number", "The p of 70 against REINFORCE", 0, 1),
        Field("all-solved", "number", "How many trainings solve it", 0, 1000),
    ),
    measures={"episodes": 1e-6, "solved": 1e-6},
    reference=reference,
    unseen=(condition("elite 70", None), condition("reinforce", None)),
    columns=(
        Column("solved", lambda values: (float(values["solved"].sum()),), lambda true: 0.01),
        Column("median episodes", median, lambda true: 0.6),
        Column(
            "95 % interval",
            lambda values: interval(values["episodes"]),
            lambda true: 1 + 0.3 * (true[1] - true[0]),
        ),
    ),
    statements=(
        Statement(
            "elite",
            7,
            ("elite 50", "elite 90"),
            larger("episodes", "elite 90", "elite 50", ("percentile 50", "percentile 90")),
        ),
        Statement(
            "p-elite", 4, ("elite 50", "elite 90"), p_value("episodes", "elite 50", "elite 90")
        ),
        Statement(
            "reinforce",
            7,
            ("elite 70", "reinforce"),
            larger("episodes", "reinforce", "elite 70", ("cross-entropy", "REINFORCE")),
        ),
        Statement(
            "p-reinforce",
            4,
            ("elite 70", "reinforce"),
            p_value("episodes", "elite 70", "reinforce"),
        ),
        Statement("all-solved", 3, ALL, solved),
    ),
    figure=Figure("episodes", ALL, ("episode",)),
    rubric=(
        "The reason of the prediction says what a small and what a large elite costs.",
        "What surprised the student is a fact of the runs, with its number.",
        "The student says for which other problems or settings the result may not hold.",
    ),
    robot="trainings",
    shown=(),
    best=lambda values: -values["episodes"],
    redone=40,
)
