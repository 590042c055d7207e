"""Simulated students of the laboratories: they predict, run, measure, draw and conclude."""

import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np

from botschool.labs.declare import load_lab
from botschool.labs.folder import Place, start
from botschool.labs.measuring import interval, permutation_test
from botschool.labs.runs import make_runs, own_runs

WHY = "Because a reward for standing is earned without any risk of falling over while moving on."
MEASURE = {
    9: """
def measure(run):
    seen = record(run, seed=1)
    metres = seen["distance"][0] - seen["distance"][-1]
    return {"metres": metres, "ground": seen["feet"].mean(), "statue": int(metres < RULE)}
""",
    3: """
def measure(run):
    post = run["stat"][:, 2]
    solved = (post >= 475).any()
    first = (post >= 475).argmax() + 1 if solved else len(post)
    return {"reported": post[-1], "fresh": play_again(run, seed=1, episodes=100).mean(),
            "evaluations": first * run["experiment"]["algo"]["popsize"], "solved": int(solved)}
""",
}
DRAWN = {9: ("metres", "bonus (reward per step)", "metres ahead (m)"),
         3: ("fresh", "individuals", "mean return in new episodes")}  # fmt: skip
SHOWN = {9: "bonus", 3: "Pendulum"}
PREDICTIONS = {
    9: {"tipping": 0.75, "both": "at each bonus", "why": WHY},
    3: {"best-cartpole": "4", "best-pendulum": "100", "fresh-20": -300, "why": WHY},
}


def small(number, replications=4):
    """The laboratory with small budgets."""
    lab = load_lab(number)
    parts = {9: 100, 3: 20}[number]
    return replace(
        lab,
        conditions=tuple(c.shortened(parts) for c in lab.conditions),
        unseen=tuple(c.shortened(parts) for c in lab.unseen),
        replications=replications,
        redone=2,
    )


def fill(text, id, value):
    """The sheet's text with a field answered, as an editor would do it."""
    head, marker, rest = text.partition(f"<!-- field: {id} -->")
    assert marker, id
    end = re.search(r"<!-- field|^## |\Z", rest, re.MULTILINE).start()
    field, rest = rest[:end], rest[end:]
    line = field.lstrip().startswith("answer:")
    if not line and ("[ ]" in field or "[x]" in field):
        field = field.replace("[x]", "[ ]")
        filled = re.sub(rf"\[ \] {re.escape(value)}(?=\s|$)", f"[x] {value}", field, count=1)
    elif line:
        filled = re.sub(r"answer:[^\n]*", f"answer: {value}", field, count=1)
    else:
        filled = re.sub(r"^>.*$", f"> {value}", field, count=1, flags=re.MULTILINE)
    assert filled != field or str(value) in field, (id, value, field)
    return head + marker + filled + rest


def edit(place, change):
    """Change the sheet's text."""
    path = place.folder / "sheet.md"
    path.write_text(change(path.read_text()))


def answer(place, answers):
    for id, value in answers.items():
        edit(place, lambda text, id=id, value=value: fill(text, id, value))


def skeleton_filled(place, rule=5.0):
    """Write measure.py and figure.py."""
    number = place.lab.number
    path = place.folder / "measure.py"
    head, main = path.read_text().split("def measure(", 1)[0], path.read_text().split("if __name")
    path.write_text(
        head.replace("RULE = 5.0", f"RULE = {rule}") + MEASURE[number] + "\n\nif __name" + main[1]
    )
    y, x_name, y_name = DRAWN[number]
    path = place.folder / "figure.py"
    main = path.read_text().split("if __name")[1]
    path.write_text(
        f"""from matplotlib.figure import Figure


def figure(measurements):
    picture = Figure(layout="constrained")
    axes = picture.subplots()
    for name, values in measurements.items():
        if name.startswith("{SHOWN[number]}"):
            x = float(name.split()[1])
            axes.plot([x] * len(values["{y}"]), values["{y}"], "o", alpha=0.6)
    axes.set_xlabel("{x_name}")
    axes.set_ylabel("{y_name}")
    return picture


if __name"""
        + main
    )


def measured(place):
    """What measure.py gives: condition -> measure -> array; our own file, run here."""
    space = {"__name__": "measure"}
    exec((place.folder / "measure.py").read_text(), space)
    found = {}
    for name, runs in own_runs(place.lab, place.sheet(), place.runs).items():
        rows = [space["measure"](run.plain()) for run in runs]
        found[name] = {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}
    return found


def table(place, data):
    """Fill in the table."""
    for name, values in data.items():
        if place.lab.number == 9:
            low, high = interval(values["metres"])
            cells = f"{np.median(values['metres']):.2f} | {low:.2f} to {high:.2f} | "
            cells += f"{values['statue'].sum():.0f}"
        else:
            low, high = interval(values["fresh"])
            cells = f"{values['solved'].sum():.0f} | {np.median(values['evaluations']):g} | "
            cells += f"{np.median(values['fresh']):.1f} | {low:.1f} to {high:.1f}"
        edit(
            place,
            lambda text, n=name, c=cells: re.sub(
                rf"^\| {re.escape(n)} \|.*$", f"| {n} | {c} |", text, flags=re.MULTILINE
            ),
        )


def which(a, b, labels):
    p = permutation_test(a, b)
    return (labels[int(a.mean() < b.mean())] if p < 0.05 else "my runs cannot tell"), f"{p:.4f}"


def tipping(data):
    """The tipping point of each resampled set of runs, and that of the runs themselves."""
    rng = np.random.default_rng(5)
    bonuses = [float(name.split()[1]) for name in data]
    groups = [values["statue"] for values in data.values()]

    def point(shares):
        found = 3.0
        for bonus, share in sorted(zip(bonuses, shares, strict=True), reverse=True):
            if share <= 0.5:
                break
            found = bonus
        return found

    again = [point([rng.choice(g, len(g)).mean() for g in groups]) for _ in range(2000)]
    return point([g.mean() for g in groups]), np.percentile(again, [2.5, 97.5], method="nearest")


def conclusions(place, data):
    """The answers that follow from the student's own data."""
    if place.lab.number == 9:
        found, (low, high) = tipping(data)
        predicted = place.sheet().values(place.lab.predictions)[0]["tipping"]
        against = "below" if high < predicted else "above" if low > predicted else ""
        further, p = which(
            data["bonus 0"]["metres"], data["bonus 2"]["metres"], ("bonus 0", "bonus 2")
        )
        return {
            "observed": found,
            "against": against or "my runs cannot tell",
            "further": further,
            "p": p,
            "enough": "yes" if high - low <= 0.5 else "no",
        }
    few, many = "4 individuals", "100 individuals"
    cart, p_cart = which(
        data["CartPole 4"]["evaluations"], data["CartPole 100"]["evaluations"], (many, few)
    )
    pendulum, p_pendulum = which(
        data["Pendulum 4"]["fresh"], data["Pendulum 100"]["fresh"], (few, many)
    )
    luck = [v["reported"] - v["fresh"] for n, v in data.items() if n.startswith("Pendulum")]
    return {
        "cartpole": cart,
        "p-cartpole": p_cart,
        "pendulum": pendulum,
        "p-pendulum": p_pendulum,
        "lost": f"{np.concatenate(luck).mean():.2f}",
    }


def predicted(lab, folder, name="Ada", **predictions):
    """A laboratory that is started, with a prediction."""
    place = Place(lab, Path(folder) / lab.name)
    start(place, name, "botschool")
    answer(place, PREDICTIONS[lab.number] | predictions)
    return place


def conclude(place, rule=5.0):
    """Measure, draw and conclude, all from the runs that are there."""
    skeleton_filled(place, rule)
    if place.lab.number == 9:
        answer(place, {"rule": rule})
    data = measured(place)
    table(place, data)
    answer(place, conclusions(place, data) | {"words": "The spread surprised me."})
    return data


def honest(lab, folder, name="Ada", rule=5.0, workers=1, **predictions):
    """A laboratory done from beginning to end."""
    place = predicted(lab, folder, name, **predictions)
    assert make_runs(lab, place.sheet(), place.runs, workers, lab.replications)
    conclude(place, rule)
    return place


def copied(place, folder):
    """A copy of a finished laboratory, to spoil."""
    shutil.copytree(place.folder, Path(folder) / place.lab.name)
    return Place(place.lab, Path(folder) / place.lab.name)
