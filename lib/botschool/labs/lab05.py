"""Do body and brain need each other?"""

from __future__ import annotations

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Figure, Lab
from botschool.labs.judging import RETURN, larger, mean_interval, p_value
from botschool.labs.measuring import Run, paired_test, play_again

BODY = 64
"""Parameters of a body, at the end of a genotype."""


def reference(run: Run, answers: Answers) -> dict[str, float]:
    """Return the brain's return in its own body, and the mean of its returns in the others'."""
    brain = np.asarray(run["genotype"])[:-BODY]
    mixed = [np.concatenate([brain, np.asarray(other)[-BODY:]]) for other in run["others"]]
    returns = [play_again(run | {"genotype": each}, seed=1, episodes=10).mean() for each in mixed]
    return {
        "own": float(play_again(run, seed=1, episodes=10).mean()),
        "swapped": float(np.mean(returns)),
    }


MSTEPS = {"early": 0.2, "late": 1.0}
PAIR = ("own", "swapped")
EARLY, LATE = ("early",), ("late",)


def condition(stage: str) -> Condition:
    """Return a condition: body and brain evolve together for this many million steps."""
    network = "nhiddens=20, bias=1, afunction=2, out_type=3, winit=1, action_noise=1, clip=1"
    return Condition.of(
        stage,
        "PlanarBodyBrain-v0",
        f"episodes=1, pepisodes=3, maxsteps=400, {network}",
        f"maxmsteps={MSTEPS[stage]}, samplesize=10, stepsize=0.05, noiseStdDev=0.05, wdecay=1",
    )


STAGES = EARLY + LATE
BODIES = ("its own", "the others'")
LAB = Lab(
    number=5,
    conditions=tuple(condition(stage) for stage in STAGES),
    statements={
        "early": larger(5, PAIR, EARLY, BODIES, paired_test),
        "late": larger(5, PAIR, LATE, BODIES, paired_test),
        "p-paired": p_value(5, PAIR, EARLY, paired_test),
        "p-groups": p_value(5, PAIR, EARLY),
        "grows": larger(5, "own - swapped", STAGES),
    },
    measures={"own": 1e-3, "swapped": 1e-3},
    reference=reference,
    unseen=(condition("early"), condition("early")),
    columns=(
        Column(np.median, "own", 0.1, 0.002),
        Column(np.median, "swapped", 0.1, 0.002),
        Column(mean_interval, "own - swapped", 0.3),
    ),
    figure=Figure("swapped", STAGES, RETURN),
    rubric=(
        "The reason of the prediction says what a brain knows about its body.",
        "The student says why pairs find more than two groups, or why they do not here.",
        "What surprised the student is a fact of the runs, with its number.",
    ),
    shown=STAGES,
    others=True,
)
