"""Evolution or policy gradient: when which?"""

from __future__ import annotations

from functools import cache

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Data, Figure, Judged, Lab, Statement
from botschool.labs.judging import larger, one_of, p_value, winners
from botschool.labs.measuring import Run, play_again, seconds_per_million

GOALS = {"dense": -200.0, "sparse": 90.0, "long": 1000.0}


def reference(run: Run, answers: Answers) -> dict[str, float]:
    """Return the steps until the goal, whether it is reached, and the return in new episodes."""
    stat = np.asarray(run["stat"])
    reached = stat[:, 2] >= GOALS[run["condition"].split()[0]]
    return {
        "steps": float(stat[reached.argmax() if reached.any() else -1, 0]),
        "reached": float(reached.any()),
        "fresh": float(np.mean(play_again(run, seed=2, episodes=20))),
    }


PROBLEMS = {
    "dense": ("Pendulum-v1", 200, 10),
    "sparse": ("MountainCarContinuous-v0", 999, 10),
    "long": ("PlanarHopper-v5", 1000, 20),
}
"""Environment, steps of an episode, hidden neurons."""
ES = {
    "dense": "maxmsteps=6, samplesize=20, stepsize=0.1, noiseStdDev=0.1, wdecay=0",
    "sparse": "maxmsteps=0.3, samplesize=20, stepsize=0.03, noiseStdDev=0.3, wdecay=0",
    "long": "maxmsteps=1, samplesize=20, stepsize=0.03, noiseStdDev=0.05, wdecay=0",
}
PPO = {
    "dense": (
        0.15,
        "n_envs=16, n_steps=128, batch_size=128, gamma=0.95, learning_rate=0.001, normalize=True",
    ),
    "sparse": (
        0.3,
        "n_envs=8, n_steps=512, batch_size=128, gamma=0.99, learning_rate=0.0003, normalize=True",
    ),
    "long": (
        1,
        "n_envs=32, n_steps=256, batch_size=256, gamma=0.999, n_epochs=5, learning_rate=0.0006, "
        "normalize=True, log_std_init=-0.5",
    ),
}
"""Million steps of a run, settings."""
METHODS = ("evolution", "gradient")


def evolution(problem: str) -> Condition:
    """Return a condition: OpenAI-ES with a small network."""
    environment, steps, hidden = PROBLEMS[problem]
    network = f"nhiddens={hidden}, bias=1, afunction=2, out_type=3, winit=1, normalize=1, clip=1"
    policy = f"episodes=1, pepisodes=20, maxsteps={steps}, {network}"
    return Condition.of(f"{problem} evolution", environment, policy, ES[problem])


def gradient(problem: str) -> Condition:
    """Return a condition: PPO with two layers of 64 neurons."""
    environment, (msteps, ppo) = PROBLEMS[problem][0], PPO[problem]
    environment = f"botschool/{environment}" if problem == "long" else environment
    return Condition.trained(f"{problem} gradient", environment, msteps, ppo)


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
        return one_of([], "write all six seconds first.")
    seconds_of, _ = told
    possible = {0}
    for first, second in NEEDS.values():
        a, b = data[first]["steps"], data[second]["steps"]
        steps = winners(a, b, METHODS[::-1])
        seconds = winners(a * seconds_of[first], b * seconds_of[second], METHODS[::-1])
        here = {int(one != other) for one in steps for other in seconds}
        possible = {count + each for count in possible for each in here}
    return one_of(possible, "test steps and seconds of each problem again.")


def timed(data: Data, answers: Answers) -> Judged:
    """Judge whether the seconds are plausible for a machine."""
    told = speeds(answers)
    if told is None:
        return one_of([], "write all six seconds first.")
    _, wrong = told
    return lambda answer: not wrong, f"{'; '.join(wrong)}."


NEEDS = {problem: tuple(f"{problem} {method}" for method in METHODS) for problem in PROBLEMS}
"""Problem -> its two conditions."""
CONDITIONS = tuple(make(problem) for problem in PROBLEMS for make in (evolution, gradient))
ALL = tuple(condition.name for condition in CONDITIONS)
LAB = Lab(
    number=14,
    conditions=CONDITIONS,
    statements={
        **{each: larger(4, "steps", NEEDS[each], METHODS[::-1]) for each in PROBLEMS},
        "p": p_value(3, "steps", NEEDS["long"]),
        "seconds-dense-evolution": Statement(4, NEEDS["dense"], timed),
        "changes": Statement(6, ALL, changes),
    },
    measures={"steps": 1e-6, "reached": 1e-6, "fresh": 1e-3},
    reference=reference,
    unseen=(evolution("dense"), gradient("dense")),
    columns=(
        Column(np.sum, "reached", 0.01),
        Column(np.median, "steps", 0.6, 0.002, unit=1000),
        Column(np.median, "fresh", 0.6, 0.002),
    ),
    figure=Figure("steps", ALL, ("step",)),
    rubric=(
        "The reason of the prediction says what each method learns from: whole episodes, or steps.",
        "The advice names the problem's rewards, its length, and what a step costs.",
        "The student says what the three problems and these settings cannot show.",
    ),
    shown=("sparse evolution", "long evolution"),
    redone=8,
)
