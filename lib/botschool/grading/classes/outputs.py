"""Write the files beside the grades: statistics, similarities, and what platforms import."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Callable, Iterable, Mapping, Sequence
from copy import deepcopy
from io import BytesIO
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.classes.batch import remarks
from botschool.grading.classes.files import listed
from botschool.grading.classes.register import Members, Register, Row
from botschool.grading.classes.roster import Roster
from botschool.grading.classes.rules import MOST_POINTS, tidy
from botschool.grading.classes.similar import (
    Program,
    Sheet,
    doubtful,
    grouped,
    like_ours,
    sheets_section,
    similar_pairs,
    similarity_page,
)
from botschool.grading.classes.statistics import by_task, statistics_page
from botschool.grading.classes.tables import made_table, number_in, read_table, safe_cell
from botschool.grading.classes.term import RECORD, record
from botschool.grading.classes.times import read_moment
from botschool.grading.declare.checks import plain
from botschool.grading.declare.exercise import Number, called
from botschool.output import save_bytes

_EPOCH = (2000, 1, 1, 0, 0, 0)
"""The time of files in a zip file, so that equal grades give equal files."""


OWN = (
    "class.html", "similar.html", "moodle.csv", "canvas.csv", "filled.csv", "moodle-feedback.zip",
    "canvas-feedback.zip", RECORD,
)  # fmt: skip
"""Names of these files."""
WORDS = "words.csv"
"""The texts of laboratories, for the instructor's points."""


def write_outputs(
    output: Path,
    rows: list[Row],
    register: Register,
    alike: bytes,
    rules: str,
) -> list[Path]:
    """Write the files that this class's platform and settings need; return their paths.

    alike: the page of similar submissions. rules: as in term.record. Raises BotschoolError.
    """
    made = {"class.html": _statistics(rows, register)}
    if alike:
        made["similar.html"] = alike
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
                name = f"{part.key}_assignsubmission_file_"
                folders = [path.name for path, _ in part.sources if path.is_dir()]
                upload = [each for each in folders if "assignsubmission_file" in each]
                page = (output / "feedback" / row.page).read_bytes()
                own[f"{[*upload, name][0]}/feedback.html"] = page
            elif part.platform == "canvas":  # a text under the name of the submission
                text = feedback_text(row.name, row.results, row.notes)
                own |= dict.fromkeys(part.names[:1], text.encode("utf-8", "replace"))
    return {name: _zip(own) for name, own in files.items() if own}


def filled(output: Path, members: Members, comment: Callable[[Row], str]) -> dict[str, bytes]:
    """Return the platform's table with grades and comments: name of the file -> content."""
    book = members.policy.gradebook
    if book is None:
        return {}
    points = {
        at: (row.total, comment(row), row.name)
        for row in members.rows
        for at in row.student.rows
        if row.total is not None
    }
    name = {"moodle": "moodle.csv", "canvas": "canvas.csv", "plain": "filled.csv"}[book.kind]
    if output / name == book.table.path:
        raise BotschoolError(f"{book.table.path} would be overwritten: give another copy of it.")
    if book.kind == "moodle":
        return {name: moodle_worksheet(book, points, members.maximum)}
    column, notes = members.policy.column, members.notes
    return {name: gradebook_with(book, points, members.maximum, column, notes)}


def _words(output: Path, rows: list[Row], register: Register) -> dict[str, bytes]:
    """Return the table of the laboratories' texts, in which the instructor writes points.

    What stands in the table stays there, with a note where a text has changed since.
    """
    place, before = output / WORDS, dict[tuple[str, str], list[str]]()
    head = ["student", "exercise", "points", "comment", "text", "rubric"]
    if place.is_file():
        table = read_table(place)
        for old in table.rows:
            cells = [table.get(old, each) for each in head]
            before[cells[0].lstrip("'"), cells[1]] = cells
    found = []
    for row in rows:
        for task in [task for result in row.results for task in result["tasks"]]:
            if not (text := task.get("words", "")):
                continue
            what = task["id"]
            old = before.pop((row.name, what), [""] * 6)
            if old[2] and old[4] != safe_cell(text):
                register.notes.append(
                    f"{row.name} has changed {what} since you gave {old[2]} points: look at "
                    f"{place} again."
                )
            rubric = task.get("rubric", task["message"])
            found.append([row.name, what, *old[2:4], text, rubric])
    found += [cells for cells in before.values() if cells[2] or cells[3]]
    return {WORDS: made_table([head, *found])} if found else {}


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
    if odd := [row.name for row in rows if row.page and any(r["problem"] for r in row.results)]:
        notes.append(f"{len(odd)} without a program to grade, so in no count: {', '.join(odd)}.")
    people = [(row.name, row.page, row.results) for row in rows]
    return statistics_page(by_task(people), notes).encode("utf-8", "replace")


def similar(
    rows: list[Row],
    asked: Iterable[Number],
    skeletons: Mapping[Number, str],
    solutions: Mapping[Number, str],
) -> bytes:
    """Return the page of similar submissions; b"" if there is nothing to compare.

    Whose program is nearly our solution gets a remark for the instructor.
    """
    found = {}
    for number in [each for each in asked if isinstance(each, int)]:
        programs = {}
        for row in rows:
            for result in row.results:  # a group's file is there once for each member
                if result["exercise"] == number and result.get("code"):
                    programs.setdefault(result["file"], Program(row.name, result["code"]))
        own = [*programs.values()]
        pairs = similar_pairs(own, skeletons[number], solutions.get(number, ""))
        ours = like_ours(pairs)
        for row in rows:
            if row.name in ours:
                share = f"{round(100 * ours[row.name])}% like our solution, see similar.html."
                row.remarks.append(f"{called(number)}: {share}")
        if len(programs) > 1 or pairs:
            found[number] = (len(programs), grouped(pairs))
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


Points = dict[int, tuple[float, str, str]]
"""Number of a row -> the total, the comment and the name of the student who was graded."""


def moodle_worksheet(roster: Roster, points: Points, maximum: float) -> bytes:
    """Return Moodle's grading worksheet with grades and comments; others' cells stay as they are.

    maximum: the most that the total can be. The grade is scaled to the worksheet's maximum, which
    stands right of it. Comments stand in the last column, which is no column of times.
    """
    table, last = deepcopy(roster.table), len(roster.table.head) - 1
    cells = [table.cell(row, last) for row in table.rows]
    has_comments = last > roster.grade + 1 and not any(
        cell == "-" or read_moment(cell) for cell in cells
    )
    for at, (total, said, _) in points.items():
        row = table.rows[at]
        row += [""] * (len(table.head) - len(row))
        most = number_in(table.cell(row, roster.grade + 1), MOST_POINTS)
        row[roster.grade] = f"{total * (most / maximum if most and maximum else 1.0):.2f}"
        if has_comments and said:
            row[last] = safe_cell(said)
    return table.text()


def gradebook_with(
    roster: Roster, points: Points, maximum: float, column: str, notes: list[str]
) -> bytes:
    """Return Canvas's gradebook with the columns that identify students, and one of grades.

    Another platform's table keeps all columns. column: the head of the assignment's column, with
    or without Canvas's number, or a part of it. Raises BotschoolError where not exactly one fits.
    The grade is scaled to the points that the table names. Who is excused there (EX) stays so;
    notes: gets a sentence on that.
    """
    table = roster.table
    choice = roster.numbered or [*range(len(table.head))]
    index = _column(table.head, choice, column)
    if index is None:
        names = plain(" ".join(", ".join(table.head[i] for i in choice[:10]).split())) or "none"
        raise BotschoolError(
            f"{table.path}: name one assignment's column with --column; there are: {names}."
        )
    above = {at: number_in(table.cell(table.rows[at], index), MOST_POINTS) for at in roster.above}
    in_head = re.search(r"(?:MaxPoints|Total Pts)\W*(\d+)", table.head[index])  # D2L, Blackboard
    most = next(filter(None, above.values()), float(in_head[1]) if in_head else None)
    scale = most / maximum if most and maximum else 1.0
    made, excused = deepcopy(table), []
    kept = [*roster.columns, index] if roster.kind == "canvas" else [*range(len(table.head))]
    made.head = [table.head[i] for i in kept]
    made.rows = []
    for at, row in enumerate(table.rows):
        row = row + [""] * (len(table.head) - len(row))
        if at in points and row[index].strip().upper() == "EX":
            excused.append(points[at][2])
        elif at in points:
            row[index] = str(tidy(points[at][0] * scale))
        if at in points or above.get(at) or roster.kind != "canvas":
            made.rows.append([row[i] for i in kept])
    if excused:
        notes.append(f"Excused in {table.path.name}, so without a grade there: {listed(excused)}.")
    return made.text()


def _column(heads: Sequence[str], choice: Sequence[int], wanted: str) -> int | None:
    """Return the column of this head; else of the head without Canvas's number; else of a part."""
    wanted = wanted.strip().casefold()
    own = {i: heads[i].strip().casefold() for i in choice}
    for fits in (
        lambda head: head == wanted,
        lambda head: re.sub(r"\s*\(\d+\)$", "", head) == wanted,
        lambda head: wanted in head,
    ):
        if found := [i for i, head in own.items() if fits(head)]:
            return found[0] if len(found) == 1 else None
    return None


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
