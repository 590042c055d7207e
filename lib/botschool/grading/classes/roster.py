"""Read the class list, and match submissions with its students."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass, field, replace
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.classes.people import Person
from botschool.grading.classes.tables import Table, read_table
from botschool.grading.declare.checks import plain


@dataclass(frozen=True)
class Student:
    """A row of a roster."""

    name: str
    id: str = ""
    mail: str = ""
    user: str = ""
    participant: str = ""
    """Moodle's number."""
    canvas: str = ""
    """Canvas's number."""
    row: int = 0
    again: tuple[Student, ...] = ()
    """Further rows of the same student."""

    @property
    def rows(self) -> list[int]:
        return [self.row, *(each.row for each in self.again)]

    @property
    def is_named(self) -> bool:
        """Return whether the table has a name, for which else a key stands."""
        return self.name not in (self.user, self.mail, self.id)

    def keys(self) -> set[str]:
        """Return the words that name only this student, in lower case."""
        given = (self.id, self.mail, self.user, self.mail.partition("@")[0])
        own = {key.casefold() for key in given if key}
        return own.union(*(each.keys() for each in self.again))

    def names(self) -> set[str]:
        """Return the words of the name, as each row has it."""
        return {words(each.name) for each in (self, *self.again)}


_KEYS, _NUMBERS = ("id", "mail", "user"), ("participant", "canvas")


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

    def find_student(self, student: Student) -> Student | None:
        """Return the row of this table for a student of another one."""
        if student in self.students:
            return student
        for key in (student.mail, student.id, student.user, student.name):
            if key and (found := self.find(key)):
                return found
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
            parts = _letters(student.name.replace(",", " ")).split()
            turned = ["".join(parts[at:] + parts[:at]) for at in range(len(parts))]
            if _letters(name).replace(" ", "") in turned:
                fitting.append(student)
        return fitting[0] if len(fitting) == 1 else None


def _letters(text: str) -> str:
    """Return the letters and digits of a text in lower case, without accents."""
    plain = unicodedata.normalize("NFKD", text.casefold())
    plain = "".join(letter for letter in plain if not unicodedata.combining(letter))
    return " ".join(re.findall(r"[^\W_]+", plain))


def words(name: str) -> str:
    """Return the words of a name in a fixed order."""
    return " ".join(sorted(_letters(name).split()))


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
    students, notes = _merged(students, table)
    return Roster(table, students, kind, notes)


def _merged(students: list[Student], table: Table) -> tuple[list[Student], list[str]]:
    """Return each student once, with all rows, and a sentence on each who has several.

    Rows are of one student if they have the same number of a platform, or are equal, or have an id,
    email or user name in common and one name holds the words of the other: tables put the same dash
    into many cells, so a key alone tells nothing.
    """
    found: list[Student] = []
    places: dict[tuple, list[int]] = {}
    for one in students:
        fields = {key: getattr(one, key) for key in (*_KEYS, *_NUMBERS)}
        keys: list[tuple] = [(key, value.casefold()) for key, value in fields.items() if value]
        keys.append(("row", *table.rows[one.row]))
        for kind, at in [(key[0], at) for key in keys for at in places.get(key, [])]:
            known = found[at]
            if kind not in _KEYS or any(_alike(one, row) for row in (known, *known.again)):
                filled = {key: getattr(known, key) or value for key, value in fields.items()}
                name = known.name if known.is_named or not one.is_named else one.name
                found[at] = replace(known, name=name, again=(*known.again, one), **filled)
                break
        else:
            at = len(found)
            found.append(one)
        for key in keys:
            places.setdefault(key, []).append(at)
    notes = [
        f"{table.path.name} names {plain(each.name)} {len(each.rows)} times (rows "
        f"{', '.join(str(row + 2) for row in each.rows)}): taken for one student."
        for each in found
        if each.again
    ]
    return found, notes


def _alike(one: Student, other: Student) -> bool:
    """Return whether two names may be of one student."""
    mine, others = set(words(one.name).split()), set(words(other.name).split())
    return mine <= others or others <= mine or not (one.is_named and other.is_named)
