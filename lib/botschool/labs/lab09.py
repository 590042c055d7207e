"""How much reward for standing still makes a statue?"""

from __future__ import annotations

import numpy as np

from botschool.labs.declare import Answers, Column, Condition, Data, Figure, Judged, Lab, Statement
from botschool.labs.judging import larger, near, one_of, p_value, side, span
from botschool.labs.measuring import RESAMPLES, Run, interval, record


def reference(run: Run, answers: Answers) -> dict[str, float]:
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
ENDS = ("bonus 0", "bonus 0.2")


def condition(bonus: float, by: str = "OpenAI-ES") -> Condition:
    """Return a condition: hoppers with this bonus; by: the algorithm."""
    network = "nhiddens=10, bias=1, afunction=2, out_type=3, winit=1, action_noise=1"
    return Condition.of(
        f"bonus {bonus:g}",
        "PlanarHopper-v5",
        f"episodes=1, pepisodes=3, maxsteps=1000, {network}",
        "maxmsteps=4, stepsize=0.03, noiseStdDev=0.05, samplesize=20, wdecay=1",
        by,
        options=f"alive={bonus:g}",
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
        chosen = rng.integers(len(statues), size=(RESAMPLES, len(statues)))
        shares.append(statues[chosen].mean(axis=1))
    return span(tipping_point(np.stack(shares, axis=-1)))


def against_prediction(data: Data, answers: Answers) -> Judged:
    """Judge whether the tipping point lies below or above the prediction."""
    predicted = answers.get("tipping", NEVER)
    right = side(tipping_interval(data), predicted, ("above", "below"))
    told = "compare your prediction with the interval of your resampled tipping points."
    return one_of(right, told)


def shown(data: Data) -> float:
    """Return the tipping point that the runs show."""
    shares = np.array([data[f"bonus {bonus:g}"]["statue"].mean() for bonus in BONUSES])
    return float(tipping_point(shares))


def observed(data: Data, answers: Answers) -> Judged:
    """Judge the tipping point that the runs show."""
    told = "read it off your table: its least bonus with more than five statues."
    return near(shown(data), 0.005, 0, told)


def enough(data: Data, answers: Answers) -> Judged:
    """Judge whether ten runs fix the tipping point to +- NEARLY."""
    low, high = tipping_interval(data)
    right = "yes" if high - low <= 2 * NEARLY + 1e-9 else "no"
    return one_of([right], "look how far apart the ends of your interval are.")


ALL = tuple(f"bonus {bonus:g}" for bonus in BONUSES)
LAB = Lab(
    number=9,
    conditions=tuple(condition(bonus, "strategy:evolve") for bonus in BONUSES),
    statements={
        "observed": Statement(5, ALL, observed),
        "against": Statement(6, ALL, against_prediction),
        "further": larger(5, "metres", ENDS),
        "p": p_value(4, "metres", ENDS),
        "enough": Statement(5, ALL, enough),
    },
    measures={"metres": 0.01, "ground": 0.01, "statue": 0.01},
    reference=reference,
    unseen=(condition(0.0), condition(1.0)),
    columns=(
        Column(np.median, "metres", 0.06, 0.01),
        Column(interval, "metres", 0.1),
        Column(np.sum, "statue", 0.01),
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
    shown=ENDS,
    separate=separate,
    redone=8,
    strategy="ex08_openai_es/openai_es.py",
)
