"""Laboratory 14 as a simulated student does it."""

import numpy as np

from botschool.labs.measuring import permutation_test
from lab_answers import WHY

PARTS = 20
MEASURE = """
def measure(run):
    stat = run["stat"]
    reached = stat[:, 2] >= GOALS[run["condition"].split()[0]]
    at = reached.argmax() if reached.any() else -1
    return {"steps": stat[at, 0], "reached": int(reached.any()),
            "fresh": play_again(run, seed=2, episodes=20).mean()}
"""
DRAWN = "steps", "condition", "steps"
SHOWN = ""
PREDICTIONS = {
    "predicted-dense": "gradient",
    "predicted-sparse": "evolution",
    "predicted-long": "my runs cannot tell",
    "predicted-changes": 1,
    "why": WHY,
}
HONEST = [("Ada", {}), ("Bo", {"predicted-changes": 3}), ("Cy", {"predicted-long": "gradient"})]
SPEEDS = {
    "dense": {"evolution": 0.05, "gradient": 11},
    "sparse": {"evolution": 0.05, "gradient": 10},
    "long": {"evolution": 0.4, "gradient": 8},
}


def cells(values):
    return (
        f"{values['reached'].sum():.0f} | {np.median(values['steps']) / 1000:.2f} | "
        f"{np.median(values['fresh']):.2f}"
    )


def needs_less(one, other):
    winner = "evolution" if one.mean() < other.mean() else "gradient"
    return winner if permutation_test(one, other) < 0.05 else "my runs cannot tell"


def conclusions(place, data):
    found, changes = {}, 0
    for problem, speeds in SPEEDS.items():
        one, other = (data[f"{problem} {method}"]["steps"] for method in speeds)
        found[problem] = needs_less(one, other)
        found |= {f"seconds-{problem}-{method}": each for method, each in speeds.items()}
        changes += found[problem] != needs_less(
            one * speeds["evolution"], other * speeds["gradient"]
        )
    p = permutation_test(data["long evolution"]["steps"], data["long gradient"]["steps"])
    return found | {"p": f"{p:.4f}", "changes": changes}
