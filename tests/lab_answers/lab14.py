"""Laboratory 14 as a simulated student does it."""

from functools import cache

from botschool.labs.measuring import permutation_test, seconds_per_million
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
HONEST = [("Ada", {}), ("Fay", {}), ("Cy", {"predicted-long": "gradient"})]
SLOWER = {"Cy": 3.0}
"""How many times as slow a student's machine is as this one."""
PROBLEMS = ("dense", "sparse", "long")
METHODS = ("evolution", "gradient")


@cache
def seconds(problem, method):
    """Measured on this machine."""
    return float(f"{seconds_per_million(14, f'{problem} {method}'):.3g}")


def needs_less(one, other):
    winner = "evolution" if one.mean() < other.mean() else "gradient"
    return winner if permutation_test(one, other) < 0.05 else "my runs cannot tell"


def conclusions(place, data):
    found, changes = {}, 0
    for problem in PROBLEMS:
        one, other = (data[f"{problem} {method}"]["steps"] for method in METHODS)
        slower = SLOWER.get(place.sheet().text_of("name"), 1.0)
        speeds = [slower * seconds(problem, method) for method in METHODS]
        found[problem] = needs_less(one, other)
        for method, each in zip(METHODS, speeds, strict=True):
            found[f"seconds-{problem}-{method}"] = each
        changes += found[problem] != needs_less(one * speeds[0], other * speeds[1])
    p = permutation_test(data["long evolution"]["steps"], data["long gradient"]["steps"])
    return found | {"p": f"{p:.4f}", "changes": changes}
