"""The people of a class: who is who, what the settings call them, and their totals."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolErrors
from botschool.grading.classes.files import listed
from botschool.grading.classes.finding import Submission
from botschool.grading.classes.identity import Known, Student, ask
from botschool.grading.classes.roster import Roster
from botschool.grading.classes.rules import Policy
from botschool.grading.declare.exercise import Number


@dataclass
class Settings:
    """Settings and tables of a class."""

    policy: Policy = field(default_factory=Policy)
    roster: Roster | None = None
    gradebook: Roster | None = None
    """The platform's table, to fill in."""
    column: str = ""
    """The column in Canvas's gradebook."""


@dataclass
class Row:
    """A person of the class: a row of its table."""

    number: int
    """Among the known people."""
    name: str
    about: Student
    """All that tables and downloads say of the person."""
    student: Student | None
    """The person on the class list."""
    parts: list[Submission] = field(default_factory=list)
    """What the person handed in: one for each download."""
    group: list[tuple[Number, str, Submission]] = field(default_factory=list)
    """What members of the person's group handed in: the exercise (0: all), who, and what."""
    keys: list[str] = field(default_factory=list)
    """The words by which the settings may name the person."""
    page: str = ""
    """The name of the feedback page; "" for somebody who handed in nothing."""
    results: list[dict[str, Any]] = field(default_factory=list)
    total: float | None = None
    """The points of all exercises; None if one of them was not graded."""
    said: list[str] = field(default_factory=list)
    """Sentences on the term's total."""

    def handed(self, number: Number) -> list[tuple[str, Submission]]:
        """Return the submissions of an exercise; the group's if the person has none."""
        own = [("", part) for part in self.parts if number in part.files]
        return own or [
            (said, part)
            for which, said, part in self.group
            if number in part.files and which in (0, number)
        ]

    @property
    def is_missing(self) -> bool:
        """Return whether neither the person nor the group handed anything in."""
        numbers = {number for _, _, part in self.group for number in part.files}
        return not self.parts and not any(map(self.handed, numbers))

    @property
    def notes(self) -> list[str]:
        return [note for part in self.parts for note in part.notes]

    @property
    def files(self) -> dict[Number, Path]:
        """Return the graded file of each exercise."""
        return {r["exercise"]: r["file"] for r in self.results if r.get("file")}


class Members:
    """The people of a class, from its list, the platform's table, and what they handed in."""

    def __init__(self, settings: Settings) -> None:
        """Start with the tables."""
        self.settings, self.policy = settings, settings.policy
        self.roster = settings.roster or settings.gradebook
        self.rows: list[Row] = []
        self.notes: list[str] = []
        self._known = Known(self.policy.answers)
        self._of_book: dict[int, Student] = {}
        self._sheet: dict[str, int] = {}
        """Moodle's number -> row of the worksheet."""
        if self.roster:
            self._known.add(self.roster.students, "the class list")
        if book := settings.gradebook or self.roster:
            found = self._known.add(book.students, book.table.path.name)
            self._of_book = dict(zip(found, book.students, strict=True))
            self._sheet = {
                row.participant: row.row
                for each in book.students
                for row in (each, *each.again)
                if row.participant
            }

    @property
    def unknown(self) -> list[str]:
        """Return the names of people who are not on the class list, if there is one."""
        return [row.name for row in self.rows if self.roster and row.student is None]

    @property
    def missing(self) -> list[Row]:
        return [row for row in self.rows if row.is_missing]

    def lacking(self) -> list[str]:
        """Return sentences on people who handed in nothing, or are not on the class list."""
        nothing, strangers = listed([row.name for row in self.missing]), listed(self.unknown)
        said = [f"Nothing from: {nothing}."] if nothing else []
        return said + ([f"Not on the roster: {strangers}."] if strangers else [])

    def row(self, number: int, name: str) -> Row:
        """Return a row for a person; name: of one who is not on the class list."""
        students = self.roster.students if self.roster else []
        student = students[number] if number < len(students) else None
        about = self._known.people[number]
        ids = {each.id.casefold() for each in self._known.people}
        bare = [each.partition(" ")[2] for each in about.numbers()]
        keys = [*about.called(), *(each for each in bare if each not in ids)]
        for pair in self.policy.answers.items():  # another email of the same person
            both = [each.casefold() for each in pair]
            keys += both if any(each in keys for each in both) else []
        shown = student.name if student else name
        return Row(number, shown, about, student, keys=list(dict.fromkeys(keys)))

    def ask(self) -> None:
        """Put doubtful people into the table in the class's folder."""
        doubts = self._known.doubts
        self.doubtful = [each for each in doubts if not each.taken]
        self.notes += ask(self.policy.folder, doubts) if self.policy.folder else []

    def check_names(self, numbers: Collection[Number]) -> None:
        """Raise BotschoolErrors with what is wrong in the settings, and whom they cannot mean.

        numbers: the exercises whose rules matter.
        """
        errors, policy = list(self.policy.errors), self.policy
        counts = Counter(key for row in self.rows for key in row.keys)
        members = [each for group in policy.groups.values() for each in group if self.roster]
        for name in dict.fromkeys([*policy.named(numbers), *members]):
            place = policy.places.get(name, "The class's settings:")
            if counts[name] == 0:
                errors.append(
                    f"{place} names {name}, who is not in the class: write the id, email, user "
                    "name or name of a student."
                )
            elif counts[name] > 1:
                errors.append(
                    f"{place} names {name}, which is the name of {counts[name]} students: write "
                    "the id or the email."
                )
        if errors:
            raise BotschoolErrors(errors)

    def book_rows(self) -> Iterator[tuple[Student, Row]]:
        """Yield each student of the gradebook with the row."""
        for row in self.rows:
            if student := self._of_book.get(row.number):
                yield student, row
