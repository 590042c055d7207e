"""Which hyperparameters matter, and on which problem?"""

from __future__ import annotations

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Data, Figure, Judged, Lab, Statement
from botschool.labs.judging import CANNOT_TELL, FRESH, RETURN, mean_over, near, one_of
from botschool.labs.measuring import Run, permutation_test, play_again


def reference(run: Run, answers: Answers) -> dict[str, float]:
    """Return reported fitness; mean and standard deviation of returns in 100 new episodes."""
    returns = play_again(run, seed=1, episodes=100)
    return {
        "reported": float(np.asarray(run["stat"])[-1, 2]),
        "fresh": float(returns.mean()),
        "spread": float(returns.std(ddof=1)),
    }


PROBLEMS = {"Acrobot": ("Acrobot-v1", 500, 1, 0.05), "Pendulum": ("Pendulum-v1", 200, 2, 0.1)}
"""Environment, steps of an episode, million steps of a run, noiseStdDev."""
CHANGES = {
    "nhiddens": 40,
    "episodes": 8,
    "samplesize": 5,
    "stepsize": 0.3,
    "noiseStdDev": 0.02,
    "wdecay": 1,
}
NAMES = ("base", *CHANGES)
LEVEL, NEAR = 0.05 / len(CHANGES), (0.005, 0.0125)
"""p below LEVEL counts with six tests; within NEAR either answer is right."""


def condition(problem: str, change: str) -> Condition:
    """Return a condition: ten runs with one hyperparameter changed."""
    environment, steps, msteps, noise = PROBLEMS[problem]
    made = Condition.of(
        f"{problem} {change}",
        environment,
        f"episodes=2, pepisodes=5, maxsteps={steps}, nhiddens=10, bias=1, afunction=2",
        f"maxmsteps={msteps}, samplesize=20, stepsize=0.05, noiseStdDev={noise}, wdecay=0",
    )
    for section in made.experiment.values():
        if change in section:
            section[change] = CHANGES[change]
    return made


def tests(data: Data, problem: str) -> dict[str, float]:
    """Return the p of each change against the base."""
    base = data[f"{problem} base"]["fresh"]
    return {name: permutation_test(data[f"{problem} {name}"]["fresh"], base) for name in CHANGES}


def strongest(points: int, conditions: tuple[str, ...]) -> Statement:
    """Ask which change has the smallest p, if that is small enough for six tests."""

    def judge(data: Data, answers: Answers) -> Judged:
        p = tests(data, conditions[0].split()[0])
        least = min(p.values())
        winners = {name for name, value in p.items() if value <= 1.5 * least + 5e-4}
        right = winners if least < LEVEL else {CANNOT_TELL}
        if NEAR[0] < least < NEAR[1]:
            right = winners | {CANNOT_TELL}
        told = f"look for the smallest of the six p; it must be below {LEVEL:.4f} to count."
        return one_of(right, told)

    return Statement(points, conditions, judge)


def count(data: Data, answers: Answers) -> Judged:
    """Judge how many changes matter on Pendulum."""
    p = list(tests(data, "Pendulum").values())
    low, high = (sum(value < level for value in p) for level in NEAR)
    return lambda answer: low <= answer <= high, f"count which of your six p are below {LEVEL:.4f}."


def episodes(data: Data, answers: Answers) -> Judged:
    """Judge how many episodes it takes to rank ten robots."""
    runs = data["Pendulum base"]
    apart = max(float(runs["fresh"].std(ddof=1)), 1e-9)
    found = (4 * float(runs["spread"].mean()) / apart) ** 2
    told = "it is (4 x mean spread / standard deviation of fresh) squared, of the base's ten runs."
    return near(found, 1.5, 0.05, told)


CONDITIONS = tuple(condition(problem, change) for problem in PROBLEMS for change in NAMES)
ACROBOT, PENDULUM = (tuple(f"{problem} {name}" for name in NAMES) for problem in PROBLEMS)
LAB = Lab(
    number=4,
    conditions=CONDITIONS,
    statements={
        "acrobot": strongest(6, ACROBOT),
        "pendulum": strongest(6, PENDULUM),
        "count": Statement(4, PENDULUM, count),
        "luck": mean_over(4, ACROBOT, "reported - fresh", 0.2, "all your Acrobot runs"),
        "episodes": Statement(5, PENDULUM[:1], episodes),
    },
    measures={"reported": 1e-6, "fresh": 1e-3, "spread": 1e-3},
    reference=reference,
    unseen=(CONDITIONS[1], CONDITIONS[-1]),
    columns=(*FRESH, Column(np.mean, "reported - fresh", 0.2, 0.01)),
    figure=Figure("fresh", PENDULUM, RETURN),
    rubric=(
        "The reason of the prediction says what one of the hyperparameters does.",
        "The student says why six tests need a stricter limit than one.",
        "What surprised the student is a fact of the runs, with its number.",
    ),
    shown=("Acrobot base", "Pendulum base"),
    redone=10,
)
