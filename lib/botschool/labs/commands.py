"""Run the commands of laboratories: start, grade (check), report, and run."""

from __future__ import annotations

import json
import os
import sys
from dataclasses import replace
from pathlib import Path
from shlex import quote

from botschool.errors import BotschoolError
from botschool.grading.run.temporary import temporary_folder
from botschool.labs.check import Check
from botschool.labs.classes import find_sheet, record, secret_choice
from botschool.labs.declare import NUMBERS, PARTS, WORDS, load_lab
from botschool.labs.folder import Place, check_strategy, keep_name, known_name, start
from botschool.labs.report import write_report
from botschool.labs.runs import make_runs
from botschool.labs.sheet import check_specific

COURSE = "botschool"
QUICK, QUICK_REPLICATIONS = 10, 3
"""How many times smaller the budgets of --quick are; its runs of a condition."""


def lead_to(exercise: int) -> None:
    """Name the laboratory of an exercise, if there is one."""
    if exercise in NUMBERS:
        print(f"Your own experiment comes next: botschool lab {exercise} start")


def start_command(number: str, name: str | None = None, course: str | None = None) -> None:
    """Make a laboratory's folder for the given name, the remembered one, or one asked for."""
    here = Path.cwd()
    place = Place.of(number, here)
    name = " ".join((name or known_name(here)).split())
    if not name and sys.stdin.isatty():
        name = " ".join(input("Your name (the seeds of your runs follow from it): ").split())
    if not name:
        raise BotschoolError(f'Say your name: botschool lab {place.lab.number} start --name "Ada".')
    kept = start(place, name, course or COURSE)
    keep_name(here, name)
    for path in kept:
        print(f"left alone, because it is there: {path}")
    print(f"Laboratory {place.lab.number}. {place.lab.title}")
    print(f"Read {place.folder / 'sheet.md'} and write your prediction.")
    print(f"Then: botschool lab {place.lab.number} run --quick, for a first look")


def run_command(number: str, quick: bool, workers: int) -> bool:
    """Make the runs; return False if the user stopped."""
    place = Place.of(number)
    sheet, lab, folder = place.sheet(), place.lab, place.runs
    check_specific(sheet, lab)
    check_strategy(place)
    if not quick:
        if not make_runs(lab, sheet, folder, workers, lab.replications):
            return False
        measure = quote(os.path.relpath(place.folder / "measure.py"))
        print("All runs are there. Now, as the sheet says:")
        print(f"1. Write measure.py; python {measure} prints the rows of the sheet's table.")
        print("2. Write figure.py, and answer the conclusion in sheet.md.")
        print(f"3. See your points, at any time: botschool lab {lab.number} check")
        return True
    folder = place.folder / "runs-quick"
    lab = replace(lab, conditions=tuple(c.shortened(QUICK) for c in lab.conditions))
    if not make_runs(lab, sheet, folder, workers, QUICK_REPLICATIONS):
        return False
    first = quote(os.path.relpath(folder / lab.conditions[0].name))
    print(f"These runs do not count. Look at some curves: botschool plotstat {first} -o look.png")
    print(f"Then make all runs: botschool lab {lab.number} run")
    return True


def check_command(number: str, as_json: bool = False, submission: Path | None = None) -> bool:
    """Print the points; return whether the check gave all that it can give.

    submission: another person's folder or zip file; it is found and checked as grade-all does.
    """
    if submission:
        return _check_other(number, as_json, submission)
    check = Check(Place.of(number)).all()
    show(check, as_json)
    if check.full and not as_json:
        print(f"A page to show: botschool lab {check.lab.number} report")
    return check.full


def _check_other(number: str, as_json: bool, submission: Path) -> bool:
    from botschool.grading.declare.exercise import course_root
    from botschool.grading.declare.state import secret_for_others
    from botschool.grading.run.confined import close_class

    secret, said = secret_for_others(course_root())
    with temporary_folder() as folder:
        place, notes = find_sheet(load_lab(number), submission, folder)
        inside = submission.resolve()
        close_class(inside if inside.is_dir() else inside.parent, inside.parent)
        check = Check(place, secret_choice(place, secret)).all()
    show(check, as_json)
    if not as_json:
        print(f"The words: {check.sheet.words or '(none)'}")
        print("\n".join(filter(None, [*notes, said])))
    return check.full


def show(check: Check, as_json: bool = False) -> None:
    """Print points and messages part by part."""
    if as_json:
        said = record(check.lab, check)
        print(json.dumps({key: said[key] for key in said if key != "pictures"}, indent=1))
        return
    for part in check.parts.values():
        print(f"{part.name:<14}{part.points:5g} of {part.max_points:g}")
        for message in part.messages:
            print(f"    {message}")
    print(f"{'words':<14}    {WORDS} points: your instructor's")
    if not check.sheet.words:
        print("    Nothing is written yet: answer the last question of the conclusion.")
    print(f"{check.points:g} of {sum(PARTS.values())} points")


def report_command(number: str) -> None:
    """Check the laboratory and write its page."""
    place = Place.of(number)
    check = Check(place).all()
    with temporary_folder() as folder:
        path = write_report(place, check, folder)
    print(f"{check.points:g} of {sum(PARTS.values())} points")
    print(f"report: {path}")
