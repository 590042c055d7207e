"""Laboratory 7."""

import numpy as np

from botschool.labs.measuring import paired_test
from lab_answers import WHY, which

PREDICTIONS = {"when-expected": "early to middle", "survivors-expected": 7, "why": WHY}
HONEST = [
    ("Ada", {}),
    ("Bo", {"survivors-expected": 2}),
    ("Cy", {"when-expected": "middle to late"}),
]
PARTS = 4
MEASURE = """
def measure(run):
    found = {}
    for name, share, gravity in (("return", "upright", 10.0), ("heavy", "heavy_upright", 12.0)):
        seen = swing(run, gravity=gravity)
        found[name] = np.mean([sum(each) for each in seen["rewards"]])
        found[share] = np.mean([max(abs(each[-50:])) < 0.3 for each in seen["angles"]])
    return found
"""
SHOWN = ""
DRAWN = ("return", "stage", "mean return")


def conclusions(place, data):
    rng = np.random.default_rng(7)
    groups = [data[stage]["upright"] for stage in ("early", "middle", "late")]
    drawn = [[rng.choice(each, len(each)).mean() for each in groups] for _ in range(4000)]
    early, middle, late = np.transpose(drawn)
    low, high = np.percentile((middle - early) - (late - middle), [2.5, 97.5])
    when = "early to middle" if low > 0 else "middle to late" if high < 0 else ""
    last = data["late"]
    told = paired_test(last["return"], last["heavy"]) < 0.05
    gravity = "10" if last["return"].mean() > last["heavy"].mean() else "12"
    better, p = which(data["middle"]["return"], last["return"], ("middle", "late"))
    return {
        "when": when or "my runs cannot tell",
        "better": better,
        "p": p,
        "gravity": gravity if told else "my runs cannot tell",
        "survivors": sum(last["heavy_upright"] > 0.5),
    }
