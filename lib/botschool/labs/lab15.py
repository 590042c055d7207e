"""Do later predators beat more of the ancient prey, and does it matter who evolves?"""

from __future__ import annotations

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Data, Figure, Judged, Lab, Statement
from botschool.labs.judging import larger, mean_interval, mean_over, one_of, p_value, side
from botschool.labs.measuring import Run, chases


def historical(matrix: np.ndarray) -> float:
    """Return the sum of each generation's gains on the one before it, against older prey."""
    gains = np.diff(matrix, axis=0)
    return float(sum(row[:g].mean() for g, row in enumerate(gains, 1)))


def reference(run: Run, answers: Answers) -> dict[str, float]:
    """Return historical progress with and without generation 0, and global progress."""
    matrix = chases(run, best=5).mean(axis=(1, 3))
    return {
        "historical": historical(matrix),
        "later": historical(matrix[1:, 1:]),
        "global": float(np.diff(matrix, axis=0).mean(axis=1).sum()),
    }


WHO = ("random", "best")
RANDOM = WHO[:1]


def condition(who: str) -> Condition:
    """Return a condition: predators and prey with small networks, at most 40 seconds a chase."""
    network = "maxsteps=400, nhiddens=8, bias=1, out_type=2, winit=0"
    sizes = "ngenerations=20, popsize=10, selsize=4, samplesize=5"
    return Condition.of(
        who,
        "ErPredprey",
        f"nrobots=2, heterogeneous=1, episodes=1, pepisodes=1, {network}",
        f"{sizes}, stepsize=0.02, noiseStdDev=0.05, evolving='{who}', saveeach=4",
        "coevo2",
    )


def above_zero(points: int, measure: str) -> Statement:
    """Ask whether a measure's mean over the runs of `random` lies above 0."""

    def judge(data: Data, answers: Answers) -> Judged:
        right = side(mean_interval(data["random"][measure]), 0, ("yes", "no, fewer"))
        told = f"look where the interval of the mean of {measure} lies, below 0, above or around."
        return one_of(right, told)

    return Statement(points, RANDOM, judge)


LAB = Lab(
    number=15,
    conditions=tuple(condition(who) for who in WHO),
    statements={
        "ancient": above_zero(6, "historical"),
        "without": above_zero(6, "later"),
        "due": mean_over(4, RANDOM, "historical - later", 0.006, "your ten runs of random"),
        "who": larger(5, "global", WHO),
        "p": p_value(4, "global", WHO),
    },
    measures={"historical": 1e-3, "later": 1e-3, "global": 1e-3},
    reference=reference,
    unseen=(condition("best"),),
    columns=(
        Column(np.mean, "historical", 0.006, 0.01),
        Column(mean_interval, "historical", 0.01),
        Column(np.mean, "later", 0.006, 0.01),
        Column(np.mean, "global", 0.006, 0.01),
    ),
    figure=Figure("historical", WHO, ("progress", "fitness")),
    rubric=(
        "The reason of the prediction says what a circle would look like in a tournament.",
        "The student says what generation 0 is, and why beating it proves little.",
        "What surprised the student is a fact of the runs, with its number.",
    ),
    shown=WHO,
    redone=4,
)
