"""How long may the steps be?"""

from __future__ import annotations

from typing import Any

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Field, Figure, Lab, Statement
from botschool.labs.judging import FRESH, larger, p_value, powerful
from botschool.labs.measuring import play_again

WIDTH = 20
SEVERE = 0.3


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Return the curve's largest fall, whether it is severe, and the fitness in new episodes."""
    average = np.asarray(run["stat"])[:, 4]
    width = min(WIDTH, len(average))
    curve = np.convolve(average, np.full(width, 1 / width), mode="valid")
    height = curve.max() - curve.min()
    fall = (np.maximum.accumulate(curve) - curve).max()
    drop = float(fall / height) if height > 0 else 0.0
    return {
        "drop": drop,
        "severe": float(drop > SEVERE),
        "fresh": float(np.mean(play_again(run, seed=1, episodes=100))),
    }


STEPS = {"hopper": (0.01, 0.03, 0.1), "Pendulum": (0.02, 0.1, 0.5)}
PROBLEMS: dict[str, dict[str, Any]] = {
    "hopper": {
        "environment": "PlanarHopper-v5",
        "msteps": 2,
        "policy": {"episodes": 1, "pepisodes": 3, "maxsteps": 1000, "nhiddens": 50, "winit": 1}
        | {"action_noise": 1},
    },
    "Pendulum": {
        "environment": "Pendulum-v1",
        "msteps": 4,
        "policy": {"episodes": 3, "pepisodes": 3, "maxsteps": 200, "nhiddens": 10},
    },
}


def condition(problem: str, step: float, own: bool = False) -> Condition:
    """Return a condition: this step size, with the student's own strategy or OpenAI-ES."""
    told = PROBLEMS[problem]
    algo: dict[str, Any] = {"maxmsteps": told["msteps"]}
    if own:
        algo["options"] = f"stepsize={step:g}, noiseStdDev=0.05, samplesize=20"
    else:
        algo |= {"stepsize": step, "noiseStdDev": 0.05, "samplesize": 20}
    name = "strategy:evolve" if own else "OpenAI-ES"
    network = {"bias": 1, "afunction": 2, "out_type": 3}
    return Condition(
        f"{problem} {step:g}",
        {
            "exp": {"environment": told["environment"], "algo": name},
            "policy": told["policy"] | network,
            "algo": algo,
        },
        x=step,
    )


HOPPER = tuple(f"hopper {step:g}" for step in STEPS["hopper"])
PENDULUM = tuple(f"Pendulum {step:g}" for step in STEPS["Pendulum"])
LAB = Lab(
    number=8,
    title="How long may the steps be?",
    conditions=tuple(
        condition(problem, step, own=problem == "hopper")
        for problem, steps in STEPS.items()
        for step in steps
    ),
    predictions=(
        Field("best-hopper", "choice", "The best step size of the hopper"),
        Field("best-pendulum", "choice", "The best step size of Pendulum"),
        Field("severe", "number", "Severe regressions with step size 0.1", 0, 10),
        Field("why", "text", "Why you predict this", words=10),
    ),
    fields=(
        Field("drops", "choice", "The hopper's drops"),
        Field("hopper", "choice", "The hopper's fitness"),
        Field("p-hopper", "number", "The hopper's p", 0, 1),
        Field("power", "number", "What five runs would find", 0, 100),
        Field("pendulum", "choice", "Pendulum's fitness"),
    ),
    measures={"drop": 1e-4, "severe": 1e-6, "fresh": 1e-3},
    reference=reference,
    unseen=(condition("hopper", 0.1), condition("Pendulum", 0.5)),
    columns=(
        Column(
            "median drop",
            lambda values: (float(np.median(values["drop"])),),
            lambda true: 0.006,
        ),
        Column("severe", lambda values: (float(values["severe"].sum()),), lambda true: 0.01),
        *FRESH,
    ),
    statements=(
        Statement(
            "drops",
            5,
            (HOPPER[0], HOPPER[2]),
            larger("drop", HOPPER[0], HOPPER[2], ("0.01", "0.1")),
        ),
        Statement(
            "hopper",
            5,
            (HOPPER[0], HOPPER[1]),
            larger("fresh", HOPPER[0], HOPPER[1], ("0.01", "0.03")),
        ),
        Statement("p-hopper", 4, (HOPPER[0], HOPPER[1]), p_value("fresh", HOPPER[0], HOPPER[1])),
        Statement("power", 6, (HOPPER[0], HOPPER[1]), powerful("fresh", HOPPER[0], HOPPER[1], 5)),
        Statement(
            "pendulum",
            5,
            (PENDULUM[1], PENDULUM[2]),
            larger("fresh", PENDULUM[1], PENDULUM[2], ("0.1", "0.5")),
        ),
    ),
    figure=Figure("drop", HOPPER, ("drop", "share", "height")),
    rubric=(
        "The reason of the prediction says what a step that is too long does to a curve.",
        "What surprised the student is a fact of the runs, with its number.",
        "The student says why the best robot of a run hides what its curve shows.",
    ),
    robot="evolutions",
    shown=(HOPPER[0], HOPPER[2]),
    best=lambda values: values["fresh"],
    redone=8,
    strategy="ex08_openai_es/openai_es.py",
)
