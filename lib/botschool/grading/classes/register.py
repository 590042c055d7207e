"""Match submissions with the class list, and compute each person's points."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.classes.choice import Choice
from botschool.grading.classes.files import File
from botschool.grading.classes.finding import Submission
from botschool.grading.classes.people import Person
from botschool.grading.classes.policy import Policy, moodle_moment, tidy, unknown_names
from botschool.grading.classes.roster import Roster, Student
from botschool.grading.classes.times import told_by
from botschool.grading.classes.wall import Broken, walled
from botschool.grading.declare.exercise import Number

_NUMBERS = ("participant", "user", "sid", "submission")
"""Ids that distinguish people of one name."""
MISSING = "Nothing was handed in."


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
class Graded:
    """A row of the class's table."""

    submission: Submission
    name: str
    """The student's name."""
    page: str
    """The name of the feedback page; "" for somebody who handed in nothing."""
    results: list[dict[str, Any]]
    total: float | None
    """The points of all exercises; None if one of them was not graded."""


def _told(file: File) -> datetime | None:
    try:
        return walled(told_by, file)
    except Broken:
        return None


class Register:
    """Match submissions with the students of the class.

    Students without a submission stand at the end, with an entry that says so.
    """

    def __init__(self, submissions: list[Submission], settings: Settings) -> None:
        """Match them. Raises BotschoolError if the settings name an unknown person."""
        self.settings = settings
        self.policy = settings.policy
        self.roster = settings.roster or settings.gradebook
        self.submissions = list(submissions)
        self.students: list[Student | None] = [
            self.roster.match(one.person) if self.roster else None for one in submissions
        ]
        self._handed_in = len(submissions)
        self._shown = Counter(one.student for one in submissions)
        self.unknown = [
            one.student
            for one, student in zip(submissions, self.students, strict=True)
            if self.roster and student is None
        ]
        self.missing: list[Student] = []
        if self.roster:
            there = set(self.students)
            self.missing = [each for each in self.roster.students if each not in there]
        numbers = list(submissions[0].choices) if submissions else []
        for student in self.missing:
            person = Person(student.name, student.id or student.name, problem=MISSING)
            choices = {number: Choice(problem=MISSING, unread=True) for number in numbers}
            self.submissions.append(Submission(person, choices))
            self.students.append(student)
        self._names = [
            self.policy.names(student, one.student if student else self.name(index))
            for index, (one, student) in enumerate(
                zip(self.submissions, self.students, strict=True)
            )
        ]
        self._told = {
            (index, number): _told(choice.origin)
            for index, one in enumerate(submissions)
            for number, choice in one.choices.items()
            if choice.origin and not one.person.platform and self.policy.has_deadline(number)
        }
        self._check_names()
        self._mark_doubles()

    def name(self, index: int) -> str:
        """Return a student's name, from the roster if possible."""
        student, one = self.students[index], self.submissions[index]
        if student:
            return student.name
        numbers = [one.person.ids[each] for each in _NUMBERS if one.person.ids.get(each)]
        is_shared = self._shown[one.student] > 1 and numbers
        return f"{one.student} ({numbers[0]})" if is_shared else one.student

    def is_missing(self, index: int) -> bool:
        """Return whether a row stands for a student who handed in nothing."""
        return index >= self._handed_in

    def moment(self, index: int, number: Number) -> datetime | None:
        """Return when an exercise was handed in, if the platform or the files tell."""
        person, student = self.submissions[index].person, self.students[index]
        if not person.platform and self.policy.has_deadline(number):
            return self._told.get((index, number))
        if person.submitted is None and student and self.roster.kind == "moodle":
            row = self.roster.table.rows[student.row]
            return moodle_moment(self.roster.table.get(row, "submitted"))
        return person.submitted

    def apply(self, index: int, result: dict[str, Any]) -> dict[str, Any]:
        """Return a result with deadlines and adjustments."""
        late = self.submissions[index].person.late
        moment = self.moment(index, result["exercise"])
        return self.policy.apply(result, self._names[index], moment, late)

    def total(self, results: list[dict[str, Any]]) -> float | None:
        """Return the weighted points of all exercises; None if one of them was not graded."""
        if not all(result["graded"] for result in results):
            return None
        return tidy(sum(self.policy.weight(r["exercise"]) * r["points"] for r in results))

    def maximum(self, results: list[dict[str, Any]]) -> float:
        """Return the most that a total can be."""
        return tidy(sum(self.policy.weight(r["exercise"]) * r["max_points"] for r in results))

    def counts(self) -> dict[Student, list[int]]:
        """Return the rows of each student who handed something in."""
        found: dict[Student, list[int]] = {}
        for index, student in enumerate(self.students):
            if student and not self.is_missing(index):
                found.setdefault(student, []).append(index)
        return found

    def _check_names(self) -> None:
        known = {name for names in self._names for name in names}
        if nobody := unknown_names(self.policy, known):
            raise BotschoolError(
                f"The class's settings name {nobody[0]}, who is not in the class: write the id, "
                "email, user name or name of a student."
            )
        people = Counter()
        for student, names in zip(self.students, self._names, strict=True):
            people.update({(name, student) for name in names} if student else ())
        several = Counter(name for name, _ in people)
        for name in (*self.policy.extensions, *self.policy.adjustments, *self.policy.submitted):
            if several[name] > 1:
                raise BotschoolError(
                    f"The class's settings name {name}, which is the name of {several[name]} "
                    "students: write the id or the email."
                )

    def _mark_doubles(self) -> None:
        for rows in self.counts().values():
            if len(rows) > 1:
                for index in rows:
                    others = [self.submissions[each].student for each in rows if each != index]
                    self.submissions[index].notes.append(
                        f"The same student handed in {len(rows)} times, also as "
                        f"{', '.join(others)}: the better submission goes into the gradebook."
                    )
