"""Turn an export of a class's submissions into a table and a page of feedback per student."""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.classes.batch import Grades, Job
from botschool.grading.classes.choice import Wanted
from botschool.grading.classes.export import read_export
from botschool.grading.classes.files import listed
from botschool.grading.classes.finding import Submission, find_submissions, numbered_folders
from botschool.grading.classes.members import Row, Settings
from botschool.grading.classes.outputs import OWN, WORDS, write_outputs
from botschool.grading.classes.people import Person
from botschool.grading.classes.policy import FILE, add_table
from botschool.grading.classes.register import Register
from botschool.grading.classes.tables import made_table
from botschool.grading.classes.texts import code_of_notebook
from botschool.grading.declare.exercise import Exercise, Number, called
from botschool.grading.report.feedback import page
from botschool.grading.report.paper import GENERATOR
from botschool.grading.run.temporary import temporary_folder
from botschool.output import save_bytes

TABLE, PAGES = "grades.csv", "feedback"
_FIRST_COLUMNS = ["student", "total"]

Asked = dict[Number, tuple[str, ...]]
"""Exercises and laboratories, each with the tasks to grade; () for all."""


@dataclass(frozen=True)
class Laboratory:
    """A laboratory: graded like an exercise, but by evidence."""

    exercise: Exercise
    """Its title and parts."""
    wanted: Wanted
    """How to find it among a person's files."""


@dataclass
class Class:
    """The results of an export."""

    rows: list[Row]
    register: Register
    nobodys: list[str]
    """Files that belong to no person."""
    notes: list[str]
    written: list[Path] = field(default_factory=list)
    """Files beside the table and the pages."""


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
    settings: Settings | None = None,
    laboratories: Mapping[Number, Laboratory] = MappingProxyType({}),
    only_handed_in: bool = False,
    known: Collection[Number] = (),
) -> Class:
    """Grade every submission and write grades.csv and feedback/STUDENT.html into `output`.

    download: a folder or a zip file, as in export.read_export. secret: of the grading seeds; None
    as in batch.Grades. start(count) is called with the number of files, report() after each of
    them.
    laboratories: those of `asked`. only_handed_in: whether to leave out laboratories that nobody
    handed in. known: all exercises and laboratories, () if unknown. Raises BotschoolError before it
    starts, if this machine lacks what a submitted exercise needs.
    """
    settings = settings or Settings()
    with temporary_folder() as temporary:
        exercises = {number: each.exercise for number, each in laboratories.items()}
        grades = Grades(root, fresh, secret, exercises)
        new_folder = numbered_folders(temporary / "files")
        wanted: list[Wanted] = [
            Wanted(number, grades.exercise(number).file, root)
            for number in asked
            if isinstance(number, int)
        ]
        wanted += [each.wanted for each in laboratories.values()]
        export = read_export(download, wanted, new_folder)
        submissions = find_submissions(export.people, wanted, root, new_folder)
        if only_handed_in:
            for number in [
                n for n in laboratories if not any(n in one.files for one in submissions)
            ]:
                asked = {key: tasks for key, tasks in asked.items() if key != number}
                for one in submissions:
                    del one.choices[number]
        for number in asked:
            if any(number in one.files for one in submissions):
                exercise = grades.exercise(number)
                exercise.require([*map(exercise.find, asked[number])] or exercise.tasks)
        rules = settings.policy.digest(asked)
        add_table(settings.policy, output / WORDS)
        register = Register(submissions, settings)
        skeletons = {each.number: each.skeleton for each in wanted if each.skeleton}
        rows = _grade(register, output, asked, grades, skeletons, workers, start, report)
        tables = {id(each): each for each in (settings.roster, settings.gradebook) if each}
        notes = [*export.notes, *(note for each in tables.values() for note in each.notes)]
        if FILE in export.nobodys or (download / FILE).is_file():
            notes.append(
                f"{FILE} inside the download has no effect, since students could have written it: "
                "put it beside the download, or name it with --class."
            )
        written = write_outputs(output, rows, register, asked, skeletons, rules)
        notes += [*register.notes, *register.without_effect([*asked], known)]
        nobodys = [name for name in export.nobodys if name != FILE]
    return Class(rows, register, nobodys, notes, written)


def _grade(
    register: Register,
    output: Path,
    asked: Asked,
    grades: Grades,
    skeletons: Mapping[Number, str],
    workers: int,
    start: Callable[[int], None],
    report: Callable[[], None],
) -> list[Row]:
    rows = register.rows
    names = page_names(
        [row.name for row in rows],
        [f"{one.person.platform} {one.person.folder}" for one in map(_first, rows)],
    )
    _check_own(output, names)
    places: dict[Job, list[tuple[int, Number]]] = {}
    waiting: list[set[tuple[int, Number]]] = []
    for row in rows:
        needed = {}
        for number in asked:
            for _, part in row.handed(number):
                needed[id(part), number] = Job(number, part.files[number].absolute(), asked[number])
        for key, job in needed.items():
            places.setdefault(job, []).append(key)
        waiting.append(set(needed))
    start(len(places))
    done: dict[tuple[int, Number], dict] = {}
    (output / PAGES).mkdir(parents=True, exist_ok=True)

    def write(row: Row, name: str) -> None:
        for number in asked:
            nothing = partial(grades.nothing, number, tasks=asked[number])
            result = register.result(row, number, done, nothing)
            code = _code(result["file"]) if number in skeletons and result.get("file") else ""
            row.results.append(result | {"code": code, "skeleton": skeletons.get(number, "")})
        register.finish(row)
        if not row.is_missing:
            row.page = name
            text = page(row.name, row.results, [*row.notes, *row.said])
            save_bytes(output / PAGES / name, text.encode("utf-8", "replace"))

    def keep(job: Job, result: dict[str, Any]) -> None:
        new = set(places[job])
        done.update(dict.fromkeys(new, result))
        for row, name, keys in zip(rows, names, waiting, strict=True):
            if keys & new:
                keys -= new
                if not keys:
                    write(row, name)
        report()

    for row, name, keys in zip(rows, names, waiting, strict=True):
        if not keys:
            write(row, name)
    grades.of(places, workers, keep)
    save_bytes(output / TABLE, _table(rows, register))
    return rows


def _code(file: Path) -> str:
    """Return the program of a graded file; "" if it cannot be read."""
    try:
        text = file.read_bytes().decode("utf-8", "replace")
    except OSError:
        return ""
    return code_of_notebook(text) if file.suffix == ".ipynb" else text


def _first(row: Row) -> Submission:
    """Return a person's submission, or an empty one, for a key of the page."""
    return row.parts[0] if row.parts else Submission(Person(row.name, row.about.key))


def page_names(folders: list[str], keys: list[str] | None = None) -> list[str]:
    """Return a different file name for each person, readable and safe on every system.

    keys: what distinguishes people of one name; None for the names.
    """
    names, seen = [], set()
    for folder, key in zip(folders, keys or folders, strict=True):
        text = os.fsencode(folder).decode(errors="replace")
        name = re.sub(r"[^\w .@+'-]", "_", text).strip(" .")[:80]
        reserved = re.fullmatch(r"(?i)(con|prn|aux|nul|com\d|lpt\d)(\..*)?", name)
        if not name or name != text or reserved or name.casefold() in seen:
            name = f"{name or 'student'}-{hashlib.sha256(os.fsencode(key)).hexdigest()[:8]}"
        seen.add(name.casefold())
        names.append(f"{name}.html")
    return names


def _table(rows: list[Row], register: Register) -> bytes:
    columns = []
    for result in rows[0].results:
        columns += [called(result["exercise"]).lower(), *(task["id"] for task in result["tasks"])]
    people = ["id", "email", "handed in as"] if register.roster else []
    lines: list[list[Any]] = [[*_FIRST_COLUMNS, *columns, "feedback", "notes", *people]]
    for row in rows:
        points: list[Any] = []
        for result in row.results:
            all_of = [result["points"], *(task["points"] for task in result["tasks"])]
            points += all_of if result["graded"] else [""] * len(all_of)
        link = f"{PAGES}/{row.page}" if row.page else ""
        about = [row.student.id, row.student.mail] if row.student else ["", ""]
        about += [listed(list(dict.fromkeys(part.student for part in row.parts)))]
        cells = [row.name, "" if row.total is None else row.total, *points, link, notes_of(row)]
        lines.append(cells + about * bool(people))
    return made_table(lines)


def notes_of(row: Row) -> str:
    """Return everything that a reader must know beside the points."""
    notes = []
    for result in row.results:
        broken = re.match(r"[^.\n]*\.?", result["banner"])[0]
        if said := " ".join(filter(None, [result["problem"], broken, *result["notes"]])):
            notes.append(f"{called(result['exercise'])}: {said}")
    return " ".join([*notes, *row.notes, *row.said])


def _check_own(output: Path, names: list[str]) -> None:
    """Raise BotschoolError before overwriting a file that grade-all did not make."""
    own = {TABLE: ",".join(_FIRST_COLUMNS), **{f"{PAGES}/{name}": GENERATOR for name in names}}
    own |= {name: GENERATOR for name in OWN if name.endswith(".html")}
    if not (output / TABLE).exists():  # then the tables beside it are not ours either
        own |= dict.fromkeys(OWN, GENERATOR)
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
                f"{path} exists and was not made by grade-all: move it away, or choose "
                "another folder with -o."
            )
