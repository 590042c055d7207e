"""Which elite share learns fastest, and does REINFORCE need fewer episodes?"""

from __future__ import annotations

from typing import Any

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Data, Figure, Judged, Lab
from botschool.labs.judging import WHY, choice, larger, near, number, p_value
from botschool.labs.measuring import interval
from botschool.wrappers import keywords

SOLVED = 195.0


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Return the episodes until an iteration is solved on average, and whether one is."""
    stat = np.asarray(run["stat"])
    solved = stat[:, 3] >= SOLVED
    at = solved.argmax() if solved.any() else -1
    return {"episodes": float(stat[at, 5]), "solved": float(solved.any())}


PPO = keywords(
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
    place = list(LEARNERS).index(name)
    return Condition.trained(name, "CartPole-v0", 0.3, PPO, place, **more)


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
    predictions=(
        choice("predicted-elite", "Which elite learns faster"),
        choice("predicted-reinforce", "Who needs fewer episodes"),
        number("predicted-episodes", "The median episodes of elite 70", 1, 100_000),
        WHY,
    ),
    fields=(
        larger("elite", "Percentile 50 against 90", 7, "episodes", ELITES, FEWER_ELITE),
        p_value("p-elite", "The p of 50 against 90", 4, "episodes", ELITES),
        larger("reinforce", "Percentile 70 against REINFORCE", 7, "episodes", RULES, FEWER),
        p_value("p-reinforce", "The p of 70 against REINFORCE", 4, "episodes", RULES),
        number("all-solved", "How many trainings solve it", 0, 1000, 3, ALL, solved),
    ),
    measures={"episodes": 1e-6, "solved": 1e-6},
    reference=reference,
    unseen=(condition("elite 70", None), condition("reinforce", None)),
    columns=(
        Column("solved", np.sum, "solved", 0.01),
        Column("median episodes", np.median, "episodes", 0.6),
        Column("95 % interval", interval, "episodes", 1),
    ),
    figure=Figure("episodes", ALL, ("episode",)),
    rubric=(
        "The reason of the prediction says what a small and what a large elite costs.",
        "What surprised the student is a fact of the runs, with its number.",
        "The student says for which other problems or settings the result may not hold.",
    ),
    robot="trainings",
    shown=(),
    redone=40,
)
