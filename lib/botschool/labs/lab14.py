"""Evolution or policy gradient: when which?"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Data, Field, Figure, Lab, Statement
from botschool.labs.judging import CANNOT_TELL, LEVEL, NEAR, Judged, larger, p_value
from botschool.labs.measuring import permutation_test, play_again, seconds_per_million

GOALS = {"dense": -200.0, "sparse": 90.0, "long": 1000.0}


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Return the steps until the goal, whether it is reached, and the return in new episodes."""
    stat = np.asarray(run["stat"])
    reached = stat[:, 2] >= GOALS[run["condition"].split()[0]]
    return {
        "steps": float(stat[reached.argmax() if reached.any() else -1, 0]),
        "reached": float(reached.any()),
        "fresh": float(np.mean(play_again(run, seed=2, episodes=20))),
    }


PROBLEMS: dict[str, dict[str, Any]] = {
    "dense": {"environment": "Pendulum-v1", "maxsteps": 200, "steps": {"ES": 6, "PPO": 0.15}},
    "sparse": {
        "environment": "MountainCarContinuous-v0",
        "maxsteps": 999,
        "steps": {"ES": 0.3, "PPO": 0.3},
    },
    "long": {"environment": "PlanarHopper-v5", "maxsteps": 1000, "steps": {"ES": 1, "PPO": 1}},
}
ES = {
    "dense": {"stepsize": 0.1, "noiseStdDev": 0.1, "wdecay": 0},
    "sparse": {"stepsize": 0.03, "noiseStdDev": 0.3, "wdecay": 0},
    "long": {"stepsize": 0.03, "noiseStdDev": 0.05, "wdecay": 0},
}
PPO: dict[str, dict[str, Any]] = {
    "dense": {"n_envs": 16, "n_steps": 128, "batch_size": 128, "gamma": 0.95},
    "sparse": {"n_envs": 8, "n_steps": 512, "batch_size": 128, "gamma": 0.99},
    "long": {"n_envs": 32, "n_steps": 256, "batch_size": 256, "gamma": 0.999, "n_epochs": 5},
}
RATES = {"dense": 0.001, "sparse": 0.0003, "long": 0.0006}
METHODS = ("evolution", "gradient")


def evolution(problem: str) -> Condition:
    """Return a condition: OpenAI-ES with a small network."""
    told = PROBLEMS[problem]
    return Condition(
        f"{problem} evolution",
        {
            "exp": {"environment": told["environment"], "algo": "OpenAI-ES"},
            "policy": {
                "episodes": 1,
                "pepisodes": 20,
                "maxsteps": told["maxsteps"],
                "nhiddens": 20 if problem == "long" else 10,
                "bias": 1,
                "afunction": 2,
                "out_type": 3,
                "winit": 1,
                "normalize": 1,
                "clip": 1,
            },
            "algo": {"maxmsteps": told["steps"]["ES"], "samplesize": 20} | ES[problem],
        },
        x=2.0 * list(PROBLEMS).index(problem),
    )


def gradient(problem: str) -> Condition:
    """Return a condition: PPO with two layers of 64 neurons."""
    told = PROBLEMS[problem]
    name = told["environment"]
    settings = PPO[problem] | {"learning_rate": RATES[problem], "normalize": True}
    settings |= {"log_std_init": -0.5} if problem == "long" else {}
    return Condition(
        f"{problem} gradient",
        {
            "exp": {
                "environment": f"botschool/{name}" if name.startswith("Planar") else name,
                "algo": "PPO",
            },
            "policy": {"pepisodes": 20},
            "algo": {"maxmsteps": told["steps"]["PPO"]},
            "ppo": settings,
        },
        x=2.0 * list(PROBLEMS).index(problem) + 1,
        kind="training",
    )


def verdicts(one: np.ndarray, other: np.ndarray) -> set[str]:
    """Return the right answers on which method needs less; one: evolution's numbers."""
    p = permutation_test(one, other)
    winner = METHODS[int(one.mean() > other.mean())]
    if NEAR[0] < p < NEAR[1]:
        return {winner, CANNOT_TELL}
    return {winner} if p < LEVEL else {CANNOT_TELL}


def speeds(answers: Answers) -> tuple[dict[str, float], list[str]] | None:
    """Return the seconds for a million steps by condition, and sentences on implausible ones.

    Only students can measure their own machines. A number above ten times the checker's own, or
    below a tenth of it, is replaced by the checker's. None if some are missing.
    """
    used, wrong = {}, []
    for name in ALL:
        value = answers.get(f"seconds-{name.replace(' ', '-')}")
        if value is None:
            return None
        here = _here(name)
        plausible = here / 10 <= value <= here * 10
        used[name] = value if plausible else here
        if not plausible:
            wrong.append(f"{name}: {value:g} is more than ten times off")
    return used, wrong


@cache
def _here(name: str) -> float:
    return seconds_per_million(14, name)


def changes(data: Data, answers: Answers) -> Judged:
    """Judge on how many problems the seconds give another answer than the steps."""
    told = speeds(answers)
    if told is None:
        return lambda answer: False, "write all six seconds first."
    seconds_of, _ = told
    possible = {0}
    for problem in PROBLEMS:
        names = [f"{problem} {method}" for method in METHODS]
        one, other = (data[name]["steps"] for name in names)
        steps = verdicts(one, other)
        seconds = verdicts(one * seconds_of[names[0]], other * seconds_of[names[1]])
        here = {int(a != b) for a in steps for b in seconds}
        possible = {count + each for count in possible for each in here}
    return lambda answer: answer in possible, "test steps and seconds of each problem again."


def timed(data: Data, answers: Answers) -> Judged:
    """Judge whether the seconds are plausible for a machine."""
    told = speeds(answers)
    if told is None:
        return lambda answer: False, "write all six seconds first."
    _, wrong = told
    return lambda answer: not wrong, f"{'; '.join(wrong)}."


def needs(problem: str) -> tuple[str, ...]:
    """Return the two conditions of a problem."""
    return tuple(f"{problem} {method}" for method in METHODS)


def fewer(problem: str) -> Statement:
    """Return the statement on which method needs fewer steps."""
    evolved, trained = needs(problem)
    return Statement(
        problem, 4, (evolved, trained), larger("steps", trained, evolved, METHODS)
    )  # the method that does not need more


CONDITIONS = tuple(make(problem) for problem in PROBLEMS for make in (evolution, gradient))
ALL = tuple(condition.name for condition in CONDITIONS)
SECONDS = tuple(
    Field(f"seconds-{p}-{m}", "number", f"The seconds of {p} {m}", 0, 10_000)
    for p in PROBLEMS
    for m in METHODS
)
LAB = Lab(
    number=14,
    title="Evolution or policy gradient: when which?",
    conditions=CONDITIONS,
    predictions=(
        *(
            Field(f"predicted-{problem}", "choice", f"Which needs fewer steps, {problem}")
            for problem in PROBLEMS
        ),
        Field("predicted-changes", "number", "How many answers change with seconds", 0, 3),
        Field("why", "text", "Why you predict this", words=10),
    ),
    fields=(
        *(Field(each, "choice", f"Which needs fewer steps, {each}") for each in PROBLEMS),
        Field("p", "number", "The p of the permutation test", 0, 1),
        *SECONDS,
        Field("changes", "number", "How many answers change with seconds", 0, 3),
    ),
    measures={"steps": 1e-6, "reached": 1e-6, "fresh": 1e-3},
    reference=reference,
    unseen=(evolution("dense"), gradient("dense")),
    columns=(
        Column("reached", lambda values: (float(values["reached"].sum()),), lambda true: 0.01),
        Column(
            "median steps (thousands)",
            lambda values: (float(np.median(values["steps"])) / 1000,),
            lambda true: 0.6 + 0.002 * true[0],
        ),
        Column(
            "median return in new episodes",
            lambda values: (float(np.median(values["fresh"])),),
            lambda true: 0.6 + 0.002 * abs(true[0]),
        ),
    ),
    statements=(
        *(fewer(problem) for problem in PROBLEMS),
        Statement("p", 3, needs("long"), p_value("steps", *needs("long"))),
        Statement("seconds-dense-evolution", 4, needs("dense"), timed),
        Statement("changes", 6, ALL, changes),
    ),
    figure=Figure("steps", ALL, ("step",)),
    rubric=(
        "The reason of the prediction says what each method learns from: whole episodes, or steps.",
        "The advice names the problem's rewards, its length, and what a step costs.",
        "The student says what the three problems and these settings cannot show.",
    ),
    robot="runs",
    shown=("sparse evolution", "long evolution"),
    best=lambda values: values["fresh"],
    redone=8,
)  # fmt: skip
