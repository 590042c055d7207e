"""The students of a class, as a table of any platform, in any language, lists them."""

from __future__ import annotations

import itertools
import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from functools import cached_property
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.classes.join import clean, derive, folded, is_name
from botschool.grading.classes.rules import MOST_POINTS
from botschool.grading.classes.tables import Table, number_in, read_table
from botschool.grading.classes.times import read_moment
from botschool.grading.declare.checks import plain

PEOPLE = "people.csv"
"""The table, in the class's folder, that says whose an entry of a download is."""
_NUMBERED = re.compile(r"(.*\S)\s*\(\d+\)\s*")
"""The head of an assignment in Canvas's gradebook."""
_TEST_STUDENT = "Student, Test"
"""Canvas's name of the instructor's view."""
_YEAR = re.compile(r"(?<!\d)20\d\d(?!\d)")


@dataclass(eq=False)
class Student:
    """A person of the class."""

    name: str
    """The name to show."""
    values: dict[str, str]
    """What the class's tables say: where it stands -> the value."""
    rows: list[int] = field(default_factory=list)
    """Numbers of rows in the platform's table."""
    listed: bool = True
    """Whether the person is on the class list."""
    cells: dict[str, str] = field(default_factory=dict)
    """The row's own cells, by their heads, for the table of grades."""

    @property
    def words(self) -> set[str]:
        """Return the words by which settings may name the person."""
        return {folded(text) for text in [self.name, *self.values.values()] if text}


class Roster:
    """The students of a table, and the columns that take grades."""

    def __init__(self, table: Table) -> None:
        """Read who stands there. Raises BotschoolError."""
        self.table = table
        self.notes: list[str] = []
        self.grade = _grade_column(table)
        """The column of grades in Moodle's worksheet."""
        self.numbered = [i for i, head in enumerate(table.head) if _NUMBERED.fullmatch(head)]
        self.kind = "plain"
        if self.grade is not None:
            self.kind = "moodle"
        elif self.numbered and self.numbered[0] > 1:
            self.kind = "canvas"
        ends = {"moodle": self.grade, "canvas": (self.numbered or [0])[0]}
        self.columns = [*range(len(table.head))][: ends.get(self.kind)]
        """The columns that say who somebody is."""
        self.heads = _different([table.head[i].strip() for i in self.columns])
        self.students = self._students()
        if not any(student.values for student in self.students):
            raise BotschoolError(f"{table.path} names no students: it has a head and no rows.")

    def _students(self) -> list[Student]:
        cells = [[self.table.cell(row, i) for i in self.columns] for row in self.table.rows]
        if self.kind == "canvas":  # rows above the students have no id
            self.above = [at for at, row in enumerate(cells) if not any(row[1:])]
        else:
            self.above = []
        rows = [
            dict(zip(self.heads, row, strict=True)) if at not in self.above and any(row) else {}
            for at, row in enumerate(cells)
        ]
        # the last one before Moodle's grades is the status, or the group
        until = max(1, len(self.heads) - 1) if self.kind == "moodle" else None
        names = _names([row for row in rows if row], self.heads[:until])
        shown = iter(names)
        names = [next(shown) if row else "" for row in rows]
        derive([row for row in rows if row], self.heads)
        found: dict[tuple, Student] = {}
        for at, (row, name) in enumerate(zip(rows, names, strict=True)):
            is_test = self.kind == "canvas" and cells[at][0] == _TEST_STUDENT
            if not row or is_test:
                continue
            cells_ = {head: row[head] for head in self.heads}
            student = Student(name, row, cells=cells_)
            student = found.setdefault(tuple(map(clean, cells[at])), student)
            student.rows.append(at)
        for student in found.values():
            if len(student.rows) > 1:
                self.notes.append(
                    f"{self.table.path.name} names {plain(student.name)} {len(student.rows)} "
                    f"times (rows {', '.join(str(at + 2) for at in student.rows)}): taken for one "
                    "student."
                )
        return [*found.values()]

    @cached_property
    def times(self) -> dict[int, datetime]:
        """Return when each row's work was handed in: Moodle's first column of times."""
        for column in range((self.grade or 0) + 2, len(self.table.head)) if self.grade else ():
            cells = {at: self.table.cell(row, column) for at, row in enumerate(self.table.rows)}
            found = {at: read_moment(cell) for at, cell in cells.items() if _YEAR.search(cell)}
            if found and any(found.values()):
                return {at: moment for at, moment in found.items() if moment}
        return {}

    @cached_property
    def extensions(self) -> dict[int, datetime]:
        """Return Moodle's extensions, which stand as a date in the text of the status."""
        found: dict[int, datetime] = {}
        for at, row in enumerate(self.table.rows) if self.kind == "moodle" else ():
            for cell in [self.table.cell(row, i) for i in self.columns[1:]]:
                if not _YEAR.search(cell) or not re.search(r"[^\W\d_]{3}", cell):
                    continue
                if moment := read_moment(cell):
                    found[at] = moment
                elif ":" in cell:
                    self.notes.append(
                        f"{self.table.path.name}, row {at + 2}: '{plain(cell)}' cannot be read as "
                        "a time. If it is an extension, write it into class.yaml."
                    )
        return found

    def number(self, at: int) -> str:
        """Return the number in the first cell of a row of Moodle's worksheet."""
        digits = re.search(r"\d+", self.table.cell(self.table.rows[at], 0))
        return digits[0] if digits else ""


def _grade_column(table: Table) -> int | None:
    """Return the column of grades in Moodle's worksheet; None for other tables.

    Its first cells are a word and a number ("Participant 9001", in any language); right of the
    grades stands their maximum, which is the same number in all rows.
    """
    first = [re.fullmatch(r"(\D*)(\d+)(\D*)", table.cell(row, 0)) for row in table.rows]
    around = {(each[1], each[3]) if each else None for each in first}
    if not first or len(around) != 1 or not re.search(r"[^\W\d_]", "".join(min(around) or ())):
        return None
    for column in range(1, len(table.head) - 1):
        most = {table.cell(row, column + 1) for row in table.rows}
        number = number_in(min(most), MOST_POINTS) if len(most) == 1 else None
        grades = [table.cell(row, column) for row in table.rows]
        if number and all(g in ("", "-") or number_in(g, number) is not None for g in grades):
            return column
    return None


def _different(heads: Sequence[str]) -> list[str]:
    """Return the heads, with numbers where two are the same."""
    seen: Counter = Counter()
    found = []
    for head in heads:
        seen[head] += 1
        found.append(f"{head} {seen[head]}" if seen[head] > 1 else head)
    return found


def _names(rows: Sequence[dict[str, str]], heads: Sequence[str]) -> list[str]:
    """Return the name to show of each row.

    It stands in the first column whose cells are mostly different names of two words, else in the
    first two columns that make such names, else in the first column of different words.
    """
    least = max(1, (len(rows) + 1) // 2)

    def cells(head: str) -> list[str]:
        return [row[head] for row in rows]

    def fits(texts: Iterable[str], test: Any) -> bool:
        own = [folded(text) for text in texts if text and test(text)]
        return len(own) >= least and len(set(own)) * 2 >= len(own)

    for head in heads:
        if fits(cells(head), lambda text: is_name(re.sub(r"(?<=[^\W\d])\d+", "", text))):
            return _unique([_turned(text) for text in cells(head)], rows, heads)
    for a, b in itertools.pairwise(heads):
        pairs = [(row[a], row[b]) for row in rows]
        both = [f"{one} {other}".strip() for one, other in pairs]
        small = sum(not (_begins(one) and _begins(other)) for one, other in pairs)
        if all(map(all, pairs)) and small * 5 < len(rows) and fits(both, is_name):
            return _unique(both, rows, heads)  # a user's name begins with a small letter
    for head in heads:
        if fits(cells(head), lambda text: re.search(r"[^\W\d_]", text)) and all(cells(head)):
            return _unique(cells(head), rows, heads)
    return _unique([""] * len(rows), rows, heads)


def _begins(name: str) -> bool:
    """Return whether a word begins as names do, in scripts with capitals with one."""
    return name[:1].isalpha() and not name[:1].islower()


def _turned(name: str) -> str:
    last, comma, first = name.partition(",")
    return f"{first.strip()} {last.strip()}" if comma and "," not in first else name


def _unique(names: list[str], rows: Sequence[dict[str, str]], heads: Sequence[str]) -> list[str]:
    """Return the names; who has none, or another's, is called by the next cell that nobody has."""
    counts = Counter(map(folded, names))
    cells = {head: Counter(folded(row[head]) for row in rows) for head in heads}
    found = []
    for name, row in zip(names, rows, strict=True):
        own = [row[h] for h in heads if row[h] and row[h] != name and cells[h][folded(row[h])] == 1]
        if not name:
            name = next(iter(own), next(filter(None, row.values()), ""))
        elif counts[folded(name)] > 1 and own:
            name = (
                f"{name} ({min(own, key=lambda text: (not re.search(r'[0-9@]', text), len(text)))})"
            )
        found.append(name)
    return found


def read_roster(path: Path) -> Roster:
    """Return the class of a CSV file. Raises BotschoolError."""
    return Roster(read_table(path))


class Named:
    """Students by the words that settings may call them."""

    def __init__(self, students: Iterable[Student]) -> None:
        """Note everybody's words."""
        self._places: dict[str, list[Student]] = defaultdict(list)
        for student in students:
            for word in student.words:
                self._places[word].append(student)

    def find(self, word: str) -> Student | None:
        """Return the only student with this word; None if there is none, or more than one.

        Of several words that differ in capitals the one in exactly these letters counts.
        """
        there = self._places.get(folded(word), [])
        if len(there) > 1:
            own = clean(word)
            there = [s for s in there if own in (s.name, *map(clean, s.values.values()))]
        return there[0] if len(there) == 1 else None


@dataclass
class Answers:
    """What PEOPLE says: the folder or file of a download -> a word for a student."""

    path: Path
    of: dict[str, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def line(self, folder: str) -> str:
        """Return the line to add for an entry."""
        quoted = '"' + folder.replace('"', '""') + '"' if re.search('[",;]', folder) else folder
        return f"IDENTIFIER,{quoted}"


def read_answers(folder: Path) -> Answers:
    """Return what the instructor wrote into PEOPLE. Raises BotschoolError."""
    found = Answers(folder / PEOPLE)
    if not found.path.is_file():
        return found
    table = read_table(found.path)
    who, where = table.column("identifier"), table.column("folder")
    if who is None or where is None:
        found.notes.append(
            f"{found.path} has no effect: it needs the columns 'identifier' and 'folder'."
        )
        return found
    pairs = [(table.cell(row, where), table.cell(row, who)) for row in table.rows]
    found.of = {clean(folder.lstrip("'")): word.lstrip("'") for folder, word in pairs if word}
    return found
