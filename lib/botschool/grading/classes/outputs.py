"""Write the files beside the grades: statistics, similarities, and what platforms import."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Callable, Sequence
from copy import deepcopy
from io import BytesIO
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.classes.batch import remarks
from botschool.grading.classes.identity import Roster, Student
from botschool.grading.classes.register import Members, Register, Row
from botschool.grading.classes.rules import MOST_POINTS, tidy
from botschool.grading.classes.similar import (
    Program,
    Sheet,
    doubtful,
    sheets_section,
    similar_pairs,
    similarity_page,
)
from botschool.grading.classes.statistics import by_task, statistics_page
from botschool.grading.classes.tables import made_table, read_table, safe_cell
from botschool.grading.classes.term import RECORD, record
from botschool.grading.declare.checks import plain
from botschool.grading.declare.exercise import Number, called
from botschool.output import save_bytes

_EPOCH = (2000, 1, 1, 0, 0, 0)
"""The time of files in a zip file, so that equal grades give equal files."""


OWN = (
    "class.html", "similar.html", "moodle.csv", "canvas.csv", "moodle-feedback.zip",
    "canvas-feedback.zip", RECORD,
)  # fmt: skip
"""Names of these files."""
WORDS = "words.csv"
"""The texts of laboratories, for the instructor's points."""


def write_outputs(
    output: Path,
    rows: list[Row],
    register: Register,
    asked: dict[Number, tuple[str, ...]],
    skeletons: dict[Number, str],
    rules: str,
) -> list[Path]:
    """Write the files that this class's platform and settings need; return their paths.

    rules: as in term.record. Raises BotschoolError.
    """
    made = {"class.html": _statistics(rows, register)}
    if similar := _similar(rows, asked, skeletons):
        made["similar.html"] = similar
    made |= _feedback(output, rows)
    made |= filled(output, register, _comment)
    made |= _words(output, rows, register)
    for name, content in made.items():
        save_bytes(output / name, content)
    save_bytes(output / RECORD, record(rows, register.policy, rules))
    return [output / name for name in made]


def _feedback(output: Path, rows: list[Row]) -> dict[str, bytes]:
    """Return zip files of feedback to upload, one for each download: numbers differ in each."""
    files: dict[str, dict[str, bytes]] = {}
    for row in rows:
        for part in row.parts:
            section = f"-{Path(part.section).stem}" if part.section else ""
            own = files.setdefault(f"{part.platform}-feedback{section}.zip", {})
            if part.platform == "moodle":  # a page for each participant, in its own folder
                name = f"{part.student}_{part.ids['participant']}_assignsubmission_file_"
                upload = [each for each in part.upload if "assignsubmission_file" in each]
                page = (output / "feedback" / row.page).read_bytes()
                own[f"{[*upload, name][0]}/feedback.html"] = page
            elif part.platform == "canvas":  # a text under the name of the submission
                text = feedback_text(row.name, row.results, row.notes)
                own |= dict.fromkeys(part.upload[:1], text.encode("utf-8", "replace"))
    return {name: _zip(own) for name, own in files.items() if own}


def filled(output: Path, members: Members, comment: Callable[[Row], str]) -> dict[str, bytes]:
    """Return the platform's table with grades and comments: name of the file -> content."""
    book = members.policy.gradebook
    if book is None:
        return {}
    points = {
        student: (row.total, comment(row))
        for student, row in members.book_rows()
        if row.total is not None
    }
    if output / f"{book.kind}.csv" == book.table.path:
        raise BotschoolError(f"{book.table.path} would be overwritten: give another copy of it.")
    if book.kind == "moodle":
        return {"moodle.csv": moodle_worksheet(book, points, members.maximum)}
    column = members.policy.column
    return {"canvas.csv": canvas_gradebook(book, points, members.maximum, column)}


def _words(output: Path, rows: list[Row], register: Register) -> dict[str, bytes]:
    """Return the table of the laboratories' texts, in which the instructor writes points.

    What stands in the table stays there, with a note where a text has changed since.
    """
    place, before = output / WORDS, dict[tuple[str, str], list[str]]()
    columns = ("name", "id", "exercise", "points", "reason", "text", "rubric")
    if place.is_file():
        table = read_table(place)
        for old in table.rows:
            cells = [table.get(old, each) for each in columns]
            before[(cells[1] or cells[0]).lstrip("'"), cells[2]] = cells
    found = []
    for row in rows:
        for task in [task for result in row.results for task in result["tasks"]]:
            if not (text := task.get("words", "")):
                continue
            key, name, what = row.about.key, row.name, task["id"]
            old = before.pop((key, what), None) or before.pop((name, what), [""] * 6)
            if old[3] and old[5] != safe_cell(text):
                register.notes.append(
                    f"{row.name} has changed {what} since you gave {old[3]} points: look at "
                    f"{place} again."
                )
            rubric = task.get("rubric", task["message"])
            found.append([name, key, what, *old[3:5], text, rubric])
    found += [cells for cells in before.values() if cells[3] or cells[4]]
    if not found:
        return {}
    head = ["student", "id", "exercise", "points", "comment", "text", "rubric"]
    return {WORDS: made_table([head, *found])}


def _comment(row: Row) -> str:
    """Return the points of each exercise and the notes, in a line for a gradebook."""
    parts = [f"{called(r['exercise'])}: {r['points']} of {r['max_points']}." for r in row.results]
    notes = [note for result in row.results for note in (result["problem"], *result["notes"])]
    return " ".join(filter(None, [*parts, *notes, *row.notes, *row.said]))


def _statistics(rows: list[Row], register: Register) -> bytes:
    notes = [f"{sum(bool(row.page) for row in rows)} submissions."]
    if average := register.average():
        notes.append(f"{average}.")
    if register.missing:
        names = ", ".join(each.name for each in register.missing)
        notes.append(f"{len(register.missing)} handed in nothing: {names}.")
    if register.unknown:
        notes.append(f"{len(register.unknown)} not on the roster: {', '.join(register.unknown)}.")
    people = [(row.name, row.page, row.results) for row in rows]
    return statistics_page(by_task(people), notes).encode("utf-8", "replace")


def _similar(
    rows: list[Row], asked: dict[Number, tuple[str, ...]], skeletons: dict[Number, str]
) -> bytes:
    found = {}
    for number in [each for each in asked if isinstance(each, int)]:
        programs = {}
        for row in rows:
            for result in row.results:  # a group's file is there once for each member
                if result["exercise"] == number and result.get("code"):
                    programs.setdefault(result["file"], Program(row.name, result["code"]))
        if len(programs) > 1:
            pairs = similar_pairs([*programs.values()], skeletons[number])
            found[number] = (len(programs), pairs)
    people = [row.name for row in rows]
    sheets = {lab: told for lab in asked if (told := doubtful(_sheets(rows, lab), people))}
    parts = [sheets_section(lab, told) for lab, told in sheets.items()]
    page = similarity_page(found, parts, skeletons)
    return page.encode("utf-8", "replace") if found or sheets else b""


def _sheets(rows: list[Row], number: Number) -> list[Sheet]:
    """Return the sheets of a laboratory; a group's sheet is there once, with all their names."""
    found: dict[Path, Sheet] = {}
    for row in rows:
        for result in row.results:
            if result["exercise"] == number and (told := result.get("sheet")):
                file = result["file"]
                names = f"{found[file].student}, {row.name}" if file in found else row.name
                robots = frozenset(told["robots"])
                found[file] = Sheet(names, told["name"], robots, told["prediction"])
    return [*found.values()]


def moodle_worksheet(
    roster: Roster, points: dict[Student, tuple[float, str]], maximum: float
) -> bytes:
    """Return Moodle's grading worksheet with grades and comments; others' cells stay as they are.

    points: total and comment of each student who was graded; maximum: the most that the total can
    be. The grade is scaled to the worksheet's "Maximum Grade".
    """
    table = deepcopy(roster.table)
    grade, comment = table.column("grade"), table.column("feedbackcomments")
    if grade is None:
        raise BotschoolError(f"{table.path} has no column 'Grade': download the worksheet again.")
    for student, (total, said) in points.items():
        for row in [table.rows[number] for number in student.rows]:
            row += [""] * (len(table.head) - len(row))
            most = re.fullmatch(r"\s*(\d+(?:[.,]\d+)?)\s*", table.get(row, "maximumgrade"))
            scale = float(most[1].replace(",", ".")) / maximum if most and maximum else 1.0
            row[grade] = f"{total * scale:.2f}"
            if comment is not None and said:
                row[comment] = safe_cell(said)
    return table.text()


def canvas_gradebook(
    roster: Roster, points: dict[Student, tuple[float, str]], maximum: float, column: str
) -> bytes:
    """Return Canvas's gradebook with the columns that identify students, and one of grades.

    column: the head of the assignment's column, or a part of it. Raises BotschoolError where none
    or more than one fits. The grade is scaled to the row "Points Possible".
    """
    table = roster.table
    fixed = [i for i, head in enumerate(table.head) if head.strip() in _CANVAS_FIXED]
    numbered = [i for i, head in enumerate(table.head) if re.search(r"\(\d+\)\s*$", head)]
    fitting = [i for i in numbered if column.casefold() in table.head[i].casefold()]
    if len(fitting) != 1:
        names = plain(" ".join(", ".join(table.head[i] for i in numbered[:10]).split())) or "none"
        raise BotschoolError(
            f"{table.path}: name one assignment's column with --column; there are: {names}."
        )
    index = fitting[0]
    possible = [row for row in table.rows if row and "points possible" in row[0].lower()]
    most = table_number(possible[0][index]) if possible and len(possible[0]) > index else None
    scale = most / maximum if most and maximum else 1.0
    made = deepcopy(table)
    made.head = [table.head[i] for i in (*fixed, index)]
    made.rows = []
    by_row = {row: total for student, (total, _) in points.items() for row in student.rows}
    for number, row in enumerate(table.rows):
        row = row + [""] * (len(table.head) - len(row))
        new = row[index] if number not in by_row else str(tidy(by_row[number] * scale))
        if row in possible or number in by_row:
            made.rows.append([*(row[i] for i in fixed), new])
    return made.text()


_CANVAS_FIXED = ("Student", "ID", "SIS User ID", "SIS Login ID", "Integration ID", "Section")


def table_number(text: str) -> float | None:
    """Return the number in a cell; None if there is none, or one that cannot be points."""
    try:
        number = float(text.strip().replace(",", "."))
    except ValueError:
        return None
    return number if 0 <= number <= MOST_POINTS else None


def feedback_text(student: str, results: list[dict[str, Any]], notes: Sequence[str]) -> str:
    """Return a student's feedback as plain text."""
    lines = [f"Feedback for {student}", ""]
    lines += notes
    for result in results:
        points = result["points"] if result["graded"] else "-"
        head = f"{called(result['exercise'])}. {result['title']}"
        lines += ["", f"{head}: {points} of {result['max_points']} points"]
        lines += remarks(result)
        for task in result["tasks"] if not result["problem"] else ():
            lines.append(
                f"  {task['id']} {task['title']}: {task['points']} of {task['max_points']}"
            )
            lines += [f"      {line}" for line in task["message"].splitlines()]
    return "\n".join(lines) + "\n"


def _zip(files: dict[str, bytes]) -> bytes:
    buffer = BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in sorted(files.items()):
            whole = name.encode("utf-8", "replace").decode()  # a student's name may be no UTF-8
            info = zipfile.ZipInfo(whole.replace("?", "_"), _EPOCH)
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, content)
    return buffer.getvalue()
