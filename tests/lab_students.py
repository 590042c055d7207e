"""Simulated students of the laboratories: they predict, run, measure, draw and conclude."""

import re
import shutil
from contextlib import redirect_stdout
from dataclasses import replace
from importlib import import_module
from io import StringIO
from pathlib import Path
from unittest.mock import patch

import numpy as np

from botschool.labs import measuring
from botschool.labs.declare import load_lab
from botschool.labs.folder import Place, start
from botschool.labs.runs import make_runs, own_runs
from botschool.labs.saved import plain_runs


def student(number):
    """Return the module that describes how to do the laboratory."""
    return import_module(f"lab_answers.lab{number:02}")


def small(number, replications=5):
    """Return the laboratory with small budgets."""
    lab, parts = load_lab(number), student(number).PARTS
    return replace(
        lab,
        conditions=tuple(c.shortened(parts) for c in lab.conditions),
        unseen=tuple(c.shortened(parts) for c in lab.unseen),
        replications=replications,
        redone=2,
    )


def fill(text, id, value):
    """Return the sheet's text with a field filled in, as in an editor."""
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
    does = student(place.lab.number)
    path = place.folder / "measure.py"
    head, main = path.read_text().split("def measure(", 1)[0], path.read_text().split("if __name")
    path.write_text(
        head.replace("RULE = 5.0", f"RULE = {rule}") + does.MEASURE + "\n\nif __name" + main[1]
    )
    y, x_name, y_name = does.DRAWN
    places = {condition.name: condition.x for condition in place.lab.conditions}
    path = place.folder / "figure.py"
    main = path.read_text().split("if __name")[1]
    path.write_text(
        f"""from matplotlib.figure import Figure


def figure(measurements):
    picture = Figure(layout="constrained")
    axes = picture.subplots()
    places = {places}
    for name, values in measurements.items():
        if name.startswith("{does.SHOWN}"):
            x = places[name]
            axes.plot([x] * len(values["{y}"]), values["{y}"], "o", alpha=0.6)
    axes.set_xlabel("{x_name}")
    axes.set_ylabel("{y_name}")
    return picture


if __name"""
        + main
    )


def measured(place):
    """Return the result of measure.py: condition -> measure -> array; our own file, run here."""
    space = {"__name__": "measure"}
    exec((place.folder / "measure.py").read_text(), space)
    found = {}
    for name, runs in own_runs(place.lab, place.sheet(), place.runs).items():
        rows = [space["measure"](run) for run in plain_runs(runs, place.lab.others)]
        found[name] = {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}
    return found


def table(place, data):
    """Fill in the table with the rows that measure.py prints; what takes long is left out."""
    given = {
        "measure_all": lambda measure: data,
        "power": lambda *groups, runs: 0.5,
        "seconds_per_million": lambda number, condition: 1.0,
    }
    with patch.multiple(measuring, **given), redirect_stdout(StringIO()) as printed:
        exec((place.folder / "measure.py").read_text(), {"__name__": "__main__"})
    rows = [line for line in printed.getvalue().splitlines() if line.startswith("| ")]
    assert len(rows) == len(data)
    for row in rows:
        name = row.split("|")[1].strip()
        edit(place, lambda text, n=name, r=row: row_of(n).sub(r, text))


def row_of(name):
    return re.compile(rf"^\| {re.escape(name)} \|.*$", re.MULTILINE)


def predicted(lab, folder, name="Ada", **predictions):
    """Start a laboratory and write a prediction."""
    place, does = Place(lab, Path(folder) / lab.name), student(lab.number)
    start(place, name, "botschool")
    answer(place, does.PREDICTIONS | predictions)
    if hasattr(does, "prepare"):
        does.prepare(place)
    return place


def conclude(place, rule=5.0):
    """Measure, draw and conclude, all from the existing runs."""
    skeleton_filled(place, rule)
    if any(field.id == "rule" for field in place.lab.fields):
        answer(place, {"rule": rule})
    data = measured(place)
    table(place, data)
    if hasattr(student(place.lab.number), "mark"):
        path, line = place.folder / "figure.py", student(place.lab.number).mark(data)
        path.write_text(path.read_text().replace("return picture", f"{line}return picture"))
    answer(place, student(place.lab.number).conclusions(place, data))
    answer(place, {"words": "The spread surprised me."})
    return data


def honest(lab, folder, name="Ada", rule=5.0, workers=1, **predictions):
    """Do a laboratory from beginning to end."""
    place = predicted(lab, folder, name, **predictions)
    assert make_runs(lab, place.sheet(), place.runs, workers, lab.replications)
    conclude(place, rule)
    return place


def copied(place, folder):
    """Copy a finished laboratory, to spoil the copy."""
    shutil.copytree(place.folder, Path(folder) / place.lab.name)
    return Place(place.lab, Path(folder) / place.lab.name)
