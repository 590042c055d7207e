"""How much reward for standing still makes a statue?"""

from __future__ import annotations

from typing import Any

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Data, Field, Figure, Lab, Statement
from botschool.labs.judging import CANNOT_TELL, Judged, larger, p_value, span
from botschool.labs.measuring import interval, record


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Return metres ahead, share of steps with a foot on the ground, and whether it is a statue."""
    seen = record(run, seed=1)
    metres = float(seen["distance"][0] - seen["distance"][-1])
    rule = answers.get("rule", 5.0)
    return {
        "metres": metres,
        "ground": float(seen["feet"].max(axis=1).mean()),
        "statue": float(metres < rule),
    }


BONUSES = (0.0, 0.02, 0.04, 0.06, 0.08, 0.1, 0.2)
NEVER = 0.3
"""The tipping point if no bonus makes more than half of the hoppers statues."""
NEARLY = 0.02
"""Largest uncertainty of the tipping point that counts as known."""
FIRST, LAST = "bonus 0", "bonus 0.2"
POLICY = {
    "episodes": 1,
    "pepisodes": 3,
    "maxsteps": 1000,
    "nhiddens": 10,
    "bias": 1,
    "afunction": 2,
    "out_type": 3,
    "winit": 1,
    "action_noise": 1,
}
ALGO = {"stepsize": 0.03, "noiseStdDev": 0.05, "samplesize": 20, "wdecay": 1}


def condition(bonus: float, own: bool = False) -> Condition:
    """Return a condition: hoppers with this bonus, by the student's strategy or OpenAI-ES."""
    algo: dict[str, Any] = {"maxmsteps": 4}
    if own:
        algo["options"] = ", ".join(f"{key}={value:g}" for key, value in ALGO.items())
    else:
        algo |= ALGO
    return Condition(
        f"bonus {bonus:g}",
        {
            "exp": {
                "environment": "PlanarHopper-v5",
                "algo": "strategy:evolve" if own else "OpenAI-ES",
                "options": f"alive={bonus:g}",
            },
            "policy": POLICY,
            "algo": algo,
        },
        x=bonus,
    )


def separate(measured: list[dict[str, float]]) -> str:
    """Return what is wrong if the student's rule does not separate two robots; "" if it does.

    The first unseen robot was rewarded for metres alone, the second for standing alone.
    """
    hopper, statue = measured
    if hopper["metres"] > 8 and statue["metres"] < 3 and hopper["statue"] == statue["statue"]:
        return (
            f"its rule calls a robot that goes {hopper['metres']:.1f} m and one that goes "
            f"{statue['metres']:.1f} m the same: state a rule that tells them apart."
        )
    return ""


def tipping_point(shares: np.ndarray) -> np.ndarray:
    """Return the smallest bonus from which on most are statues; shares: (..., bonuses)."""
    more = np.flip(np.logical_and.accumulate(np.flip(shares > 0.5, -1), axis=-1), -1)
    first = more.argmax(axis=-1)
    return np.where(more.any(axis=-1), np.array(BONUSES)[first], NEVER)


def tipping_interval(data: Data) -> tuple[float, float]:
    """Return the interval of the tipping point, by resampling the runs of each bonus."""
    rng = np.random.default_rng(1)
    shares = []
    for bonus in BONUSES:
        statues = data[f"bonus {bonus:g}"]["statue"]
        chosen = rng.integers(len(statues), size=(10_000, len(statues)))
        shares.append(statues[chosen].mean(axis=1))
    return span(tipping_point(np.stack(shares, axis=-1)))


def against_prediction(data: Data, answers: Answers) -> Judged:
    """Judge whether the tipping point lies below or above the prediction."""
    low, high = tipping_interval(data)
    predicted = answers.get("tipping", NEVER)
    right = "below" if high < predicted else "above" if low > predicted else CANNOT_TELL
    told = "compare your prediction with the interval of your resampled tipping points."
    return lambda answer: answer == right, told


def shown(data: Data) -> float:
    """Return the tipping point that the runs show."""
    shares = np.array([data[f"bonus {bonus:g}"]["statue"].mean() for bonus in BONUSES])
    return float(tipping_point(shares))


def observed(data: Data, answers: Answers) -> Judged:
    """Judge the tipping point that the runs show."""
    found = shown(data)
    return (
        lambda answer: abs(answer - found) < 0.005,
        "read it off your table: its least bonus with more than five statues.",
    )


def enough(data: Data, answers: Answers) -> Judged:
    """Judge whether ten runs fix the tipping point to +- NEARLY."""
    low, high = tipping_interval(data)
    right = "yes" if high - low <= 2 * NEARLY + 1e-9 else "no"
    return lambda answer: answer == right, "look how far apart the ends of your interval are."


def median(values: Any) -> tuple[float, ...]:
    """Return the median of the metres."""
    return (float(np.median(values["metres"])),)


ALL = tuple(f"bonus {bonus:g}" for bonus in BONUSES)
LAB = Lab(
    number=9,
    title="How much reward for standing still makes a statue?",
    conditions=tuple(condition(bonus, own=True) for bonus in BONUSES),
    predictions=(
        Field("tipping", "number", "The bonus at which it tips", 0, NEVER),
        Field("both", "choice", "Whether some do both"),
        Field("why", "text", "Why you predict this", words=10),
    ),
    fields=(
        Field("rule", "number", "The rule for statues", 0.5, 20),
        Field("observed", "number", "The tipping point of your runs", 0, NEVER),
        Field("against", "choice", "The tipping point and your prediction"),
        Field("further", "choice", "Which hoppers go further"),
        Field("p", "number", "The p of the permutation test", 0, 1),
        Field("enough", "choice", "Whether ten runs are enough"),
    ),
    measures={"metres": 0.01, "ground": 0.01, "statue": 0.01},
    reference=reference,
    unseen=(condition(0.0), condition(1.0)),
    columns=(
        Column("median metres", median, lambda true: 0.06 + 0.01 * abs(true[0])),
        Column(
            "95 % interval",
            lambda values: interval(values["metres"]),
            lambda true: 0.1 + 0.3 * (true[1] - true[0]),
        ),
        Column("statues", lambda values: (float(values["statue"].sum()),), lambda true: 0.01),
    ),
    statements=(
        Statement("observed", 5, ALL, observed),
        Statement("against", 6, ALL, against_prediction),
        Statement("further", 5, (FIRST, LAST), larger("metres", FIRST, LAST, (FIRST, LAST))),
        Statement("p", 4, (FIRST, LAST), p_value("metres", FIRST, LAST)),
        Statement("enough", 5, ALL, enough),
    ),
    figure=Figure(
        "metres",
        ALL,
        ("metre", "(m)", "[m]", " m ", "in m"),
        mark=lambda data: None if shown(data) == NEVER else shown(data),
    ),
    rubric=(
        "The reason of the prediction names what the two rewards pay for.",
        "What surprised the student is a fact of the runs, with its number.",
        "The student says what the experiment cannot show.",
    ),
    robot="hoppers",
    shown=(FIRST, LAST),
    best=lambda values: values["metres"],
    separate=separate,
    redone=8,
    strategy="ex08_openai_es/openai_es.py",
)
