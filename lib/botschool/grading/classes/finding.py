"""Find the file of each exercise for each person, for grade-all and grade --submission."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.classes.choice import MAX_NAMED, Choice, Wanted
from botschool.grading.classes.export import one_person
from botschool.grading.classes.files import TIMESTAMP, listed
from botschool.grading.classes.people import Person
from botschool.grading.classes.wall import Broken, broken, walled
from botschool.grading.declare.checks import plain
from botschool.grading.declare.exercise import Exercise, Number
from botschool.paths import for_make


@dataclass
class Submission:
    """A person's files: one for each exercise, or the reason why there is none."""

    person: Person
    choices: dict[Number, Choice] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    """Sentences on files that belong to no exercise."""

    @property
    def student(self) -> str:
        return self.person.student

    @property
    def files(self) -> dict[Number, Path]:
        return {number: each.file for number, each in self.choices.items() if each.file}


def find_submissions(
    people: Iterable[Person], wanted: list[Wanted], root: Path, new_folder: Callable[[], Path]
) -> list[Submission]:
    """Choose the file of each exercise among what each person handed in.

    Each person's files are read behind a wall (`walled`): what cannot be read costs only its owner.
    """
    found = []
    for person in people:
        one = Submission(person)
        try:
            one.choices, one.notes = walled(_read, person, wanted, root, new_folder())
        except Broken as error:
            one.choices = {each.number: _unreadable(error) for each in wanted}
        found.append(one)
    return found


def _read(
    person: Person, wanted: list[Wanted], root: Path, folder: Path
) -> tuple[dict[Number, Choice], list[str]]:
    """Return a person's choices and notes; folder: for what is unpacked and copied."""
    one = Submission(person)
    if person.problem:
        return {each.number: Choice(problem=person.problem) for each in wanted}, []
    person.new_folder = new_folder = numbered_folders(folder)
    handed, newest_first = person.handed, person.platform in ("canvas", "attempt")
    for each in wanted:
        try:
            one.choices[each.number] = each.choose(handed, new_folder, newest_first)
        except Exception as error:
            one.choices[each.number] = _unreadable(broken(error))
    return one.choices, [*handed.notes, *_left(one, root)]


def _unreadable(error: Broken) -> Choice:
    problem = f"What was handed in cannot be read ({plain(str(error))}): hand in the file alone."
    return Choice(problem=problem, unread=error.ours)


def _left(one: Submission, root: Path) -> list[str]:
    """Return a sentence on unused files, except those that the course gave out."""
    used = set().union(*(choice.used for choice in one.choices.values()))
    tops = {""} | {
        file.shown[: file.shown.index("exercises/")]
        for file in one.person.handed.files
        if re.search(r"(^|/)exercises/ex\d\d_", file.shown)
    }
    copies = len(tops) > 1 or any(f.shown.startswith("exercises/") for f in one.person.handed.files)
    names, given = [], 0
    for file in one.person.handed.files:
        if file in used or file.name == TIMESTAMP:
            continue
        inner = [file.shown[len(top) :] for top in tops if file.shown.startswith(top)]
        if any(_is_given(name, root, copies) for name in inner):
            given += 1
        else:
            names.append(file.shown)
    if not one.files and len(one.person.handed.files) <= MAX_NAMED:
        names = []  # the problem of each exercise names them
    names += [f"{link} (a link)" for link in one.person.handed.links]
    return [f"Not used: {listed(names)}."] if names else []


def _is_given(name: str, root: Path, copies: bool) -> bool:
    """Return whether copies of the course have a file of this path."""
    if not copies and not re.match(r"ex\d\d_", name):
        return False
    if name.startswith("solutions/"):  # which no copy has
        return False
    return (root / name).is_file() or (root / "exercises" / name).is_file()


def find_in(place: Path, exercise: Exercise, root: Path, folder: Path) -> Submission:
    """Find an exercise in one person's folder, zip file or file, as grade-all finds it.

    folder: a temporary one.
    """
    new_folder = numbered_folders(folder)
    wanted = Wanted(exercise.number, exercise.file, root)
    return find_submissions([one_person(place, new_folder)], [wanted], root, new_folder)[0]


def find_one(place: Path, exercise: Exercise, root: Path, folder: Path) -> Submission:
    """Find an exercise as `find_in`. Raises BotschoolError if there is nothing to grade."""
    one = find_in(place, exercise, root, folder)
    choice = one.choices[exercise.number]
    if choice.file is None:
        raise BotschoolError(
            f"{place}: {choice.problem} Name another folder with --submission "
            f"FOLDER{for_make(root)}."
        )
    return one


def numbered_folders(base: Path) -> Callable[[], Path]:
    """Return a function that makes a new folder in `base` each time."""
    numbers = itertools.count(1)

    def new_folder() -> Path:
        folder = base / str(next(numbers))
        folder.mkdir(parents=True)
        return folder

    return new_folder
