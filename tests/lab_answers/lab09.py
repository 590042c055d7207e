"""Laboratory 9."""

import numpy as np

from lab_answers import WHY, which
from lab_answers.lab08 import prepare as prepare

PREDICTIONS = {"tipping": 0.06, "both": "at each bonus", "why": WHY}
HONEST = [
    ("Ada", {"rule": 5.0, "tipping": 0}),
    ("Bo", {"rule": 2.0, "tipping": 0.3}),
    ("Cy", {"rule": 0.5, "tipping": 0.3}),
]
PARTS = 100
MEASURE = """
def measure(run):
    seen = record(run, seed=1)
    metres = seen["distance"][0] - seen["distance"][-1]
    return {"metres": metres, "ground": seen["feet"].mean(), "statue": int(metres < RULE)}
"""
SHOWN = "bonus"
DRAWN = ("metres", "bonus (reward per step)", "metres ahead (m)")


def tipping(data):
    """The tipping point of each resampled set of runs, and that of the runs themselves."""
    rng = np.random.default_rng(5)
    bonuses = [float(name.split()[1]) for name in data]
    groups = [values["statue"] for values in data.values()]

    def point(shares):
        found = 0.3
        for bonus, share in sorted(zip(bonuses, shares, strict=True), reverse=True):
            if share <= 0.5:
                break
            found = bonus
        return found

    again = [point([rng.choice(g, len(g)).mean() for g in groups]) for _ in range(2000)]
    return point([g.mean() for g in groups]), np.percentile(again, [2.5, 97.5], method="nearest")


def mark(data):
    found = tipping(data)[0]
    return "" if found == 0.3 else f"axes.axvline({found})\n    "


def conclusions(place, data):
    found, (low, high) = tipping(data)
    predicted = place.sheet().values(place.lab.predictions)[0]["tipping"]
    against = "below" if high < predicted else "above" if low > predicted else ""
    further, p = which(
        data["bonus 0"]["metres"], data["bonus 0.2"]["metres"], ("bonus 0", "bonus 0.2")
    )
    return {
        "observed": found,
        "against": against or "my runs cannot tell",
        "further": further,
        "p": p,
        "enough": "yes" if high - low <= 0.0401 else "no",
    }
