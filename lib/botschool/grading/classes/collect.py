"""Turn an export of a class's submissions into a table and a page of feedback per student."""

from __future__ import annotations

import hashlib
import os
import re
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import Any

from botschool.grading.classes.batch import Grades, Job
from botschool.grading.classes.choice import Wanted, find_submissions
from botschool.grading.classes.download import Download, read_download
from botschool.grading.classes.files import listed, numbered_folders
from botschool.grading.classes.outputs import OWN, WORDS, similar, write_outputs
from botschool.grading.classes.policy import FILE, add_table
from botschool.grading.classes.register import Register, Row
from botschool.grading.classes.rules import Policy
from botschool.grading.classes.tables import check_own, made_table
from botschool.grading.classes.texts import code_of_notebook
from botschool.grading.declare.exercise import Exercise, Number, called, exercise_numbers
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

    register: Register
    nobodys: list[str]
    """Files that belong to no person."""
    notes: list[str]
    written: list[Path]
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
    policy: Policy | None = None,
    laboratories: Mapping[Number, Laboratory] = MappingProxyType({}),
    only_handed_in: bool = False,
) -> Class:
    """Grade every submission and write grades.csv and feedback/STUDENT.html into `output`.

    download: a folder or a zip file, as in read_download. secret: of the grading seeds; None
    as in batch.Grades. start(count) is called with the number of files, report() after each of
    them. laboratories: all that there are. only_handed_in: whether to leave out laboratories that
    nobody handed in. Raises BotschoolError before it starts, if this machine lacks what a submitted
    exercise needs.
    """
    policy = policy or Policy()
    with temporary_folder() as temporary:
        exercises = {number: each.exercise for number, each in laboratories.items()}
        grades = Grades(root, fresh, secret, exercises)
        new_folder = numbered_folders(temporary / "files")
        wanted = [
            Wanted(number, grades.exercise(number).file, root)
            if isinstance(number, int)
            else laboratories[number].wanted
            for number in asked
        ]
        lists = [each.students for each in (policy.people, policy.gradebook) if each]
        words = [Counter(w for each in students for w in each.words) for students in lists]
        known = frozenset(word for own in words for word, count in own.items() if count == 1)
        export = read_download(download, wanted, new_folder, known)
        people = find_submissions(export.people, wanted, root, new_folder)
        handed_in = {number for one in people for number in one.files}
        if only_handed_in:
            asked = {n: asked[n] for n in asked if isinstance(n, int) or n in handed_in}
            for one in people:
                one.choices = {number: one.choices[number] for number in asked}
        for number in [each for each in asked if each in handed_in]:
            exercise = grades.exercise(number)
            exercise.require([*map(exercise.find, asked[number])] or exercise.tasks)
        rules = policy.digest(asked)
        add_table(policy, output / WORDS)
        register = Register(people, policy)
        skeletons = {each.number: each.skeleton for each in wanted if each.skeleton}
        names = _page_names(register.rows)
        _check_own(output, names)
        _grade(register, asked, grades, skeletons, workers, start, report)
        _write_pages(output / PAGES, register.rows, names)
        solutions = {number: grades.exercise(number).known.solution for number in skeletons}
        alike = similar(register.rows, asked, skeletons, solutions)
        save_bytes(output / TABLE, _table(register.rows, register))
        notes = [*export.notes, *_notes(policy, export, download)]
        written = write_outputs(output, register.rows, register, alike, rules)
        known = [*exercise_numbers(root), *laboratories]
        notes += [*register.notes, *register.without_effect([*asked], known)]
        notes = [*register.how, *dict.fromkeys(notes)]
        if copies := listed([row.name for row in register.rows if row.remarks]):
            notes.append(f"Like our solution, see {output / 'similar.html'}: {copies}.")
        nobodys = [name for name in export.nobodys if name != FILE]
    return Class(register, nobodys, notes, written)


def _notes(policy: Policy, export: Download, download: Path) -> list[str]:
    """Return sentences on the tables and settings of the class."""
    tables = {id(each): each for each in (policy.people, policy.gradebook) if each}
    notes = [note for each in tables.values() for note in each.notes]
    if FILE in export.nobodys or (download / FILE).is_file():
        notes.append(
            f"{FILE} inside the download has no effect, since students could have written it: "
            "put it beside the download, or name it with --class."
        )
    return notes


def _grade(
    register: Register,
    asked: Asked,
    grades: Grades,
    skeletons: Mapping[Number, str],
    workers: int,
    start: Callable[[int], None],
    report: Callable[[], None],
) -> None:
    """Give each row its results and its total."""
    jobs = {
        (number, part.files[number]): Job(number, part.files[number].absolute(), tasks)
        for row in register.rows
        for number, tasks in asked.items()
        for _, part in row.handed(number)
    }
    start(len(set(jobs.values())))
    found = grades.of(jobs.values(), workers, lambda job, result: report())
    done = {place: found[job] for place, job in jobs.items()}
    for row in register.rows:
        for number, tasks in asked.items():
            nothing = partial(grades.nothing, Job(number, Path(), tasks))
            result = register.result(row, number, done, nothing)
            code = _code(result["file"]) if number in skeletons and result.get("file") else ""
            row.results.append(result | {"code": code, "skeleton": skeletons.get(number, "")})
        register.finish(row)


def _code(file: Path) -> str:
    """Return the program of a graded file; "" if it cannot be read."""
    try:
        text = file.read_bytes().decode("utf-8", "replace")
    except OSError:
        return ""
    return code_of_notebook(text) if file.suffix == ".ipynb" else text


def _write_pages(folder: Path, rows: list[Row], names: list[str]) -> None:
    """Write a page for each person who handed in something."""
    folder.mkdir(parents=True, exist_ok=True)
    for row, name in zip(rows, names, strict=True):
        if not row.is_missing:
            row.page = name
            text = page(row.name, row.results, [*row.notes, *row.said])
            save_bytes(folder / name, text.encode("utf-8", "replace"))


def _page_names(rows: list[Row]) -> list[str]:
    """Return the name of each row's page; the names of platforms distinguish people of one name."""
    firsts = [row.parts[0] if row.parts else None for row in rows]
    keys = [
        f"{first.platform} {first.key}" if first else f" {row.name}"
        for row, first in zip(rows, firsts, strict=True)
    ]
    return page_names([row.name for row in rows], keys)


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
    heads = [*_FIRST_COLUMNS, *columns, "feedback", "notes"]
    heads += ["handed in as"] if register.has_list else []
    more = dict.fromkeys(h for row in rows for h in row.student.cells if h not in heads)
    lines: list[list[Any]] = [[*heads, *more]]
    for row in rows:
        points: list[Any] = []
        for result in row.results:
            all_of = [result["points"], *(task["points"] for task in result["tasks"])]
            points += all_of if result["graded"] else [""] * len(all_of)
        link = f"{PAGES}/{row.page}" if row.page else ""
        cells = [row.name, "" if row.total is None else row.total, *points, link, notes_of(row)]
        if register.has_list:
            cells.append(listed(list(dict.fromkeys(part.student for part in row.parts))))
        lines.append(cells + [row.student.cells.get(head, "") for head in more])
    return made_table(lines)


def notes_of(row: Row) -> str:
    """Return everything that a reader must know beside the points."""
    notes = []
    for result in row.results:
        broken = re.match(r"[^.\n]*\.?", result["banner"])[0]
        if said := " ".join(filter(None, [result["problem"], broken, *result["notes"]])):
            notes.append(f"{called(result['exercise'])}: {said}")
    return " ".join([*notes, *row.remarks, *row.notes, *row.said])


def _check_own(output: Path, names: list[str]) -> None:
    """Raise BotschoolError before overwriting a file that grade-all did not make."""
    own = {TABLE: ",".join(_FIRST_COLUMNS), **{f"{PAGES}/{name}": GENERATOR for name in names}}
    own |= {name: GENERATOR for name in OWN if name.endswith(".html")}
    if not (output / TABLE).exists():  # then the tables beside it are not ours either
        own |= dict.fromkeys(OWN, GENERATOR)
    for name, sign in own.items():
        check_own(output / name, sign, "grade-all")
