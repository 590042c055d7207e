"""Do body and brain need each other?"""

from __future__ import annotations

from typing import Any

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Data, Field, Figure, Lab, Statement
from botschool.labs.judging import Judged, decided, larger_of_pairs, p_of
from botschool.labs.measuring import interval, paired_test, permutation_test, play_again

BODY = 64
"""Parameters of a body, at the end of a genotype."""


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Return the brain's return in its own body, and the mean of its returns in the others'."""
    brain = np.asarray(run["genotype"])[:-BODY]
    mixed = [np.concatenate([brain, np.asarray(other)[-BODY:]]) for other in run["others"]]
    returns = [play_again(run | {"genotype": each}, seed=1, episodes=10).mean() for each in mixed]
    return {
        "own": float(play_again(run, seed=1, episodes=10).mean()),
        "swapped": float(np.mean(returns)),
    }


MSTEPS = {"early": 0.2, "late": 1.0}


def condition(stage: str) -> Condition:
    """Return a condition: body and brain evolve together for this many million steps."""
    return Condition(
        stage,
        {
            "exp": {"environment": "PlanarBodyBrain-v0", "algo": "OpenAI-ES"},
            "policy": {
                "episodes": 1,
                "pepisodes": 3,
                "maxsteps": 400,
                "nhiddens": 20,
                "bias": 1,
                "afunction": 2,
                "out_type": 3,
                "winit": 1,
                "action_noise": 1,
                "clip": 1,
            },
            "algo": {
                "maxmsteps": MSTEPS[stage],
                "samplesize": 10,
                "stepsize": 0.05,
                "noiseStdDev": 0.05,
                "wdecay": 1,
            },
        },
        x=MSTEPS[stage],
    )


def loss_grows(data: Data, answers: Answers) -> Judged:
    """Judge at which stage a brain loses more in other bodies."""
    early, late = (data[stage]["own"] - data[stage]["swapped"] for stage in MSTEPS)
    return decided(early, late, permutation_test(early, late), STAGES, "permutation test")


def median(name: str) -> Any:
    """Return the column's function: the median of a measure."""
    return lambda values: (float(np.median(values[name])),)


STAGES = ("early", "late")
BODIES = ("its own", "the others'")
LAB = Lab(
    number=5,
    title="Do body and brain need each other?",
    conditions=tuple(condition(stage) for stage in STAGES),
    predictions=(
        Field("early-expected", "choice", "Where an early brain does better"),
        Field("late-expected", "choice", "Where a late brain does better"),
        Field("swapped-expected", "number", "The late return in other bodies", -200, 2000),
        Field("why", "text", "Why you predict this", words=10),
    ),
    fields=(
        Field("early", "choice", "Where an early brain does better"),
        Field("late", "choice", "Where a late brain does better"),
        Field("p-paired", "number", "The p of the paired test", 0, 1),
        Field("p-groups", "number", "The p of the test of two groups", 0, 1),
        Field("grows", "choice", "When the loss is larger"),
    ),
    measures={"own": 1e-3, "swapped": 1e-3},
    reference=reference,
    unseen=(condition("early"), condition("early")),
    columns=(
        Column("median in its own body", median("own"), lambda true: 0.1 + 0.002 * abs(true[0])),
        Column("median in the others'", median("swapped"), lambda true: 0.1 + 0.002 * abs(true[0])),
        Column(
            "mean difference, 95 % interval",
            lambda values: interval(values["own"] - values["swapped"], np.mean),
            lambda true: 0.3 + 0.3 * (true[1] - true[0]),
        ),
    ),
    statements=(
        Statement("early", 5, STAGES[:1], larger_of_pairs("early", "own", "swapped", BODIES)),
        Statement("late", 5, STAGES[1:], larger_of_pairs("late", "own", "swapped", BODIES)),
        Statement(
            "p-paired",
            5,
            STAGES[:1],
            p_of(lambda data: paired_test(data["early"]["own"], data["early"]["swapped"])),
        ),
        Statement(
            "p-groups",
            5,
            STAGES[:1],
            p_of(lambda data: permutation_test(data["early"]["own"], data["early"]["swapped"])),
        ),
        Statement("grows", 5, STAGES, loss_grows),
    ),
    figure=Figure("swapped", STAGES, ("return", "fitness", "reward")),
    rubric=(
        "The reason of the prediction says what a brain knows about its body.",
        "The student says why pairs find more than two groups, or why they do not here.",
        "What surprised the student is a fact of the runs, with its number.",
    ),
    robot="walkers",
    shown=STAGES,
    best=lambda values: values["own"],
    others=True,
)
