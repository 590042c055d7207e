"""How long may the steps be?"""

from __future__ import annotations

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Figure, Lab
from botschool.labs.judging import FRESH, larger, p_value, powerful
from botschool.labs.measuring import Run, play_again

WIDTH = 20
SEVERE = 0.3


def reference(run: Run, answers: Answers) -> dict[str, float]:
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
NETWORK = "bias=1, afunction=2, out_type=3"
PROBLEMS = {
    "hopper": (
        "PlanarHopper-v5",
        f"episodes=1, pepisodes=3, maxsteps=1000, nhiddens=50, winit=1, action_noise=1, {NETWORK}",
        2,
    ),
    "Pendulum": (
        "Pendulum-v1",
        f"episodes=3, pepisodes=3, maxsteps=200, nhiddens=10, {NETWORK}",
        4,
    ),
}
"""Environment, settings of the policy, million steps of a run."""


def condition(problem: str, step: float, by: str = "OpenAI-ES") -> Condition:
    """Return a condition: this step size; by: the algorithm."""
    environment, policy, msteps = PROBLEMS[problem]
    algo = f"maxmsteps={msteps}, stepsize={step:g}, noiseStdDev=0.05, samplesize=20"
    return Condition.of(f"{problem} {step:g}", environment, policy, algo, by)


HOPPER = tuple(f"hopper {step:g}" for step in STEPS["hopper"])
ENDS, SMALL, LONG = ("hopper 0.01", "hopper 0.1"), HOPPER[:2], ("Pendulum 0.1", "Pendulum 0.5")
LAB = Lab(
    number=8,
    conditions=(
        *(condition("hopper", step, "strategy:evolve") for step in STEPS["hopper"]),
        *(condition("Pendulum", step) for step in STEPS["Pendulum"]),
    ),
    statements={
        "drops": larger(5, "drop", ENDS, ("0.01", "0.1")),
        "hopper": larger(5, "fresh", SMALL, ("0.01", "0.03")),
        "p-hopper": p_value(4, "fresh", SMALL),
        "power": powerful(6, "fresh", SMALL, 5),
        "pendulum": larger(5, "fresh", LONG, ("0.1", "0.5")),
    },
    measures={"drop": 1e-4, "severe": 1e-6, "fresh": 1e-3},
    reference=reference,
    unseen=(condition("hopper", 0.1), condition("Pendulum", 0.5)),
    columns=(
        Column(np.median, "drop", 0.006),
        Column(np.sum, "severe", 0.01),
        *FRESH,
    ),
    figure=Figure("drop", HOPPER, ("drop", "share", "height")),
    rubric=(
        "The reason of the prediction says what a step that is too long does to a curve.",
        "What surprised the student is a fact of the runs, with its number.",
        "The student says why the best robot of a run hides what its curve shows.",
    ),
    shown=ENDS,
    redone=8,
    strategy="ex08_openai_es/openai_es.py",
)
