"""A whole class: an export of submissions to a table and a page of feedback per student."""

from __future__ import annotations

import csv
import hashlib
import io
import itertools
import os
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.classes.batch import Grades, Job
from botschool.grading.classes.choice import Choice, Wanted, choose, listed
from botschool.grading.classes.export import Person, one_person, read_export
from botschool.grading.declare.exercise import Exercise
from botschool.grading.report.feedback import GENERATOR, page
from botschool.grading.run.temporary import temporary_folder
from botschool.output import save_bytes

TABLE, PAGES = "grades.csv", "feedback"
_FIRST_COLUMNS = ["student", "total"]

Asked = dict[int, tuple[str, ...]]
"""Exercises, and of each the tasks that are asked for; () for all."""


@dataclass
class Submission:
    """A person's files: that of each exercise, or why there is none."""

    person: Person
    choices: dict[int, Choice] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    """On what belongs to no exercise."""

    @property
    def student(self) -> str:
        return self.person.student

    @property
    def files(self) -> dict[int, Path]:
        return {number: each.file for number, each in self.choices.items() if each.file}


@dataclass
class Class:
    """What was graded of an export."""

    table: list[tuple[Submission, list[dict[str, Any]]]]
    nobodys: list[str]
    """Files that belong to nobody."""
    notes: list[str]


def find_submissions(
    people: Iterable[Person], wanted: list[Wanted], root: Path, new_folder: Callable[[], Path]
) -> list[Submission]:
    """Choose the file of each exercise among what each person handed in."""
    found = []
    for person in people:
        one = Submission(person)
        for each in wanted:
            if person.problem:
                one.choices[each.number] = Choice(problem=person.problem)
                continue
            newest_first = person.platform == "canvas"
            one.choices[each.number] = choose(person.handed, each, new_folder, newest_first)
        one.notes = [*person.handed.notes, *_left(one, root)]
        found.append(one)
    return found


def _left(one: Submission, root: Path) -> list[str]:
    """Return a sentence on the files that are not used, without those that the course gave out."""
    used = set().union(*(choice.used for choice in one.choices.values()))
    tops = {""} | {
        file.shown[: file.shown.index("exercises/")]
        for file in one.person.handed.files
        if re.search(r"(^|/)exercises/ex\d\d_", file.shown)
    }
    copies = len(tops) > 1 or any(f.shown.startswith("exercises/") for f in one.person.handed.files)
    names, given = [], 0
    for file in one.person.handed.files:
        if file in used:
            continue
        inner = [file.shown[len(top) :] for top in tops if file.shown.startswith(top)]
        if any(_is_given(name, root, copies) for name in inner):
            given += 1
        else:
            names.append(file.shown)
    names += [f"{link} (a link)" for link in one.person.handed.links]
    return [f"Not used: {listed(names)}."] if names else []


def _is_given(name: str, root: Path, copies: bool) -> bool:
    """Return whether a path is one of the course, as copies of it have."""
    if not copies and not re.match(r"ex\d\d_", name):
        return False
    return (root / name).is_file() or (root / "exercises" / name).is_file()


def find_one(place: Path, exercise: Exercise, root: Path, folder: Path) -> Submission:
    """Find an exercise in one person's folder, zip file or file, as grade-all finds it.

    folder: a temporary one. Raises BotschoolError if there is nothing to grade.
    """
    new_folder = numbered_folders(folder)
    wanted = Wanted(exercise.number, exercise.file, root)
    (one,) = find_submissions([one_person(place, new_folder)], [wanted], root, new_folder)
    choice = one.choices[exercise.number]
    if choice.file is None:
        raise BotschoolError(
            f"{place}: {choice.problem} Name another folder with --submission FOLDER, or "
            "SUBMISSION=FOLDER for make."
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


def grade_all(
    download: Path,
    output: Path,
    asked: Asked,
    root: Path,
    workers: int,
    fresh: bool,
    secret: str | None = None,
    start: Callable[[int], None] = lambda count: None,
    report: Callable[[], None] = lambda: None,
) -> Class:
    """Grade every submission and write grades.csv and feedback/STUDENT.html into `output`.

    download: a folder or a zip file, as of export.read_export. Raises BotschoolError, before it
    starts, if this machine lacks what an exercise that was handed in needs. secret: of the grading
    seeds, else as of batch.Grades. start(count) is called with the number of files, report()
    after each of them.
    """
    with temporary_folder() as temporary:
        grades = Grades(root, fresh, secret)
        new_folder = numbered_folders(temporary / "files")
        wanted = [Wanted(number, grades.exercise(number).file, root) for number in asked]
        export = read_export(download, wanted, new_folder)
        submissions = find_submissions(export.people, wanted, root, new_folder)
        for number in asked:
            if any(number in one.files for one in submissions):
                grades.exercise(number).require()
        table = _grade(submissions, output, asked, grades, workers, start, report)
    return Class(table, export.nobodys, export.notes)


def _grade(
    submissions: list[Submission],
    output: Path,
    asked: Asked,
    grades: Grades,
    workers: int,
    start: Callable[[int], None],
    report: Callable[[], None],
) -> list[tuple[Submission, list[dict[str, Any]]]]:
    names = page_names([one.student for one in submissions], [_key(one) for one in submissions])
    _check_own(output, names)
    jobs = {
        (index, number): Job(number, file.absolute(), asked[number])
        for index, one in enumerate(submissions)
        for number, file in one.files.items()
    }
    places: dict[Job, list[tuple[int, int]]] = {}
    for place, job in jobs.items():
        places.setdefault(job, []).append(place)
    start(len(places))
    waiting = {index: set(one.files) for index, one in enumerate(submissions)}
    done: dict[tuple[int, int], dict] = {}
    (output / PAGES).mkdir(parents=True, exist_ok=True)

    def all_of(index: int) -> list[dict[str, Any]]:
        results = []
        for number in asked:
            choice = submissions[index].choices[number]
            result = done.get((index, number))
            if result is None:
                problem = choice.problem
                result = grades.nothing(number, problem, not choice.unread, asked[number])
            results.append(result | {"notes": choice.notes})
        return results

    def write(index: int) -> None:
        one = submissions[index]
        text = page(one.student, all_of(index), one.notes)
        save_bytes(output / PAGES / names[index], text.encode("utf-8", "replace"))

    for index, one in enumerate(submissions):
        if not one.files:
            write(index)

    def keep(job: Job, result: dict[str, Any]) -> None:
        for index, number in places[job]:
            done[index, number] = result
            waiting[index].discard(number)
            if not waiting[index]:
                write(index)
        report()

    grades.of(places, workers, keep)
    table = [(one, all_of(index)) for index, one in enumerate(submissions)]
    save_bytes(output / TABLE, _table(table, names).encode("utf-8-sig", "replace"))
    return table


def _key(one: Submission) -> str:
    return f"{one.person.platform} {one.person.folder}"


def total_of(results: list[dict[str, Any]]) -> int | None:
    """Return a student's points in all exercises; None if one of them was not graded."""
    if not all(result["graded"] for result in results):
        return None
    return sum(result["points"] for result in results)


def page_names(folders: list[str], keys: list[str] | None = None) -> list[str]:
    """Return a file name for each person: readable, safe everywhere, and no two alike.

    keys: what tells people of one name apart; else the names.
    """
    names, seen = [], set()
    for folder, key in zip(folders, keys or folders, strict=True):
        text = os.fsencode(folder).decode(errors="replace")
        name = re.sub(r"[^\w .@+-]", "_", text).strip(" .")[:80]
        reserved = re.fullmatch(r"(?i)(con|prn|aux|nul|com\d|lpt\d)(\..*)?", name)
        if not name or name != text or reserved or name.casefold() in seen:
            name = f"{name or 'student'}-{hashlib.sha256(os.fsencode(key)).hexdigest()[:8]}"
        seen.add(name.casefold())
        names.append(f"{name}.html")
    return names


def _table(table: list[tuple[Submission, list[dict]]], names: list[str]) -> str:
    exercises = table[0][1]
    columns = []
    for result in exercises:
        columns += [f"exercise {result['exercise']}", *(task["id"] for task in result["tasks"])]
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow([*_FIRST_COLUMNS, *columns, "feedback", "notes"])
    for (one, results), name in zip(table, names, strict=True):
        points = []
        for result in results:
            all_of = [result["points"], *(task["points"] for task in result["tasks"])]
            points += all_of if result["graded"] else [""] * len(all_of)
        total = total_of(results)
        notes = _cell(notes_of(one, results))
        shown = "" if total is None else total
        writer.writerow([_cell(one.student), shown, *points, _cell(f"{PAGES}/{name}"), notes])
    return stream.getvalue()


def notes_of(one: Submission, results: list[dict[str, Any]]) -> str:
    """Return all that is to be known beside the points."""
    notes = []
    for result in results:
        if said := " ".join(filter(None, [result["problem"], *result["notes"]])):
            notes.append(f"Exercise {result['exercise']}: {said}")
    return " ".join([*notes, *one.notes])


def _cell(text: str) -> str:
    """Text that no spreadsheet takes for a formula."""
    text = " ".join(text.split())
    return f"'{text}" if text.startswith(("=", "+", "-", "@")) else text


def _check_own(output: Path, names: list[str]) -> None:
    """Raises BotschoolError before a file is overwritten that grade-all did not make."""
    own = {TABLE: ",".join(_FIRST_COLUMNS), **{f"{PAGES}/{name}": GENERATOR for name in names}}
    for name, sign in own.items():
        path = output / name
        try:
            with path.open(encoding="utf-8-sig", errors="replace") as file:
                head = file.read(1000)
        except FileNotFoundError:
            continue
        except OSError:
            head = ""
        if sign not in head or path.is_symlink():
            raise BotschoolError(
                f"{path} is there already and was not made by grade-all: move it away, or choose "
                "another folder with -o."
            )
