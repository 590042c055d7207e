"""Simulated students of the laboratories: they predict, run, measure, draw and conclude."""

import re
import shutil
from contextlib import redirect_stdout
from dataclasses import replace
from io import StringIO
from pathlib import Path
from unittest.mock import patch

import numpy as np

from botschool.labs import measuring
from botschool.labs.declare import load_lab
from botschool.labs.folder import Place, start
from botschool.labs.runs import make_runs, own_runs
from botschool.labs.saved import plain_runs
from lab_answers import STUDENTS

WHY = "Because a reward for standing is earned without any risk of falling over while moving on."
PEOPLE = ("Ada", "Bo", "Cy")
RULES = {"Ada": 5.0, "Bo": 2.0, "Cy": 0.5}
"""Laboratory 9: the rule of each student."""


def small(number, replications=5):
    """Return the laboratory with small budgets."""
    lab, parts = load_lab(number), STUDENTS[number].parts
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
    if field.lstrip().startswith("answer:"):
        filled = re.sub(r"answer:[^\n]*", f"answer: {value}", field, count=1)
    elif "[ ]" in field:
        field = field.replace("[x]", "[ ]")
        filled = re.sub(rf"\[ \] {re.escape(value)}(?=\s|$)", f"[x] {value}", field, count=1)
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


def offered(place, id):
    """The answers of a choice."""
    return re.findall(r"\[.\] (.+?)(?=   |$)", place.sheet().raw(id), re.MULTILINE)


def guesses(place, name="Ada"):
    """The predictions of one of PEOPLE; of the others, those of the first."""
    number = PEOPLE.index(name) if name in PEOPLE else 0
    found = {}
    for id, field in place.lab.fields.items():
        if field.predicts:
            choices = offered(place, id)
            choice = choices[number % len(choices)] if choices else WHY
            found[id] = number if field.kind == "number" else choice
    return found


def predicted(lab, folder, name="Ada"):
    """Start a laboratory and write a prediction."""
    place = Place(lab, Path(folder) / lab.name)
    start(place, name, "botschool")
    answer(place, guesses(place, name))
    STUDENTS[lab.number].prepare(place.folder)
    return place


def programs(place, mark=""):
    """Write measure.py and figure.py; mark: code that marks the result."""
    does, rule = STUDENTS[place.lab.number], RULES.get(place.sheet().text_of("name"), 5.0)
    path = place.folder / "measure.py"
    head, rest = path.read_text().split("def measure(", 1)
    head = head.replace("RULE = 5.0", f"RULE = {rule}")
    path.write_text(f"{head}{does.measure}\n\nif __name{rest.split('if __name')[1]}")
    shown = place.lab.figure
    path = place.folder / "figure.py"
    path.write_text(
        f"""from matplotlib.figure import Figure


def figure(measurements):
    picture = Figure(layout="constrained")
    axes = picture.subplots()
    for x, (name, values) in enumerate(measurements.items()):
        if name in {shown.conditions}:
            axes.plot([x] * len(values["{shown.y}"]), values["{shown.y}"], "o", alpha=0.6)
    axes.set_xlabel("condition")
    axes.set_ylabel("{shown.y}, {shown.units[0]}")
    {mark}return picture


if __name{path.read_text().split("if __name")[1]}"""
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
        write_row(place, row.split("|")[1].strip(), row)


def write_row(place, name, row):
    pattern = re.compile(rf"^\| {re.escape(name)} \|.*$", re.MULTILINE)
    edit(place, lambda text: pattern.sub(lambda _: row, text))


def conclude(place):
    """Measure, draw and conclude, all from the existing runs."""
    does = STUDENTS[place.lab.number]
    programs(place)
    if "rule" in place.lab.fields:
        answer(place, {"rule": RULES.get(place.sheet().text_of("name"), 5.0)})
    data = measured(place)
    table(place, data)
    if line := does.mark(data):
        programs(place, line)
    told, _ = place.sheet().values(place.lab.fields.values())
    answer(place, does.conclude(data, told) | {"words": "The spread surprised me."})


def honest(lab, folder, name="Ada", workers=1):
    """Do a laboratory from beginning to end."""
    place = predicted(lab, folder, name)
    assert make_runs(lab, place.sheet(), place.runs, workers, lab.replications)
    conclude(place)
    return place


def copied(place, folder):
    """Copy a finished laboratory, to spoil the copy."""
    shutil.copytree(place.folder, Path(folder) / place.lab.name)
    return Place(place.lab, Path(folder) / place.lab.name)
