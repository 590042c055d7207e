"""Find the laboratories of a class in what students handed in, and grade them."""

from __future__ import annotations

import hashlib
import hmac
import os
import re
from base64 import b64encode
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.classes.batch import serve
from botschool.grading.classes.candidate import Choice
from botschool.grading.classes.choice import Wanted
from botschool.grading.classes.collect import Laboratory
from botschool.grading.classes.download import one_person
from botschool.grading.classes.files import File, Handed, listed, numbered_folders
from botschool.grading.declare.exercise import Exercise, Number
from botschool.grading.declare.state import DEFAULT, VARIABLE
from botschool.labs.check import Check, Part
from botschool.labs.declare import NUMBERS, PARTS, WORDS, Lab, load_lab
from botschool.labs.folder import Place, skeletons
from botschool.labs.sheet import MAX_BYTES

SECONDS = 60
"""Processor seconds that each part of a laboratory may take."""
MAX_FILE, MAX_ALL = 20 * 2**20, 45 * 2**20
_TITLE = re.compile(rb"\s*#\s+Laboratory\s+(\d{1,3})\.")
_NEEDED = re.compile(
    r"\w+\.py|runs/(?:runs\.json|[^/]+/(?:(?:statS|bestgS)\d+\.npy|S\d+G\d+\.npy|checkpointS\d+\.npz))"
)


def sheet_of(lab: Lab) -> Exercise:
    """Return a laboratory as an exercise for grade-all, whose tasks are its parts."""
    exercise = Exercise(lab.number, lab.title, "sheet.md")
    exercise.program = "botschool.labs.classes"
    for name, points in (PARTS | {"words": WORDS}).items():
        exercise.task(f"{_key(lab)}.{name}", name, SECONDS, 0).check(points)(_grade)
    return exercise


class WantedSheet(Wanted):
    """Looks for a laboratory in what a person handed in: its sheet, and the files beside it."""

    def __init__(self, lab: Lab) -> None:
        self.number, self.file, self.folder, self.skeleton = _key(lab), "sheet.md", lab.name, ""
        self._lab = lab

    def choose(
        self, handed: Handed, new_folder: Callable[[], Path], newest_first: bool = False
    ) -> Choice:
        """Copy the sheet with the most runs, and the files that it needs, into a folder labNN."""
        sheets = [file for file in handed.files if self._is_ours(file)]
        if not sheets:
            return Choice(problem=f"There is no sheet.md of laboratory {self._lab.number}.")
        inside = {sheet: _inside(handed, sheet) for sheet in sheets}
        sheets.sort(key=lambda each: (-len(inside[each]), each.shown))
        best, others = sheets[0], sheets[1:]
        choice = Choice(origin=best, changed=True)
        for sheet in sheets:
            choice.used |= {sheet, *inside[sheet].values()}
        choice.used |= {f for f in handed.files if f.shown.startswith(f"{best.folder}runs/")}
        choice.used |= {f for f in handed.files if f.shown == f"{best.folder}report.html"}
        choice.used |= {f for f in handed.files if self._is_given(f)}
        if others:
            choice.notes.append(f"Not used: {listed([each.shown for each in others])}.")
        folder = new_folder() / self._lab.name
        room = MAX_ALL
        try:
            for name, file in {"sheet.md": best, **inside[best]}.items():
                content = file.read(MAX_FILE)
                room -= len(content)
                if len(content) > MAX_FILE or room < 0:
                    choice.problem = "The laboratory holds too much: hand in what `lab run` made."
                    return choice
                (folder / name).parent.mkdir(parents=True, exist_ok=True)
                (folder / name).write_bytes(content)
        except OSError as error:
            choice.problem, choice.unread = f"A file cannot be read ({error.strerror}).", True
            return choice
        choice.file = folder / "sheet.md"
        return choice

    def _is_given(self, file: File) -> bool:
        """Return whether a file is a script of the laboratory, as its folder began."""
        text = skeletons(self._lab).get(file.name) if file.name.endswith(".py") else None
        with suppress(OSError):
            return text is not None and file.read(MAX_BYTES).split() == text.encode().split()
        return False

    def _is_ours(self, file: File) -> bool:
        if not re.fullmatch(r"(?i)sheet.*\.(md|txt)", file.name):
            return False
        try:
            found = _TITLE.match(file.read(MAX_BYTES).removeprefix(b"\xef\xbb\xbf"))
        except OSError:
            return False
        return bool(found) and int(found[1]) == self._lab.number


def _inside(handed: Handed, sheet: File) -> dict[str, File]:
    """Return the files that the check of a sheet reads: path from the sheet -> file."""
    found = {}
    for file in handed.files:
        inner = file.shown[len(sheet.folder) :]
        if file.shown.startswith(sheet.folder) and _NEEDED.fullmatch(inner):
            found[inner] = file
    return found


def _key(lab: Lab) -> Number:
    return f"lab{lab.number}"


def laboratories() -> dict[Number, Laboratory]:
    """Return all laboratories, in the form that grade-all needs."""
    labs = [load_lab(number) for number in NUMBERS]
    return {_key(lab): Laboratory(sheet_of(lab), WantedSheet(lab)) for lab in labs}


def secret_choice(place: Place, secret: str) -> Callable[[int], bytes]:
    """Return a `draw` for Check whose bytes follow from the runs and the secret.

    Grading the same runs again therefore draws the same, and without the secret nobody can predict
    it.
    """
    digest = hmac.new(secret.encode(), digestmod=hashlib.sha256)
    for path in sorted(place.runs.rglob("*.npy")):
        if path.is_file():
            digest.update(hashlib.sha256(path.read_bytes()).digest())
    key, drawn = digest.digest(), 0

    def draw(count: int) -> bytes:
        nonlocal drawn
        drawn += 1
        return hmac.digest(key, str(drawn).encode(), "sha256")[:count]

    return draw


def find_sheet(lab: Lab, submission: Path, folder: Path) -> tuple[Place, list[str]]:
    """Copy a laboratory from a person's folder or zip file; return its place, and notes.

    folder: a temporary folder for the copy. Raises BotschoolError.
    """
    if not submission.exists():
        raise BotschoolError(f"There is no {submission}: name the folder that was handed in.")
    new_folder = numbered_folders(folder)
    person = one_person(submission, new_folder)
    choice = WantedSheet(lab).choose(person.handed, new_folder)
    if choice.file is None:
        raise BotschoolError(f"{submission}: {choice.problem}")
    return Place(lab, choice.file.parent), choice.notes


def record(lab: Lab, check: Check | None) -> dict[str, Any]:
    """Return the result in the form that grade-all stores, with the words as one more task."""
    parts = [*check.parts.values()] if check else [Part(*part) for part in PARTS.items()]
    words = Part("words", WORDS, messages=[*lab.rubric])
    tasks = [
        {
            "id": f"{_key(lab)}.{part.name}",
            "title": part.name,
            "points": part.points,
            "max_points": part.max_points,
            "message": (" " if part is words else "\n").join(part.messages),
            "printed": "",
        }
        for part in [*parts, words]
    ]
    tasks[-1]["words"] = check.sheet.words if check else ""
    picture = b64encode(check.picture).decode() if check else ""
    return {
        "exercise": _key(lab),
        "title": lab.title,
        "points": check.points if check else 0,
        "max_points": sum(PARTS.values()) + WORDS,
        "tasks": tasks,
        "pictures": [["figure.png", picture]] if picture else [],
        "missing": [],
        "problem": "",
        "banner": "",
        "graded": True,
    }


def _grade(number: str, file: Path, tasks: list[str], alone: bool) -> dict[str, Any]:
    lab = load_lab(number)
    place = Place(lab, file.parent)
    try:
        check = Check(place, secret_choice(place, os.environ.get(VARIABLE) or DEFAULT))
    except BotschoolError as error:
        return record(lab, None) | {"problem": str(error).replace(f"{place.folder}/", "")}
    return record(lab, check.all()) | {"sheet": traces(place)}


def traces(place: Place) -> dict[str, Any]:
    """Return what shows whose sheet and runs these are: its name, prediction, hashes of robots."""
    files = [path for path in place.runs.rglob("bestgS*.npy") if path.is_file()]
    robots = {hashlib.sha256(path.read_bytes()).hexdigest()[:16] for path in files}
    found = {"name": "", "robots": sorted(robots), "prediction": {}}
    with suppress(BotschoolError):
        sheet, asked = place.sheet(), [f for f in place.lab.fields.values() if f.predicts]
        answers, _ = sheet.values(asked)
        found["prediction"] = {f.what: str(answers[f.id]) for f in asked if f.id in answers}
        found["name"] = sheet.text_of("name")
    return found


def main() -> None:
    """Grade one sheet in a process of its own; see `serve`."""
    serve(_grade)
