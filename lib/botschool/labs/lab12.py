"""Which elite share learns fastest, and does REINFORCE need fewer episodes?"""

from __future__ import annotations

from typing import Any

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Data, Figure, Judged, Lab, Statement
from botschool.labs.judging import larger, near, p_value
from botschool.labs.measuring import Run, interval

SOLVED = 195.0


def reference(run: Run, answers: Answers) -> dict[str, float]:
    """Return the episodes until an iteration is solved on average, and whether one is."""
    stat = np.asarray(run["stat"])
    solved = stat[:, 3] >= SOLVED
    at = solved.argmax() if solved.any() else -1
    return {"episodes": float(stat[at, 5]), "solved": float(solved.any())}


PPO = (
    "n_envs=8, n_steps=512, batch_size=4096, n_epochs=4, gamma=0.98, gae_lambda=1.0, "
    "clip_range=None, learning_rate=0.01, normalize_advantage=False, vf_coef=0.0, net_arch=[32]"
)
LEARNERS: dict[str, list[Any]] = {
    "elite 50": ["elite_weights", 50],
    "elite 70": ["elite_weights", 70],
    "elite 90": ["elite_weights", 90],
    "reinforce": ["reinforce_weights", 0.98],
}


def condition(name: str, learner: list[Any] | None) -> Condition:
    """Return a condition: CartPole with at most 200 steps; learner None: a plain gradient."""
    more = {"learner": learner} if learner else {}
    return Condition.trained(name, "CartPole-v0", 0.3, PPO, **more)


def solved(data: Data, answers: Answers) -> Judged:
    """Judge how many of all trainings solve the problem."""
    found = sum(float(values["solved"].sum()) for values in data.values())
    return near(found, 0.01, 0, "add up the column of the solved.")


ALL = tuple(LEARNERS)
ELITES, RULES = ("elite 50", "elite 90"), ("elite 70", "reinforce")
FEWER_ELITE, FEWER = ("percentile 90", "percentile 50"), ("REINFORCE", "cross-entropy")
LAB = Lab(
    number=12,
    conditions=tuple(condition(*each) for each in LEARNERS.items()),
    statements={
        "elite": larger(7, "episodes", ELITES, FEWER_ELITE),
        "p-elite": p_value(4, "episodes", ELITES),
        "reinforce": larger(7, "episodes", RULES, FEWER),
        "p-reinforce": p_value(4, "episodes", RULES),
        "all-solved": Statement(3, ALL, solved),
    },
    measures={"episodes": 1e-6, "solved": 1e-6},
    reference=reference,
    unseen=(condition("elite 70", None), condition("reinforce", None)),
    columns=(
        Column(np.sum, "solved", 0.01),
        Column(np.median, "episodes", 0.6),
        Column(interval, "episodes", 1),
    ),
    figure=Figure("episodes", ALL, ("episode",)),
    rubric=(
        "The reason of the prediction says what a small and what a large elite costs.",
        "What surprised the student is a fact of the runs, with its number.",
        "The student says for which other problems or settings the result may not hold.",
    ),
    shown=(),
    redone=40,
)
