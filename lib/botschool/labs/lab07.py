"""When does behaviour get its shape, and does it survive another gravity?"""

from __future__ import annotations

from typing import Any

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Data, Field, Figure, Lab, Statement
from botschool.labs.judging import CANNOT_TELL, Judged, larger, larger_of_pairs, p_value
from botschool.labs.measuring import RESAMPLES, interval, swing

LAST, UPRIGHT = 50, 0.3
"""An episode ends upright if the angle is below UPRIGHT in all LAST steps."""


def upright(seen: dict[str, np.ndarray]) -> float:
    """Return the share of episodes that end upright."""
    return float((np.abs(seen["angles"][:, -LAST:]) < UPRIGHT).all(axis=1).mean())


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Return the return and the share of upright ends, under the old and the greater gravity."""
    usual, heavy = swing(run, gravity=10.0), swing(run, gravity=12.0)
    return {
        "return": float(usual["rewards"].sum(axis=1).mean()),
        "upright": upright(usual),
        "heavy": float(heavy["rewards"].sum(axis=1).mean()),
        "heavy_upright": upright(heavy),
    }


MSTEPS = {"early": 0.5, "middle": 3.0, "late": 8.0}
STEPS = ("early to middle", "middle to late")


def condition(stage: str) -> Condition:
    """Return a condition: pendulums that have evolved for this many million steps."""
    return Condition(
        stage,
        {
            "exp": {"environment": "Pendulum-v1", "algo": "OpenAI-ES"},
            "policy": {
                "episodes": 3,
                "pepisodes": 10,
                "maxsteps": 200,
                "nhiddens": 10,
                "bias": 1,
                "afunction": 2,
                "out_type": 3,
            },
            "algo": {
                "maxmsteps": MSTEPS[stage],
                "samplesize": 20,
                "stepsize": 0.1,
                "noiseStdDev": 0.05,
            },
        },
        x=MSTEPS[stage],
    )


def when(data: Data, answers: Answers) -> Judged:
    """Judge in which half of evolution the share of upright ends grows more."""
    rng = np.random.default_rng(1)
    early, middle, late = (
        values[rng.integers(len(values), size=(RESAMPLES, len(values)))].mean(axis=1)
        for values in (data[stage]["upright"] for stage in MSTEPS)
    )
    low, high = np.percentile(2 * middle - early - late, [2.5, 97.5])
    ends = {
        STEPS[0] if low > slack else STEPS[1] if high < -slack else CANNOT_TELL
        for slack in (-0.04, 0.0, 0.04)
    }
    told = "look whether the interval of the first growth minus the second contains 0."
    return lambda answer: answer in ends, told


def survivors(data: Data, answers: Answers) -> Judged:
    """Judge how many late pendulums mostly end upright under the greater gravity."""
    found = int((data["late"]["heavy_upright"] > 0.5).sum())
    return lambda answer: answer == found, "count the late runs with heavy_upright > 0.5."


def median(name: str) -> Any:
    """Return the column's function: the median of a measure."""
    return lambda values: (float(np.median(values[name])),)


STAGES = ("early", "middle", "late")
LAB = Lab(
    number=7,
    title="When does behaviour get its shape, and does it survive another gravity?",
    conditions=tuple(condition(stage) for stage in STAGES),
    predictions=(
        Field("when-expected", "choice", "When behaviour gets its shape"),
        Field("survivors-expected", "number", "How many survive", 0, 10),
        Field("why", "text", "Why you predict this", words=10),
    ),
    fields=(
        Field("when", "choice", "When behaviour gets its shape"),
        Field("better", "choice", "Which stage earns more"),
        Field("p", "number", "The p of the permutation test", 0, 1),
        Field("gravity", "choice", "Under which gravity they earn more"),
        Field("survivors", "number", "How many survive", 0, 10),
    ),
    measures={"return": 1e-3, "upright": 1e-6, "heavy": 1e-3, "heavy_upright": 1e-6},
    reference=reference,
    unseen=(condition("early"), condition("late")),
    columns=(
        Column("median return", median("return"), lambda true: 0.6 + 0.002 * abs(true[0])),
        Column(
            "95 % interval",
            lambda values: interval(values["return"]),
            lambda true: 1 + 0.3 * (true[1] - true[0]),
        ),
        Column(
            "mean share upright",
            lambda values: (float(values["upright"].mean()),),
            lambda true: 0.006,
        ),
        Column(
            "median return, gravity 12", median("heavy"), lambda true: 0.6 + 0.002 * abs(true[0])
        ),
    ),
    statements=(
        Statement("when", 6, STAGES, when),
        Statement("better", 5, STAGES[1:], larger("return", "middle", "late", ("middle", "late"))),
        Statement("p", 4, STAGES[1:], p_value("return", "middle", "late")),
        Statement(
            "gravity", 5, STAGES[2:], larger_of_pairs("late", "return", "heavy", ("10", "12"))
        ),
        Statement("survivors", 5, STAGES[2:], survivors),
    ),
    figure=Figure("return", STAGES, ("return", "fitness", "reward")),
    rubric=(
        "The student describes the phase portrait of one early and one late pendulum.",
        "What surprised the student is a fact of the runs, with its number.",
        "The student says what two gravities cannot tell about others.",
    ),
    robot="pendulums",
    shown=("early", "late"),
    best=lambda values: values["return"],
    redone=6,
)
