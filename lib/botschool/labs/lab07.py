"""When does behaviour get its shape, and does it survive another gravity?"""

from __future__ import annotations

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Data, Figure, Judged, Lab, Statement
from botschool.labs.judging import RETURN, larger, one_of, p_value, side
from botschool.labs.measuring import RESAMPLES, Run, interval, paired_test, swing

LAST, UPRIGHT = 50, 0.3
"""An episode ends upright if the angle is below UPRIGHT in all LAST steps."""


def upright(seen: dict[str, np.ndarray]) -> float:
    """Return the share of episodes that end upright."""
    return float((np.abs(seen["angles"][:, -LAST:]) < UPRIGHT).all(axis=1).mean())


def reference(run: Run, answers: Answers) -> dict[str, float]:
    """Return the return and the share of upright ends, under the old and the greater gravity."""
    usual, heavy = swing(run, gravity=10.0), swing(run, gravity=12.0)
    return {
        "return": float(usual["rewards"].sum(axis=1).mean()),
        "upright": upright(usual),
        "heavy": float(heavy["rewards"].sum(axis=1).mean()),
        "heavy_upright": upright(heavy),
    }


MSTEPS = {"early": 0.5, "middle": 3.0, "late": 8.0}
STAGES = tuple(MSTEPS)
LATER, LATE = ("middle", "late"), ("late",)


def condition(stage: str) -> Condition:
    """Return a condition: pendulums that have evolved for this many million steps."""
    return Condition.of(
        stage,
        "Pendulum-v1",
        "episodes=3, pepisodes=10, maxsteps=200, nhiddens=10, bias=1, afunction=2, out_type=3",
        f"maxmsteps={MSTEPS[stage]}, samplesize=20, stepsize=0.1, noiseStdDev=0.05",
    )


def when(data: Data, answers: Answers) -> Judged:
    """Judge in which half of evolution the share of upright ends grows more."""
    rng = np.random.default_rng(1)
    early, middle, late = (
        values[rng.integers(len(values), size=(RESAMPLES, len(values)))].mean(axis=1)
        for values in (data[stage]["upright"] for stage in MSTEPS)
    )
    low, high = np.percentile(2 * middle - early - late, [2.5, 97.5])
    right = side((low, high), 0, ("early to middle", "middle to late"), slack=0.04)
    told = "look whether the interval of the first growth minus the second contains 0."
    return one_of(right, told)


def survivors(data: Data, answers: Answers) -> Judged:
    """Judge how many late pendulums mostly end upright under the greater gravity."""
    found = int((data["late"]["heavy_upright"] > 0.5).sum())
    return one_of([found], "count the late runs with heavy_upright > 0.5.")


LAB = Lab(
    number=7,
    conditions=tuple(condition(stage) for stage in STAGES),
    statements={
        "when": Statement(6, STAGES, when),
        "better": larger(5, "return", LATER),
        "p": p_value(4, "return", LATER),
        "gravity": larger(5, ("return", "heavy"), LATE, ("10", "12"), paired_test),
        "survivors": Statement(5, LATE, survivors),
    },
    measures={"return": 1e-3, "upright": 1e-6, "heavy": 1e-3, "heavy_upright": 1e-6},
    reference=reference,
    unseen=(condition("early"), condition("late")),
    columns=(
        Column(np.median, "return", 0.6, 0.002),
        Column(interval, "return", 1),
        Column(np.mean, "upright", 0.006),
        Column(np.median, "heavy", 0.6, 0.002),
    ),
    figure=Figure("return", STAGES, RETURN),
    rubric=(
        "The student describes the phase portrait of one early and one late pendulum.",
        "What surprised the student is a fact of the runs, with its number.",
        "The student says what two gravities cannot tell about others.",
    ),
    shown=("early", "late"),
    redone=6,
)
