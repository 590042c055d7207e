"""Laboratory 15."""

import numpy as np

from botschool.labs.measuring import interval
from lab_answers import WHY, which

PREDICTIONS = {
    "predicted-ancient": "yes",
    "predicted-who": "best",
    "predicted-gain": 0.5,
    "why": WHY,
}
HONEST = [("Ada", {}), ("Bo", {"predicted-gain": 1}), ("Cy", {"predicted-who": "random"})]
PARTS = 4
MEASURE = """
def measure(run):
    f = chases(run, best=5).mean(axis=(1, 3))
    def gain(f, ancient):
        total = 0.0
        for g in range(1, len(f)):
            total += (f[g] - f[g - 1])[:g if ancient else len(f)].mean()
        return total
    return {"historical": gain(f, True), "later": gain(f[1:, 1:], True), "global": gain(f, False)}
"""
SHOWN = ""
DRAWN = ("historical", "who evolves", "historical progress (fitness)")


def above(values):
    low, high = interval(values, np.mean)
    return "yes" if low > 0 else "no, fewer" if high < 0 else "my runs cannot tell"


def conclusions(place, data):
    random = data["random"]
    who, p = which(random["global"], data["best"]["global"], ("random", "best"))
    return {
        "ancient": above(random["historical"]),
        "without": above(random["later"]),
        "due": f"{(random['historical'] - random['later']).mean():.3f}",
        "who": who,
        "p": p,
    }
