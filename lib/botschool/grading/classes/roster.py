"""Read the class list, and match submissions with its students."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.classes.identity import Known, Student, letters, words
from botschool.grading.classes.people import Person
from botschool.grading.classes.tables import Table, read_table
from botschool.grading.declare.checks import plain


@dataclass
class Roster:
    """The students of a class, from a table of any platform."""

    table: Table
    students: list[Student]
    kind: str
    """moodle (a grading worksheet), canvas (a gradebook) or plain."""
    notes: list[str] = field(default_factory=list)
    """Sentences on students who stand there more than once."""
    _by_key: dict[str, list[Student]] = field(default_factory=dict)

    def find(self, key: str) -> Student | None:
        """Return the only student with this id, mail, user name or name; else None."""
        if not self._by_key:
            for student in self.students:
                for each in student.keys() | student.names():
                    self._by_key.setdefault(each, []).append(student)
        for each in (key.strip().casefold(), words(key)):
            found = self._by_key.get(each, []) if each else []
            if len(found) == 1:
                return found[0]
        return None

    def match(self, person: Person) -> Student | None:
        """Return the student who handed this in; None if there is none or more than one."""
        numbers = {"moodle": "participant", "canvas": "user"}
        if number := person.ids.get(numbers.get(person.platform, "")):
            key = "participant" if person.platform == "moodle" else "canvas"
            found = [each for each in self.students if getattr(each, key) == number]
            if len(found) == 1:
                return found[0]
        names = [person.ids.get("email", ""), person.ids.get("sid", ""), person.student]
        if not person.platform:
            names.append(person.folder)
        if person.platform in ("", "moodle"):
            # ASSIGNMENT-USER or GROUP-NAME; the longest user name wins, as it may hold hyphens
            whole = person.student if person.platform else person.folder
            parts = re.sub(r"-(main|master)$", "", whole).split("-")
            names += ["-".join(parts[at:]) for at in range(1, len(parts))]
        for name in names:
            if name and (student := self.find(name)):
                return student
        if not person.platform:  # NAME - FILE, TITLE_USER_attempt_TIME_FILE
            pieces = re.split(r"\s+-\s+|_", person.folder)
            found = list(filter(None, map(self.find, filter(None, pieces))))
            if len(set(found)) == 1:
                return found[0]
        if person.platform == "canvas":
            return self._of_squashed(person.student)
        return None

    def _of_squashed(self, name: str) -> Student | None:
        """Return the student for Canvas's form lastnamefirst."""
        fitting = []
        for student in self.students:
            parts = letters(student.name.replace(",", " ")).split()
            turned = ["".join(parts[at:] + parts[:at]) for at in range(len(parts))]
            if letters(name).replace(" ", "") in turned:
                fitting.append(student)
        return fitting[0] if len(fitting) == 1 else None


def read_roster(path: Path) -> Roster:
    """Return the class of a CSV file. Raises BotschoolError."""
    table = read_table(path)
    get = table.get
    points_row = 0
    kind = "plain"
    if table.column("participant") is not None and "Grade" in " ".join(table.head):
        kind = "moodle"
    elif table.head[0].strip() == "Student" and table.column("id") is not None:
        kind = "canvas"
        points_row = next(
            (i for i, row in enumerate(table.rows, 1) if "points possible" in row[0].lower()), 0
        )
    students = []
    for index, row in enumerate(table.rows):
        name = get(row, "name") or f"{get(row, 'first')} {get(row, 'last')}".strip()
        if kind == "canvas" and (index < points_row or name == "Student, Test"):
            continue
        if "," in name:
            last, _, first = name.partition(",")
            name = f"{first.strip()} {last.strip()}"
        digits = re.search(r"\d+", get(row, "participant"))
        number = get(row, "id")
        student = Student(
            name or get(row, "user") or get(row, "mail") or number,
            get(row, "sisuserid") if kind == "canvas" else number,
            get(row, "mail"),
            get(row, "user"),
            digits[0] if digits else "",
            number if kind == "canvas" else "",
            index,
        )
        if student.name:
            students.append(student)
    if not students:
        heads = plain(" ".join(", ".join(table.head).split())[:80])
        raise BotschoolError(
            f"{path} names no students: it needs a column 'name' (or 'first_name' and "
            f"'last_name'), 'id' or 'email'; its columns are {heads}."
        )
    known = Known()
    known.add(students, equal=[tuple(table.rows[each.row]) for each in students])
    notes = [
        f"{path.name} names {plain(each.name)} {len(each.rows)} times (rows "
        f"{', '.join(str(row + 2) for row in each.rows)}): taken for one student."
        for each in known.people
        if each.again
    ]
    return Roster(table, known.people, kind, notes)
