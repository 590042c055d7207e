"""At equal numbers of evaluations: larger populations or more generations?"""

from __future__ import annotations

from typing import Any

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Data, Field, Figure, Lab, Statement
from botschool.labs.judging import FRESH, Judged, larger, p_value
from botschool.labs.measuring import play_again

SOLVED = 475.0
"""CartPole: mean of 20 new episodes."""


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Return reported and new fitness, evaluations until solved, and whether it is solved."""
    size = run["experiment"]["algo"]["popsize"]
    reported = np.asarray(run["stat"])[:, 2]
    solved = reported >= SOLVED
    generations = int(solved.argmax()) + 1 if solved.any() else len(solved)
    return {
        "reported": float(reported[-1]),
        "fresh": float(np.mean(play_again(run, seed=1, episodes=100))),
        "evaluations": float(size * generations),
        "solved": float(solved.any()),
    }


SIZES = (4, 20, 100)
MUTRATE = 0.4
"""For both problems: 0.1 is too small for Pendulum, and no size of population makes up for it."""
PROBLEMS = {
    "CartPole": {"environment": "CartPole-v1", "maxsteps": 500, "evaluations": 600},
    "Pendulum": {"environment": "Pendulum-v1", "maxsteps": 200, "evaluations": 4000},
}


def condition(problem: str, size: int) -> Condition:
    """Return a condition: SSS with this population, and equally many evaluations for all."""
    told: dict[str, Any] = PROBLEMS[problem]
    return Condition(
        f"{problem} {size}",
        {
            "exp": {"environment": told["environment"], "algo": "SSS"},
            "policy": {
                "episodes": 5,
                "pepisodes": 20,
                "maxsteps": told["maxsteps"],
                "nhiddens": 10,
                "bias": 1,
                "afunction": 2,
                "out_type": 3,
                "winit": 0,
            },
            "algo": {"maxmsteps": 100, "popsize": size, "mutrate": MUTRATE},
        },
        generations=told["evaluations"] // size,
        x=size,
    )


def lost(problem: str) -> Any:
    """Judge how much of the reported fitness is luck, as a mean over the runs."""

    def judge(data: Data, answers: Answers) -> Judged:
        each = [
            data[f"{problem} {size}"]["reported"] - data[f"{problem} {size}"]["fresh"]
            for size in SIZES
        ]
        found = float(np.concatenate(each).mean())
        told = f"compute the mean of reported - fresh over all your {problem} runs again."
        return lambda answer: abs(answer - found) <= 0.5 + 0.02 * abs(found), told

    return judge


def is_cartpole(name: str) -> bool:
    """Return whether a condition is one of CartPole's."""
    return name.startswith("CartPole")


def of_cartpole(values: Any) -> tuple[float, ...]:
    """Return the median of the evaluations until solved."""
    return (float(np.median(values["evaluations"])),)


CARTPOLE = tuple(f"CartPole {size}" for size in SIZES)
PENDULUM = tuple(f"Pendulum {size}" for size in SIZES)
SMALL_LARGE = ("100 individuals", "4 individuals")
LAB = Lab(
    number=3,
    title="At equal numbers of evaluations: larger populations or more generations?",
    conditions=tuple(condition(problem, size) for problem in PROBLEMS for size in SIZES),
    predictions=(
        Field("best-cartpole", "choice", "Which population solves CartPole first"),
        Field("best-pendulum", "choice", "Which population is best on Pendulum"),
        Field("fresh-20", "number", "The fitness on Pendulum in new episodes", -2000, 0),
        Field("why", "text", "Why you predict this", words=10),
    ),
    fields=(
        Field("cartpole", "choice", "CartPole, 4 against 100 individuals"),
        Field("p-cartpole", "number", "CartPole, p of the permutation test", 0, 1),
        Field("pendulum", "choice", "Pendulum, 4 against 100 individuals"),
        Field("p-pendulum", "number", "Pendulum, p of the permutation test", 0, 1),
        Field("lost", "number", "What luck adds on Pendulum", -1000, 1000),
    ),
    measures={"reported": 1e-6, "fresh": 1e-3, "evaluations": 1e-6, "solved": 1e-6},
    reference=reference,
    unseen=(condition("CartPole", 20), condition("Pendulum", 100)),
    columns=(
        Column(
            "solved of ten",
            lambda values: (float(values["solved"].sum()),),
            lambda true: 0.01,
            is_cartpole,
        ),
        Column("median evaluations until solved", of_cartpole, lambda true: 0.6, is_cartpole),
        *FRESH,
    ),
    statements=(
        Statement(
            "cartpole",
            6,
            (CARTPOLE[0], CARTPOLE[-1]),
            larger("evaluations", CARTPOLE[-1], CARTPOLE[0], SMALL_LARGE[::-1]),
        ),
        Statement(
            "p-cartpole",
            4,
            (CARTPOLE[0], CARTPOLE[-1]),
            p_value("evaluations", CARTPOLE[0], CARTPOLE[-1]),
        ),
        Statement(
            "pendulum",
            6,
            (PENDULUM[0], PENDULUM[-1]),
            larger("fresh", PENDULUM[-1], PENDULUM[0], SMALL_LARGE),
        ),
        Statement(
            "p-pendulum",
            4,
            (PENDULUM[0], PENDULUM[-1]),
            p_value("fresh", PENDULUM[0], PENDULUM[-1]),
        ),
        Statement("lost", 5, PENDULUM, lost("Pendulum")),
    ),
    figure=Figure("fresh", PENDULUM, ("return", "fitness", "reward")),
    rubric=(
        "The reason of the prediction says what a population and what generations are good for.",
        "What surprised the student is a fact of the runs, with its number.",
        "The student says for which other problems the result may not hold.",
    ),
    robot="evolutions",
    shown=(PENDULUM[0], PENDULUM[-1]),
    best=lambda values: values["fresh"],
    redone=12,
)
