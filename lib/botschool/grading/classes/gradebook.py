"""Write grades and feedback in the formats that learning platforms import."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Sequence
from copy import deepcopy
from io import BytesIO
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.classes.identity import Student
from botschool.grading.classes.people import Person
from botschool.grading.classes.roster import Roster
from botschool.grading.classes.rules import tidy
from botschool.grading.classes.tables import safe_cell
from botschool.grading.declare.checks import plain
from botschool.grading.declare.exercise import called

MOST_POINTS = 1e6
_EPOCH = (2000, 1, 1, 0, 0, 0)
"""The time of files in a zip file, so that equal grades give equal files."""


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


def moodle_feedback(pages: Sequence[tuple[Person, bytes]]) -> bytes:
    """Return Moodle's zip file of feedback: a page for each participant, in its own folder."""
    files = {}
    for person, page in pages:
        name = f"{person.student}_{person.ids['participant']}_assignsubmission_file_"
        upload = [each for each in person.upload if "assignsubmission_file" in each]
        files[f"{upload[0] if upload else name}/feedback.html"] = page
    return _zip(files)


def canvas_feedback(texts: Sequence[tuple[Person, str]]) -> bytes:
    """Return Canvas's zip file of feedback: texts under the names of the submissions."""
    return _zip(
        {
            name: text.encode("utf-8", "replace")
            for person, text in texts
            for name in person.upload[:1]
        }
    )


def feedback_text(student: str, results: list[dict[str, Any]], notes: Sequence[str]) -> str:
    """Return a student's feedback as plain text."""
    lines = [f"Feedback for {student}", ""]
    lines += notes
    for result in results:
        points = result["points"] if result["graded"] else "-"
        head = f"{called(result['exercise'])}. {result['title']}"
        lines += ["", f"{head}: {points} of {result['max_points']} points"]
        lines += [*result["notes"], *filter(None, [result["problem"], result["banner"]])]
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
