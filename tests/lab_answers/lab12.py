"""Laboratory 12."""

from lab_answers import WHY, which

PREDICTIONS = {
    "predicted-elite": "percentile 90",
    "predicted-reinforce": "REINFORCE",
    "predicted-episodes": 800,
    "why": WHY,
}
HONEST = [("Ada", {}), ("Bo", {"predicted-episodes": 99}), ("Cy", {"predicted-episodes": 5000})]
PARTS = 2
LEARN = """
import numpy as np

def elite_weights(rewards, percentile):
    returns = np.array([each.sum() for each in rewards])
    bound = np.percentile(returns, percentile)
    return [np.full(len(each), float(each.sum() >= bound)) for each in rewards]

def reinforce_weights(rewards, gamma):
    found = []
    for each in rewards:
        left, following = np.zeros(len(each)), 0.0
        for step in reversed(range(len(each))):
            left[step] = following = each[step] + gamma * following
        found.append(left)
    baseline = np.concatenate(found).mean()
    return [each - baseline for each in found]
"""
MEASURE = """
def measure(run):
    solved = run["stat"][:, 3] >= 195
    at = solved.argmax() if solved.any() else -1
    return {"episodes": run["stat"][at, 5], "solved": int(solved.any())}
"""
SHOWN = ""
DRAWN = ("episodes", "rule", "episodes until solved")


def prepare(place):
    (place.folder / "learn.py").write_text(LEARN)


def conclusions(place, data):
    few = {name: values["episodes"] for name, values in data.items()}
    elite, p_elite = which(few["elite 90"], few["elite 50"], ("percentile 50", "percentile 90"))
    best, p = which(few["reinforce"], few["elite 70"], ("cross-entropy", "REINFORCE"))
    return {
        "elite": elite,
        "p-elite": p_elite,
        "reinforce": best,
        "p-reinforce": p,
        "all-solved": int(sum(values["solved"].sum() for values in data.values())),
    }
