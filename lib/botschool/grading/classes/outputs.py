"""Write the files beside the grades: statistics, similarities, gradebooks, feedback."""

from __future__ import annotations

from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.classes.gradebook import (
    canvas_feedback,
    canvas_gradebook,
    feedback_text,
    moodle_feedback,
    moodle_worksheet,
)
from botschool.grading.classes.identity import Student
from botschool.grading.classes.register import Register, Row, Settings
from botschool.grading.classes.sheets import Sheet, doubtful, sheets_section
from botschool.grading.classes.similar import Program, similar_pairs, similarity_page
from botschool.grading.classes.statistics import by_task, statistics_page
from botschool.grading.classes.tables import made_table, read_table, safe_cell
from botschool.grading.classes.term import RECORD, record
from botschool.grading.declare.exercise import Number, called
from botschool.output import save_bytes

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
    made |= _gradebook(output, rows, register)
    made |= _words(output, rows, register)
    for name, content in made.items():
        save_bytes(output / name, content)
    save_bytes(output / RECORD, record(rows, register.policy, rules))
    return [output / name for name in made]


def _feedback(output: Path, rows: list[Row]) -> dict[str, bytes]:
    """Return zip files of feedback to upload, one for each download: numbers differ in each."""
    made = {}
    parts = [(part.person, row) for row in rows for part in row.parts]
    for section in dict.fromkeys(person.section for person, _ in parts):
        name = f"-{Path(section).stem}" if section else ""
        own = [(person, row) for person, row in parts if person.section == section]
        if pages := [each for each in own if each[0].platform == "moodle"]:
            made[f"moodle-feedback{name}.zip"] = moodle_feedback(
                [(person, (output / "feedback" / row.page).read_bytes()) for person, row in pages]
            )
        if texts := [each for each in own if each[0].platform == "canvas"]:
            made[f"canvas-feedback{name}.zip"] = canvas_feedback(
                [(p, feedback_text(row.name, row.results, row.notes)) for p, row in texts]
            )
    return made


def _gradebook(output: Path, rows: list[Row], register: Register) -> dict[str, bytes]:
    points = {
        student: (row.total, _comment(row))
        for student, row in register.book_rows()
        if row.total is not None
    }
    return filled(output, register.settings, points, register.maximum())


def filled(
    output: Path, settings: Settings, points: dict[Student, tuple[float, str]], maximum: float
) -> dict[str, bytes]:
    """Return the platform's table with grades: name of the file -> content."""
    book = settings.gradebook
    if book is None:
        return {}
    if output / f"{book.kind}.csv" == book.table.path:
        raise BotschoolError(f"{book.table.path} would be overwritten: give another copy of it.")
    if book.kind == "moodle":
        return {"moodle.csv": moodle_worksheet(book, points, maximum)}
    return {"canvas.csv": canvas_gradebook(book, points, maximum, settings.column)}


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
    totals = [row.total for row in rows if row.total is not None]
    notes = [f"{sum(bool(row.page) for row in rows)} submissions."]
    if totals:
        mean, most = sum(totals) / len(totals), register.maximum()
        notes.append(f"{mean:.1f} of {most} points on average.")
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
                file = row.files[number]
                names = f"{found[file].student}, {row.name}" if file in found else row.name
                robots = frozenset(told["robots"])
                found[file] = Sheet(names, told["name"], robots, told["prediction"])
    return [*found.values()]
