"""Laboratory 5."""

from botschool.labs.measuring import paired_test, permutation_test
from lab_answers import WHY, which

PREDICTIONS = {
    "early-expected": "its own",
    "late-expected": "its own",
    "swapped-expected": 10,
    "why": WHY,
}
HONEST = [("Ada", {}), ("Bo", {"swapped-expected": 60}), ("Cy", {"early-expected": "the others'"})]
PARTS = 4
MEASURE = """
def measure(run):
    def earned(genotype):
        return play_again(run | {"genotype": genotype}, seed=1, episodes=10).mean()

    mine = run["genotype"].copy()
    own, rows = earned(mine), []
    for other in run["others"]:
        mine[-BODY:] = other[-BODY:]
        rows.append(earned(mine))
    return {"own": own, "swapped": np.mean(rows)}
"""
SHOWN = ""
DRAWN = ("swapped", "stage", "return in the others' bodies")


def better(values):
    p = paired_test(values["own"], values["swapped"])
    where = "its own" if values["own"].mean() > values["swapped"].mean() else "the others'"
    return where if p < 0.05 else "my runs cannot tell"


def conclusions(place, data):
    early, late = data["early"], data["late"]
    losses = early["own"] - early["swapped"], late["own"] - late["swapped"]
    return {
        "early": better(early),
        "late": better(late),
        "p-paired": f"{paired_test(early['own'], early['swapped'], seed=9):.4f}",
        "p-groups": f"{permutation_test(early['own'], early['swapped'], seed=9):.4f}",
        "grows": which(*losses, ("early", "late"))[0],
    }
