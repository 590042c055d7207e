"""Laboratory 8."""

import shutil
from pathlib import Path

import numpy as np

from botschool.labs.measuring import permutation_test
from lab_answers import WHY, which

SOLUTION = Path(__file__).parents[2] / "solutions" / "ex08_openai_es" / "openai_es.py"
PREDICTIONS = {"best-hopper": "0.01", "best-pendulum": "0.1", "severe": 4, "why": WHY}
HONEST = [("Ada", {}), ("Bo", {"severe": 0}), ("Cy", {"best-pendulum": "no difference"})]
PARTS = 20
MEASURE = """
def measure(run):
    average = run["stat"][:, 4]
    width = min(20, len(average))
    curve = np.array([average[i : i + width].mean() for i in range(len(average) - width + 1)])
    fall = max(curve[: i + 1].max() - curve[i] for i in range(len(curve)))
    drop = fall / np.ptp(curve) if np.ptp(curve) else 0.0
    fresh = play_again(run, seed=1, episodes=100).mean()
    return {"drop": drop, "severe": int(drop > 0.3), "fresh": fresh}
"""
SHOWN = "hopper"
DRAWN = ("drop", "step size", "drop (share of the curve's height)")


def prepare(place):
    shutil.copy(SOLUTION, place.folder / "strategy.py")


def conclusions(place, data):
    short, middle = data["hopper 0.01"], data["hopper 0.03"]
    drops, _ = which(short["drop"], data["hopper 0.1"]["drop"], ("0.01", "0.1"))
    hopper, p = which(short["fresh"], middle["fresh"], ("0.01", "0.03"))
    pendulums = data["Pendulum 0.1"]["fresh"], data["Pendulum 0.5"]["fresh"]
    rng = np.random.default_rng(8)
    again = [
        permutation_test(rng.choice(short["fresh"], 5), rng.choice(middle["fresh"], 5)) < 0.05
        for _ in range(300)
    ]
    return {
        "drops": drops,
        "hopper": hopper,
        "p-hopper": p,
        "power": f"{100 * np.mean(again):.0f}",
        "pendulum": which(*pendulums, ("0.1", "0.5"))[0],
    }
