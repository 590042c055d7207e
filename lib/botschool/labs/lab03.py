"""At equal numbers of evaluations: larger populations or more generations?"""

from __future__ import annotations

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Figure, Lab
from botschool.labs.judging import FRESH, RETURN, larger, mean_over, p_value
from botschool.labs.measuring import Run, play_again

SOLVED = 475.0
"""CartPole: mean of 20 new episodes."""


def reference(run: Run, answers: Answers) -> dict[str, float]:
    """Return reported and new fitness, evaluations until solved, and whether it is solved."""
    size = run["experiment"]["algo"]["popsize"]
    reported = np.asarray(run["stat"])[:, 2]
    solved = reported >= SOLVED
    generations = int(solved.argmax()) + 1 if solved.any() else len(solved)
    return {
        "reported": float(reported[-1]),
        "fresh": float(np.mean(play_again(run, seed=1, episodes=100))),
        "evaluations": float(size * generations),
        "solved": float(solved.any()),
    }


SIZES = (4, 20, 100)
PROBLEMS = {"CartPole": ("CartPole-v1", 500, 600), "Pendulum": ("Pendulum-v1", 200, 4000)}
"""Environment, steps of an episode, and evaluations, equally many for all populations."""
NETWORK = "nhiddens=10, bias=1, afunction=2, out_type=3, winit=0"


def condition(problem: str, size: int) -> Condition:
    """Return a condition: SSS with this population.

    mutrate is the same for both problems: 0.1 is too small for Pendulum, and no size of population
    makes up for it.
    """
    environment, steps, evaluations = PROBLEMS[problem]
    policy = f"episodes=5, pepisodes=20, maxsteps={steps}, {NETWORK}"
    algo = f"maxmsteps=100, popsize={size}, mutrate=0.4"
    name, generations = f"{problem} {size}", evaluations // size
    return Condition.of(name, environment, policy, algo, "SSS", generations)


POLE = ("CartPole 4", "CartPole 100")
PENDULUM = tuple(f"Pendulum {size}" for size in SIZES)
ENDS = ("Pendulum 4", "Pendulum 100")
SIZED = ("4 individuals", "100 individuals")
FEWER = SIZED[::-1]
LAB = Lab(
    number=3,
    conditions=tuple(condition(problem, size) for problem in PROBLEMS for size in SIZES),
    statements={
        "cartpole": larger(6, "evaluations", POLE, FEWER),
        "p-cartpole": p_value(4, "evaluations", POLE),
        "pendulum": larger(6, "fresh", ENDS, SIZED),
        "p-pendulum": p_value(4, "fresh", ENDS),
        "lost": mean_over(5, PENDULUM, "reported - fresh", 0.5, "all your Pendulum runs"),
    },
    measures={"reported": 1e-6, "fresh": 1e-3, "evaluations": 1e-6, "solved": 1e-6},
    reference=reference,
    unseen=(condition("CartPole", 20), condition("Pendulum", 100)),
    columns=(
        Column(np.sum, "solved", 0.01, only="CartPole"),
        Column(np.median, "evaluations", 0.6, only="CartPole"),
        *FRESH,
    ),
    figure=Figure("fresh", PENDULUM, RETURN),
    rubric=(
        "The reason of the prediction says what a population and what generations are good for.",
        "What surprised the student is a fact of the runs, with its number.",
        "The student says for which other problems the result may not hold.",
    ),
    shown=ENDS,
    redone=12,
)
