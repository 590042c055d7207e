"""Match submissions with the people of the class, and compute each person's points."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolErrors
from botschool.grading.classes.choice import Choice
from botschool.grading.classes.files import File, listed
from botschool.grading.classes.finding import Submission
from botschool.grading.classes.identity import Known, Student, ask, letters
from botschool.grading.classes.people import Person
from botschool.grading.classes.policy import moodle_moment
from botschool.grading.classes.roster import Roster
from botschool.grading.classes.rules import Policy
from botschool.grading.classes.times import told_by
from botschool.grading.classes.wall import Broken, walled
from botschool.grading.declare.exercise import Number, called

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
    group: list[tuple[str, Submission]] = field(default_factory=list)
    """What members of the person's group handed in: who, and what."""
    keys: list[str] = field(default_factory=list)
    """The words by which the settings may name the person."""
    page: str = ""
    """The name of the feedback page; "" for somebody who handed in nothing."""
    results: list[dict[str, Any]] = field(default_factory=list)
    total: float | None = None
    """The points of all exercises; None if one of them was not graded."""
    said: list[str] = field(default_factory=list)
    """Sentences on the total."""

    def handed(self, number: Number) -> list[tuple[str, Submission]]:
        """Return the submissions of an exercise; the group's if the person has none."""
        own = [("", part) for part in self.parts if number in part.files]
        return own or [each for each in self.group if number in each[1].files]

    @property
    def is_missing(self) -> bool:
        """Return whether neither the person nor the group handed anything in."""
        return not self.parts and not any(part.files for _, part in self.group)

    @property
    def notes(self) -> list[str]:
        return [note for part in self.parts for note in part.notes]

    @property
    def files(self) -> dict[Number, Path]:
        """Return the graded file of each exercise."""
        return {r["exercise"]: r["file"] for r in self.results if r.get("file")}


def _told(file: File) -> datetime | None:
    try:
        return walled(told_by, file)
    except Broken:
        return None


def _entry(person: Person, row: int) -> Student:
    """Return what a download says of a person."""
    ids = person.ids
    canvas = ids.get("user", "") if person.platform == "canvas" else ""
    mail, participant = ids.get("email", ""), ids.get("participant", "")
    return Student(person.student, ids.get("sid", ""), mail, "", participant, canvas, row)


class Register:
    """Match submissions with the people of the class.

    Each person has one row, whatever the number of downloads. People without a submission stand at
    the end.
    """

    def __init__(
        self, submissions: list[Submission], settings: Settings, folder: Path | None = None
    ) -> None:
        """Match them; folder: the class's, for questions.

        Raises BotschoolErrors, with all that is wrong in the settings.
        """
        self.settings, self.policy = settings, settings.policy
        self.roster = settings.roster or settings.gradebook
        self._known = Known(self.policy.answers)
        self._shown = Counter((one.person.section, one.student) for one in submissions)
        self._of_book: dict[int, Student] = {}
        self._sheet: dict[str, int] = {}
        """Moodle's number -> row of the worksheet."""
        number_of = self._number(submissions)
        self.rows = self._rows(submissions, number_of)
        self._check_names()
        self._join_groups()
        self.unknown = [row.name for row in self.rows if self.roster and row.student is None]
        self.missing = [row for row in self.rows if row.is_missing]
        self._told = {
            (id(part), number): _told(choice.origin)
            for part in submissions
            for number, choice in part.choices.items()
            if choice.origin and not part.person.platform and self.policy.has_deadline(number)
        }
        doubts = self._known.doubts
        self.doubtful = [each for each in doubts if not each.taken]
        self.notes = ask(folder, doubts) if folder else []

    def _number(self, submissions: list[Submission]) -> list[int]:
        """Return the number of each submission's person among the known ones."""
        book = self.settings.gradebook
        if self.roster:
            self._known.add(self.roster.students, "the class list")
        if book := book or self.roster:
            found = self._known.add(book.students, book.table.path.name)
            self._of_book = dict(zip(found, book.students, strict=True))
            self._sheet = {
                row.participant: row.row
                for each in book.students
                for row in (each, *each.again)
                if row.participant
            }
        lists = [each for each in (book, self.settings.roster) if each]
        numbers: dict[int, int] = {}
        sections: dict[str, list[int]] = {}
        for index, one in enumerate(submissions):
            sections.setdefault(one.person.section, []).append(index)
        for section, those in sections.items():
            people = [submissions[index].person for index in those]
            matched = [
                next(filter(None, (each.match(person) for each in lists)), None)
                for person in people
            ]
            counts = Counter(each for each in matched if each)
            entries = []
            for index, person, student in zip(those, people, matched, strict=True):
                numbered = person.ids.get("participant") or person.ids.get("user")
                shared = student and counts[student] > 1 and numbered
                entry = _entry(person, -1 - index)
                if student and shared and numbered not in (student.participant, student.canvas):
                    student = None  # two people of one name; the class list has one of them
                entries.append(student or entry)

            def clash(index: int, at: int, those: list[int] = those) -> bool:
                others = [submissions[each] for each, number in numbers.items() if number == at]
                return any(_differ(submissions[those[index]], other) for other in others)

            at = self._known.add(entries, section or "this download", clash=clash)
            for index, number in zip(those, at, strict=True):
                numbers[index] = number
        return [numbers[index] for index in range(len(submissions))]

    def _rows(self, submissions: list[Submission], number_of: list[int]) -> list[Row]:
        students = self.roster.students if self.roster else []
        parts: dict[int, list[Submission]] = {}
        for one, number in zip(submissions, number_of, strict=True):
            parts.setdefault(number, []).append(one)
        parts |= {number: [] for number in range(len(students)) if number not in parts}
        ids = {each.id.casefold() for each in self._known.people}
        rows = []
        for number, own in parts.items():
            about = self._known.people[number]
            student = students[number] if number < len(students) else None
            name = student.name if student else self._name(own[0])
            keys = self.policy.names(about, student.name if student else own[0].student)
            keys += sorted(about.names())
            bare = [
                each.partition(" ")[2] for one in own for each in _entry(one.person, 0).numbers()
            ]
            bare += [each.partition(" ")[2] for each in about.numbers()]
            keys += [each for each in bare if each not in ids]
            for pair in self.policy.answers.items():  # another email of the same person
                pair = [each.casefold() for each in pair]
                keys += pair if any(each in keys for each in pair) else []
            rows.append(Row(number, name, about, student, own, keys=list(dict.fromkeys(keys))))
        return rows

    def _name(self, one: Submission) -> str:
        """Return the name of a person who is on no list; people of one name get a number."""
        numbers = [one.person.ids[each] for each in _NUMBERS if one.person.ids.get(each)]
        is_shared = self._shown[one.person.section, one.student] > 1 and numbers
        return f"{one.student} ({numbers[0]})" if is_shared else one.student

    def _check_names(self) -> None:
        """Raise BotschoolErrors with what is wrong in the settings, and whom they cannot mean."""
        errors = list(self.policy.errors)
        counts = Counter(key for row in self.rows for key in row.keys)
        for name in self.policy.named:
            place = self.policy.places.get(name, "The class's settings:")
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

    def _join_groups(self) -> None:
        """Give each member what the others, or the group by its own name, handed in."""
        for group, members in self.policy.groups.items():
            rows = [row for row in self.rows if any(key in row.keys for key in members)]
            named = [
                row for row in self.rows
                if row.student is None and row not in rows and _is_of(row, group)
            ]  # fmt: skip
            self.rows = [row for row in self.rows if row not in named]
            for row in rows:
                others = [other for other in [*rows, *named] if other is not row]
                row.group += [
                    (f"Handed in by {other.name}, group {group}.", part)
                    for other in others
                    for part in other.parts
                ]

    def moment(self, part: Submission, number: Number) -> datetime | None:
        """Return when an exercise was handed in, if the platform or the files tell."""
        person, table = part.person, self.settings.gradebook or self.roster
        if not person.platform and self.policy.has_deadline(number):
            return self._told.get((id(part), number))
        line = self._sheet.get(person.ids.get("participant", ""))
        if person.submitted is None and line is not None and table:
            return moodle_moment(table.table.get(table.table.rows[line], "submitted"))
        return person.submitted

    def result(
        self,
        row: Row,
        number: Number,
        done: Mapping[tuple[int, Number], dict[str, Any]],
        nothing: Callable[[str, bool], dict[str, Any]],
    ) -> dict[str, Any]:
        """Return a person's best result of an exercise, with deadline and adjustments.

        done: results of (id of a submission, exercise). nothing: makes a result without points,
        from the reason and whether it counts as graded.
        """
        found = []
        for said, part in row.handed(number):
            choice = part.choices[number]
            if result := done.get((id(part), number)):
                notes = [*choice.notes, *([said] if said else [])]
                result = result | {"notes": notes, "file": choice.file}
                moment = self.moment(part, number)
                found.append(self.policy.apply(result, row.keys, moment, part.person.late))
        if not found:
            choices = [part.choices[number] for part in row.parts]
            missing = Choice(problem=MISSING, unread=not row.group)
            choice = choices[0] if choices else missing
            result = nothing(choice.problem, not choice.unread) | {"notes": choice.notes}
            return self.policy.apply(result, row.keys, None, False)
        best = max(found, key=lambda each: (each["graded"], each["points"]))
        if len(found) > 1:
            shown = [f"{part.person.section or part.student}" for _, part in row.handed(number)]
            note = f"Handed in {len(found)} times ({listed(shown)}): the better one counts."
            best = best | {"notes": [*best["notes"], note]}
        return best

    def finish(self, row: Row) -> None:
        """Compute a row's total."""
        weighed = [(r["exercise"], r["points"], r["max_points"]) for r in row.results]
        total, _, row.said = self.policy.total_of(weighed, row.keys)
        row.total = total if all(result["graded"] for result in row.results) else None

    def maximum(self, results: list[dict[str, Any]]) -> float:
        """Return the most that a total can be."""
        weighed = [(r["exercise"], r["points"], r["max_points"]) for r in results]
        return self.policy.total_of(weighed, [])[1]

    def book_rows(self) -> Iterator[tuple[Student, Row]]:
        """Yield each student of the gradebook with the row."""
        for row in self.rows:
            if student := self._of_book.get(row.number):
                yield student, row

    def without_effect(self, asked: list[Number], known: set[Number]) -> list[str]:
        """Return sentences on settings that cannot be applied.

        known: all exercises and laboratories.
        """
        said, policy = [], self.policy
        for number in [each for each in policy.places if isinstance(each, int) or each in known]:
            if number not in known:
                said.append(f"{policy.places[number]}: there is no {called(number).lower()}.")
        if policy.late and not (policy.due or policy.extensions):
            said.append(f"{policy.path}: 'late' has no effect without a deadline under 'due'.")
        for number in [each for each in asked if policy.has_deadline(each)]:
            parts = [(row, part) for row in self.rows for _, part in row.handed(number)]
            timeless = [
                row.name for row, part in parts
                if part.person.platform != "canvas"  # which marks those who are late
                and self.moment(part, number) is None
                and not any({0, number} & {*policy.submitted.get(key, ())} for key in row.keys)
            ]  # fmt: skip
            if not timeless:
                continue
            who = "anybody" if len(timeless) == len(parts) else listed(timeless)
            said.append(
                f"The deadline of {called(number).lower()} has no effect, because nothing tells "
                f"when {who} handed in: name Moodle's grading worksheet with --gradebook, or write "
                f"'submitted: times.csv' into {policy.path}."
            )
        return said


def _differ(one: Submission, other: Submission) -> bool:
    """Return whether two submissions hold different work on an exercise."""
    for number in one.files.keys() & other.files.keys():
        if one.choices[number].changed and other.choices[number].changed:
            try:
                if one.files[number].read_bytes() != other.files[number].read_bytes():
                    return True
            except OSError:
                return True
    return False


def _is_of(row: Row, group: str) -> bool:
    """Return whether a submission has the name of a group: Canvas's, or ASSIGNMENT-GROUP."""
    name = letters(group).replace(" ", "")
    shown = [name_of for part in row.parts for name_of in (part.student, part.person.folder)]
    return any(
        letters(each).replace(" ", "") == name or each.casefold().endswith(f"-{group.casefold()}")
        for each in shown
    )
