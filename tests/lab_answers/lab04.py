"""Laboratory 4."""

import numpy as np

from botschool.labs.measuring import permutation_test
from lab_answers import WHY

PREDICTIONS = {
    "first-acrobot": "nhiddens",
    "first-pendulum": "stepsize",
    "luck-expected": 10,
    "why": WHY,
}
HONEST = [("Ada", {}), ("Bo", {"first-acrobot": "none"}), ("Cy", {"luck-expected": 50})]
PARTS = 10
MEASURE = """
def measure(run):
    found = play_again(run, seed=1, episodes=100)
    return {"reported": run["stat"][-1][2], "fresh": found.mean(), "spread": found.std(ddof=1)}
"""
SHOWN = "Pendulum"
DRAWN = ("fresh", "setting", "mean return in new episodes")


def conclusions(place, data):
    found, counted = {}, {}
    for problem in ("Acrobot", "Pendulum"):
        base = data[f"{problem} base"]["fresh"]
        p = {
            name.split()[1]: permutation_test(base, values["fresh"], seed=4)
            for name, values in data.items()
            if name.startswith(problem) and not name.endswith("base")
        }
        least = min(p, key=p.get)
        found[problem] = least if p[least] < 0.05 / 6 else "my runs cannot tell"
        counted[problem] = sum(each < 0.05 / 6 for each in p.values())
    luck = [v["reported"] - v["fresh"] for n, v in data.items() if n.startswith("Acrobot")]
    base = data["Pendulum base"]
    return {
        "acrobot": found["Acrobot"],
        "pendulum": found["Pendulum"],
        "count": counted["Pendulum"],
        "luck": f"{np.concatenate(luck).mean():.2f}",
        "episodes": f"{16 * np.mean(base['spread']) ** 2 / np.var(base['fresh'], ddof=1):.0f}",
    }
