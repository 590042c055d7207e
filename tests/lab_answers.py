"""How a simulated student does each laboratory: `STUDENTS` by its number.

What he computes is written anew here, in another way than in the laboratory.
"""

import shutil
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from botschool.labs.measuring import interval, paired_test, permutation_test, seconds_per_million

SOLUTIONS = Path(__file__).parents[1] / "solutions"
UNKNOWN = "my runs cannot tell"


@dataclass
class Does:
    """What a student writes."""

    parts: int
    """How many times smaller the budgets of the proofs are."""
    measure: str
    """The functions of measure.py."""
    conclude: Callable
    """Returns the answers after the table: of the measurements, and of all predictions."""
    prepare: Callable = lambda folder: None
    """What he does between `start` and `run`."""
    mark: Callable = lambda data: ""
    """Returns code that marks the result in the figure."""


STUDENTS: dict[int, Does] = {}


def which(a, b, labels, test=permutation_test):
    """The answer which of two groups has the larger mean, and the p of the test."""
    p = test(a, b)
    return (labels[int(a.mean() < b.mean())] if p < 0.05 else UNKNOWN), f"{p:.4f}"


def mean_of(data, measure, other, start=""):
    """The mean difference of two measures, over all runs."""
    apart = [v[measure] - v[other] for name, v in data.items() if name.startswith(start)]
    return f"{np.concatenate(apart).mean():.3f}"


def side(values, bound, above, below):
    """Where the interval of a mean lies."""
    low, high = interval(values, np.mean)
    return above if low > bound else below if high < bound else UNKNOWN


def lab03(data, predicted):
    few, many = "4 individuals", "100 individuals"
    poles = [data[f"CartPole {size}"]["evaluations"] for size in (4, 100)]
    pendulums = [data[f"Pendulum {size}"]["fresh"] for size in (4, 100)]
    found = {"lost": mean_of(data, "reported", "fresh", "Pendulum")}
    found["cartpole"], found["p-cartpole"] = which(*poles, (many, few))
    found["pendulum"], found["p-pendulum"] = which(*pendulums, (few, many))
    return found


STUDENTS[3] = Does(20, """
def measure(run):
    post = run["stat"][:, 2]
    solved = (post >= 475).any()
    first = (post >= 475).argmax() + 1 if solved else len(post)
    return {"reported": post[-1], "fresh": play_again(run, seed=1, episodes=100).mean(),
            "evaluations": first * run["experiment"]["algo"]["popsize"], "solved": int(solved)}
""", lab03)  # fmt: skip


def lab04(data, predicted):
    found = {"luck": mean_of(data, "reported", "fresh", "Acrobot")}
    for problem in ("Acrobot", "Pendulum"):
        base = data[f"{problem} base"]
        p = {
            name.split()[1]: permutation_test(base["fresh"], values["fresh"], seed=4)
            for name, values in data.items()
            if name.startswith(problem) and not name.endswith("base")
        }
        least = min(p, key=p.get)
        found[problem.lower()] = least if p[least] < 0.05 / 6 else UNKNOWN
    ranking = 16 * np.mean(base["spread"]) ** 2 / np.var(base["fresh"], ddof=1)
    return found | {"count": sum(each < 0.05 / 6 for each in p.values()), "episodes": ranking}


STUDENTS[4] = Does(10, """
def measure(run):
    found = play_again(run, seed=1, episodes=100)
    return {"reported": run["stat"][-1][2], "fresh": found.mean(), "spread": found.std(ddof=1)}
""", lab04)  # fmt: skip


def lab05(data, predicted):
    bodies = "its own", "the others'"
    pairs = {stage: (v["own"], v["swapped"]) for stage, v in data.items()}
    losses = [own - swapped for own, swapped in pairs.values()]
    return {
        "early": which(*pairs["early"], bodies, paired_test)[0],
        "late": which(*pairs["late"], bodies, paired_test)[0],
        "p-paired": f"{paired_test(*pairs['early'], seed=9):.4f}",
        "p-groups": f"{permutation_test(*pairs['early'], seed=9):.4f}",
        "grows": which(*losses, ("early", "late"))[0],
    }


STUDENTS[5] = Does(4, """
def measure(run):
    def earned(genotype):
        return play_again(run | {"genotype": genotype}, seed=1, episodes=10).mean()

    mine = run["genotype"].copy()
    own, rows = earned(mine), []
    for other in run["others"]:
        mine[-BODY:] = other[-BODY:]
        rows.append(earned(mine))
    return {"own": own, "swapped": np.mean(rows)}
""", lab05)  # fmt: skip


def lab06(data, predicted):
    sys.path.append(str(SOLUTIONS / "ex06_foraging_robot"))
    from foraging_robot import families

    kinds, names = ("LSTM", "feed-forward"), ("search", "speed", "turning", "side")
    rows = [np.stack([data[kind][name] for name in names], axis=1) for kind in kinds]
    labels = families(np.concatenate(rows), 2)
    first, second = set(labels[: len(rows[0])]), set(labels[len(rows[0]) :])
    better, p = which(data["LSTM"]["return"], data["feed-forward"]["return"], kinds)
    return {
        "families": len(set(labels)),
        "mixed": "yes" if first & second else "no",
        "better": better,
        "p": p,
        "lost": side(data["LSTM"]["lost"], 0.8, "more", "less"),
    }


STUDENTS[6] = Does(20, """
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
""", lab06)  # fmt: skip


def lab07(data, predicted):
    rng, last = np.random.default_rng(7), data["late"]
    groups = [data[stage]["upright"] for stage in ("early", "middle", "late")]
    drawn = [[rng.choice(each, len(each)).mean() for each in groups] for _ in range(4000)]
    early, middle, late = np.transpose(drawn)
    low, high = np.percentile((middle - early) - (late - middle), [2.5, 97.5])
    better, p = which(data["middle"]["return"], last["return"], ("middle", "late"))
    return {
        "when": "early to middle" if low > 0 else "middle to late" if high < 0 else UNKNOWN,
        "better": better,
        "p": p,
        "gravity": which(last["return"], last["heavy"], ("10", "12"), paired_test)[0],
        "survivors": sum(last["heavy_upright"] > 0.5),
    }


STUDENTS[7] = Does(4, """
def measure(run):
    found = {}
    for name, share, gravity in (("return", "upright", 10.0), ("heavy", "heavy_upright", 12.0)):
        seen = swing(run, gravity=gravity)
        found[name] = np.mean([sum(each) for each in seen["rewards"]])
        found[share] = np.mean([max(abs(each[-50:])) < 0.3 for each in seen["angles"]])
    return found
""", lab07)  # fmt: skip


def copy_strategy(folder):
    shutil.copy(SOLUTIONS / "ex08_openai_es" / "openai_es.py", folder / "strategy.py")


def lab08(data, predicted):
    short, middle = data["hopper 0.01"], data["hopper 0.03"]
    hopper, p = which(short["fresh"], middle["fresh"], ("0.01", "0.03"))
    pendulums = data["Pendulum 0.1"]["fresh"], data["Pendulum 0.5"]["fresh"]
    rng = np.random.default_rng(8)
    again = [
        permutation_test(rng.choice(short["fresh"], 5), rng.choice(middle["fresh"], 5)) < 0.05
        for _ in range(300)
    ]
    return {
        "drops": which(short["drop"], data["hopper 0.1"]["drop"], ("0.01", "0.1"))[0],
        "hopper": hopper,
        "p-hopper": p,
        "power": f"{100 * np.mean(again):.0f}",
        "pendulum": which(*pendulums, ("0.1", "0.5"))[0],
    }


STUDENTS[8] = Does(20, """
def measure(run):
    average = run["stat"][:, 4]
    width = min(20, len(average))
    curve = np.array([average[i : i + width].mean() for i in range(len(average) - width + 1)])
    fall = max(curve[: i + 1].max() - curve[i] for i in range(len(curve)))
    drop = fall / np.ptp(curve) if np.ptp(curve) else 0.0
    fresh = play_again(run, seed=1, episodes=100).mean()
    return {"drop": drop, "severe": int(drop > 0.3), "fresh": fresh}
""", lab08, copy_strategy)  # fmt: skip


def tipping(data):
    """The tipping point of the runs, and the interval of those of resampled ones."""
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


def mark09(data):
    found = tipping(data)[0]
    return "" if found == 0.3 else f"axes.axvline({found})\n    "


def lab09(data, predicted):
    found, (low, high) = tipping(data)
    bound, ends = predicted["tipping"], ("bonus 0", "bonus 0.2")
    further, p = which(*(data[name]["metres"] for name in ends), ends)
    return {
        "observed": found,
        "against": "below" if high < bound else "above" if low > bound else UNKNOWN,
        "further": further,
        "p": p,
        "enough": "yes" if high - low <= 0.0401 else "no",
    }


STUDENTS[9] = Does(100, """
def measure(run):
    seen = record(run, seed=1)
    metres = seen["distance"][0] - seen["distance"][-1]
    return {"metres": metres, "ground": seen["feet"].mean(), "statue": int(metres < RULE)}
""", lab09, copy_strategy, mark09)  # fmt: skip

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


def lab12(data, predicted):
    few = {name: values["episodes"] for name, values in data.items()}
    elite, p_elite = which(few["elite 90"], few["elite 50"], ("percentile 50", "percentile 90"))
    best, p = which(few["reinforce"], few["elite 70"], ("cross-entropy", "REINFORCE"))
    found = {"elite": elite, "p-elite": p_elite, "reinforce": best, "p-reinforce": p}
    return found | {"all-solved": int(sum(values["solved"].sum() for values in data.values()))}


STUDENTS[12] = Does(2, """
def measure(run):
    solved = run["stat"][:, 3] >= 195
    at = solved.argmax() if solved.any() else -1
    return {"episodes": run["stat"][at, 5], "solved": int(solved.any())}
""", lab12, lambda folder: (folder / "learn.py").write_text(LEARN))  # fmt: skip


@cache
def seconds(condition):
    """Measured on this machine."""
    return float(f"{seconds_per_million(14, condition):.3g}")


def lab14(data, predicted):
    slower = 3 if predicted["predicted-changes"] == 2 else 1  # on another machine
    found, changes, methods = {}, 0, ("evolution", "gradient")
    for problem in ("dense", "sparse", "long"):
        steps = [data[f"{problem} {method}"]["steps"] for method in methods]
        speeds = [slower * seconds(f"{problem} {method}") for method in methods]
        found |= {f"seconds-{problem}-{m}": s for m, s in zip(methods, speeds, strict=True)}
        found[problem], p = which(*steps, methods[::-1])
        times = [each * speed for each, speed in zip(steps, speeds, strict=True)]
        changes += found[problem] != which(*times, methods[::-1])[0]
    return found | {"p": p, "changes": changes}


STUDENTS[14] = Does(20, """
def measure(run):
    stat = run["stat"]
    reached = stat[:, 2] >= GOALS[run["condition"].split()[0]]
    at = reached.argmax() if reached.any() else -1
    return {"steps": stat[at, 0], "reached": int(reached.any()),
            "fresh": play_again(run, seed=2, episodes=20).mean()}
""", lab14)  # fmt: skip


def lab15(data, predicted):
    who, p = which(data["random"]["global"], data["best"]["global"], ("random", "best"))
    return {
        "ancient": side(data["random"]["historical"], 0, "yes", "no, fewer"),
        "without": side(data["random"]["later"], 0, "yes", "no, fewer"),
        "due": mean_of(data, "historical", "later", "random"),
        "who": who,
        "p": p,
    }


STUDENTS[15] = Does(4, """
def measure(run):
    f = chases(run, best=5).mean(axis=(1, 3))
    def gain(f, ancient):
        total = 0.0
        for g in range(1, len(f)):
            total += (f[g] - f[g - 1])[:g if ancient else len(f)].mean()
        return total
    return {"historical": gain(f, True), "later": gain(f[1:, 1:], True), "global": gain(f, False)}
""", lab15)  # fmt: skip
