"""Laboratory 6."""

import sys
from pathlib import Path

import numpy as np

from botschool.labs.measuring import interval
from lab_answers import WHY, which

SOLUTION = Path(__file__).parents[2] / "solutions" / "ex06_foraging_robot"
PREDICTIONS = {
    "families-expected": 4,
    "better-expected": "LSTM",
    "lost-expected": 0.5,
    "why": WHY,
}
HONEST = [("Ada", {}), ("Bo", {"families-expected": 20}), ("Cy", {"lost-expected": 0.1})]
PARTS = 20
MEASURE = """
def mean(values):
    return float(np.mean(values)) if len(values) else 0.0


def describe(poses, near):
    search = int(np.argmax(near)) if np.any(near) else len(near)
    steps = np.diff(poses, axis=0)
    ahead = steps[:, 0] * np.cos(poses[:-1, 2]) + steps[:, 1] * np.sin(poses[:-1, 2])
    turned = np.angle(np.exp(1j * steps[:, 2]))
    away = np.array(CYLINDER) - poses[1:, :2]
    side = np.sin(np.arctan2(away[:, 1], away[:, 0]) - poses[1:, 2])
    return search, mean(ahead[:search]), mean(turned[:search]), mean(side[near])


def measure(run):
    ordinary, without = forage(run), forage(run, forget=True)
    told = np.mean([describe(each["poses"], each["rewards"] > 0) for each in ordinary], axis=0)
    keep, lose = (np.mean([each["rewards"].sum() for each in e]) for e in (ordinary, without))
    return {"return": keep, "lost": 1 - lose / keep if keep else 0.0, "search": told[0],
            "speed": told[1], "turning": told[2], "side": told[3]}
"""
SHOWN = ""
DRAWN = ("turning", "kind", "turning (rad a step)")


def conclusions(place, data):
    sys.path.append(str(SOLUTION))
    from foraging_robot import families

    kinds = ("LSTM", "feed-forward")
    names = ("search", "speed", "turning", "side")
    rows = [np.stack([data[kind][name] for name in names], axis=1) for kind in kinds]
    labels = families(np.concatenate(rows), 2)
    first, second = set(labels[: len(rows[0])]), set(labels[len(rows[0]) :])
    low, high = interval(data["LSTM"]["lost"], np.mean)
    better, p = which(data["LSTM"]["return"], data["feed-forward"]["return"], kinds)
    return {
        "families": len(set(labels)),
        "mixed": "yes" if first & second else "no",
        "better": better,
        "p": p,
        "lost": "more" if low > 0.8 else "less" if high < 0.8 else "my runs cannot tell",
    }
