"""A whole class: a folder of submissions to a table and a page of feedback per student."""

from __future__ import annotations

import csv
import hashlib
import io
import os
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.classes.batch import Grades, Job
from botschool.grading.declare.checks import plain
from botschool.grading.declare.exercise import folder_of
from botschool.grading.report.feedback import GENERATOR, page
from botschool.output import save_bytes

TABLE, PAGES = "grades.csv", "feedback"
_FIRST_COLUMNS = ["student", "total"]


@dataclass
class Submission:
    """A student's folder: the file of each exercise, or why there is none."""

    folder: Path
    files: dict[int, Path] = field(default_factory=dict)
    problems: dict[int, str] = field(default_factory=dict)
    unread: set[int] = field(default_factory=set)
    """Exercises whose folder cannot be read: not graded, which is no 0."""

    @property
    def student(self) -> str:
        return plain(os.fsencode(self.folder.name).decode(errors="replace"))


def find_submissions(
    folder: Path, numbers: list[int], grades: Grades, root: Path
) -> list[Submission]:
    """One for every sub-folder; hidden ones are left out. Raises BotschoolError."""
    try:
        folders = sorted(path for path in folder.iterdir() if not path.name.startswith("."))
    except OSError as error:
        raise BotschoolError(f"{folder} cannot be read ({error.strerror}).") from None
    found = []
    for path in folders:
        if path.is_dir() or path.is_symlink():
            one = Submission(path)
            for number in numbers:
                _find(one, number, folder_of(number, root).name, grades.exercise(number).file)
            found.append(one)
    if not found:
        raise BotschoolError(f"{folder} holds no sub-folders: one for each student is needed.")
    return found


def _find(one: Submission, number: int, exercise: str, file: str) -> None:
    if one.folder.is_symlink():
        one.problems[number] = "The submission is a link to another place."
        return
    top = one.folder.resolve()
    for place in (exercise, f"exercises/{exercise}", "."):
        path = one.folder / place / file
        try:
            if path.is_symlink() or not path.resolve().is_relative_to(top):
                one.problems[number] = f"{file} is a link to another place."
                return
            if path.is_file():
                one.files[number] = path
                return
        except (OSError, RuntimeError):  # unreadable, or links in a circle
            one.problems[number] = f"The folder of {file} cannot be read."
            one.unread.add(number)
            return
    one.problems[number] = f"There is no {file}."


def grade_all(
    folder: Path,
    output: Path,
    numbers: list[int],
    root: Path,
    workers: int,
    fresh: bool,
    secret: str | None = None,
    start: Callable[[int], None] = lambda count: None,
    report: Callable[[], None] = lambda: None,
) -> list[tuple[Submission, list[dict[str, Any]]]]:
    """Grades every submission and writes grades.csv and feedback/STUDENT.html into `output`.

    Raises BotschoolError, before it starts, if this machine lacks what an exercise that was handed
    in needs. secret: of the grading seeds, else as of batch.Grades.
    start(count) is called with the number of files, report() after each of them.
    """
    grades = Grades(root, fresh, secret)
    submissions = find_submissions(folder, numbers, grades, root)
    for number in numbers:
        if any(number in one.files for one in submissions):
            grades.exercise(number).require()
    names = page_names([one.folder.name for one in submissions])
    _check_own(output, names)
    jobs = {
        (one.folder, number): Job(number, file.absolute())
        for one in submissions
        for number, file in one.files.items()
    }
    start(len(jobs))
    waiting = {one.folder: set(one.files) for one in submissions}
    by_file = {job: key for key, job in jobs.items()}
    done: dict[tuple[Path, int], dict] = {}
    (output / PAGES).mkdir(parents=True, exist_ok=True)

    def all_of(one: Submission) -> list[dict[str, Any]]:
        return [
            done[one.folder, n]
            if n in one.files
            else grades.nothing(n, one.problems[n], graded=n not in one.unread)
            for n in numbers
        ]

    def write(one: Submission, name: str) -> None:
        text = page(one.student, all_of(one))
        save_bytes(output / PAGES / name, text.encode("utf-8", "replace"))

    places = {one.folder: (one, name) for one, name in zip(submissions, names, strict=True)}
    for one, name in places.values():
        if not one.files:
            write(one, name)

    def keep(job: Job, result: dict[str, Any]) -> None:
        place, number = by_file[job]
        done[place, number] = result
        waiting[place].discard(number)
        if not waiting[place]:
            write(*places[place])
        report()

    grades.of(jobs.values(), workers, keep)
    table = [(one, all_of(one)) for one in submissions]
    save_bytes(output / TABLE, _table(table, names).encode("utf-8-sig", "replace"))
    return table


def total_of(results: list[dict[str, Any]]) -> int | None:
    """Return a student's points in all exercises; None if one of them was not graded."""
    if not all(result["graded"] for result in results):
        return None
    return sum(result["points"] for result in results)


def page_names(folders: list[str]) -> list[str]:
    """A file name for each folder name: readable, safe everywhere, and no two alike."""
    names, seen = [], set()
    for folder in folders:
        text = os.fsencode(folder).decode(errors="replace")
        name = re.sub(r"[^\w .@+-]", "_", text).strip(" .")[:80]
        reserved = re.fullmatch(r"(?i)(con|prn|aux|nul|com\d|lpt\d)(\..*)?", name)
        if not name or name != text or reserved or name.casefold() in seen:
            name = f"{name or 'student'}-{hashlib.sha256(os.fsencode(folder)).hexdigest()[:8]}"
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
        notes = " ".join(
            f"Exercise {r['exercise']}: {r['problem']}" for r in results if r["problem"]
        )
        shown = "" if total is None else total
        writer.writerow([_cell(one.student), shown, *points, _cell(f"{PAGES}/{name}"), notes])
    return stream.getvalue()


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
