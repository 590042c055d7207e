"""Do later predators beat more of the ancient prey, and does it matter who evolves?"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Data, Field, Figure, Lab, Statement
from botschool.labs.judging import CANNOT_TELL, Judged, larger, p_value
from botschool.labs.measuring import chases, interval


def historical(matrix: np.ndarray) -> float:
    """Return the sum of each generation's gains on the one before it, against older prey."""
    gains = np.diff(matrix, axis=0)
    return float(sum(row[:g].mean() for g, row in enumerate(gains, 1)))


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Return historical progress with and without generation 0, and global progress."""
    matrix = chases(run, best=5).mean(axis=(1, 3))
    return {
        "historical": historical(matrix),
        "later": historical(matrix[1:, 1:]),
        "global": float(np.diff(matrix, axis=0).mean(axis=1).sum()),
    }


WHO = ("random", "best")


def condition(who: str) -> Condition:
    """Return a condition: predators and prey with small networks, at most 40 seconds a chase."""
    return Condition(
        who,
        {
            "exp": {"environment": "ErPredprey", "algo": "coevo2"},
            "policy": {
                "nrobots": 2,
                "heterogeneous": 1,
                "episodes": 1,
                "pepisodes": 1,
                "maxsteps": 400,
                "nhiddens": 8,
                "bias": 1,
                "out_type": 2,
                "winit": 0,
            },
            "algo": {
                "ngenerations": 20,
                "popsize": 10,
                "selsize": 4,
                "samplesize": 5,
                "stepsize": 0.02,
                "noiseStdDev": 0.05,
                "evolving": who,
                "saveeach": 4,
            },
        },
        x=float(WHO.index(who)),
    )


def above_zero(measure: str) -> Callable[[Data, Answers], Judged]:
    """Judge whether a measure's mean over the runs of `random` lies above 0."""

    def judge(data: Data, answers: Answers) -> Judged:
        low, high = interval(data["random"][measure], np.mean)
        right = "yes" if low > 0 else "no, fewer" if high < 0 else CANNOT_TELL
        told = f"look where the interval of the mean of {measure} lies, below 0, above or around."
        return lambda answer: answer == right, told

    return judge


def first_part(data: Data, answers: Answers) -> Judged:
    """Judge how much of the historical progress is due to generation 0."""
    found = float((data["random"]["historical"] - data["random"]["later"]).mean())
    told = "compute the mean of historical - later over your ten runs of random again."
    return lambda answer: abs(answer - found) <= 0.006 + 0.02 * abs(found), told


def mean_of(measure: str) -> Column:
    """Return a column of means."""
    return Column(
        f"mean {measure}",
        lambda values: (float(values[measure].mean()),),
        lambda true: 0.006 + 0.01 * abs(true[0]),
    )


def interval_of(values: Mapping[str, np.ndarray]) -> tuple[float, float]:
    """Return the interval of the mean historical progress."""
    return interval(values["historical"], np.mean)


LAB = Lab(
    number=15,
    title="Do later predators beat more of the ancient prey?",
    conditions=tuple(condition(who) for who in WHO),
    predictions=(
        Field("predicted-ancient", "choice", "Whether later predators beat more ancient prey"),
        Field("predicted-who", "choice", "Who makes more progress"),
        Field("predicted-gain", "number", "The mean historical progress", -2, 2),
        Field("why", "text", "Why you predict this", words=10),
    ),
    fields=(
        Field("ancient", "choice", "Whether later predators beat more ancient prey"),
        Field("without", "choice", "The same without generation 0"),
        Field("due", "number", "What is due to generation 0", -5, 5),
        Field("who", "choice", "Who makes more progress"),
        Field("p", "number", "The p of the permutation test", 0, 1),
    ),
    measures={"historical": 1e-3, "later": 1e-3, "global": 1e-3},
    reference=reference,
    unseen=(condition("best"),),
    columns=(
        mean_of("historical"),
        Column("95 % interval", interval_of, lambda true: 0.01 + 0.3 * (true[1] - true[0])),
        mean_of("later"),
        mean_of("global"),
    ),
    statements=(
        Statement("ancient", 6, ("random",), above_zero("historical")),
        Statement("without", 6, ("random",), above_zero("later")),
        Statement("due", 4, ("random",), first_part),
        Statement("who", 5, WHO, larger("global", *WHO, WHO)),
        Statement("p", 4, WHO, p_value("global", *WHO)),
    ),
    figure=Figure("historical", WHO, ("progress", "fitness")),
    rubric=(
        "The reason of the prediction says what a circle would look like in a tournament.",
        "The student says what generation 0 is, and why beating it proves little.",
        "What surprised the student is a fact of the runs, with its number.",
    ),
    robot="co-evolutions",
    shown=WHO,
    best=lambda values: values["global"],
    redone=4,
)
