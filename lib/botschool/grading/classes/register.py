"""The people of a class, what they handed in, and their points."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolErrors
from botschool.grading.classes.candidate import Choice
from botschool.grading.classes.export import Person
from botschool.grading.classes.files import File, listed
from botschool.grading.classes.identity import Known, Student, ask, letters
from botschool.grading.classes.layouts import told_by
from botschool.grading.classes.policy import moodle_moment
from botschool.grading.classes.rules import Policy, tidy
from botschool.grading.classes.wall import Broken, walled
from botschool.grading.declare.exercise import Number, called

_NUMBERS = ("participant", "user", "sid", "submission")
"""Ids that distinguish people of one name."""
MISSING = "Nothing was handed in."


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
    parts: list[Person] = field(default_factory=list)
    """What the person handed in: one for each download."""
    group: list[tuple[Number, str, Person]] = field(default_factory=list)
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

    def handed(self, number: Number) -> list[tuple[str, Person]]:
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


class Members:
    """The people of a class, from its list, the platform's table, and what they handed in."""

    def __init__(self, policy: Policy) -> None:
        """Start with the tables."""
        self.policy = policy
        self.roster = policy.people or policy.gradebook
        self.rows: list[Row] = []
        self.notes: list[str] = []
        self._known = Known(self.policy.answers)
        self._of_book: dict[int, Student] = {}
        self._sheet: dict[str, int] = {}
        """Moodle's number -> row of the worksheet."""
        if self.roster:
            self._known.add(self.roster.students, "the class list")
        self._book = policy.gradebook or self.roster
        if book := self._book:
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

    @property
    def maximum(self) -> float:
        """Return the most that a total can be."""
        raise NotImplementedError

    def average(self) -> str:
        """Return the words of the mean total; "" if nobody has a total."""
        totals = [row.total for row in self.rows if row.total is not None]
        mean = sum(totals) / len(totals) if totals else 0.0
        return f"{mean:.1f} of {self.maximum} points on average" if totals else ""

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


def _entry(person: Person, row: int) -> Student:
    """Return what a download says of a person."""
    ids = person.ids
    canvas = ids.get("user", "") if person.platform == "canvas" else ""
    mail, participant = ids.get("email", ""), ids.get("participant", "")
    return Student(person.student, ids.get("sid", ""), mail, "", participant, canvas, row)


class Register(Members):
    """Match submissions with the people of the class.

    Each person has one row, whatever the number of downloads. People without a submission stand at
    the end.
    """

    def __init__(self, people: list[Person], policy: Policy) -> None:
        """Match them. Raises BotschoolErrors, with all that is wrong in the settings."""
        super().__init__(policy)
        self._told: dict[File, datetime | None] = {}
        found = self._numbered(people)
        students = range(len(self.roster.students) if self.roster else 0)
        shown = Counter(own[0].student for own in found.values())
        for number in dict.fromkeys([*found, *students]):
            parts = found.get(number, [])
            row = self.row(number, _name(parts[0], shown) if parts else "")
            row.parts = parts
            self.rows.append(row)
        self.check_names(people[0].choices if people else ())
        self._join_groups()
        self.ask()

    def _numbered(self, people: list[Person]) -> dict[int, list[Person]]:
        """Return what each known person has handed in, by the person's number."""
        lists = [each for each in (self.policy.gradebook, self.policy.people) if each]
        found, rows = dict[int, list[Person]](), iter(range(-1, -1 - len(people), -1))
        for section in dict.fromkeys(one.section for one in people):
            own = [one for one in people if one.section == section]
            entries = [_entry(one, next(rows)) for one in own]
            matched = [next(filter(None, (list.match(one) for list in lists)), None) for one in own]
            counts = Counter(matched)
            taken = []
            for one, entry, student in zip(own, entries, matched, strict=True):
                number = one.ids.get("participant") or one.ids.get("user")
                shared = student and counts[student] > 1 and number
                # of two people of one name the class list has one
                other = shared and number not in (student.participant, student.canvas)
                taken.append(entry if other or not student else student)

            def clash(index: int, at: int, own: list[Person] = own) -> bool:
                return any(_both_did(own[index], other) for other in found.get(at, ()))

            numbers = self._known.add(taken, section or "this download", clash=clash)
            for one, entry, at in zip(own, entries, numbers, strict=True):
                found.setdefault(at, []).append(one)
                self._known.learn(at, entry)
        return found

    def _join_groups(self) -> None:
        """Give each member what the others, or the group by its own name, handed in."""
        for (group, number), members in self.policy.groups.items():
            rows = [row for row in self.rows if any(key in row.keys for key in members)]
            named = [
                row for row in self.rows
                if row.student is None and row not in rows and _is_of(row, group)
            ]  # fmt: skip
            self.rows = [row for row in self.rows if row not in named]
            for row in rows:
                others = [other for other in [*rows, *named] if other is not row]
                row.group += [
                    (number, f"Handed in by {other.name}, group {group}.", part)
                    for other in others
                    for part in other.parts
                ]

    def moment(self, person: Person, number: Number) -> datetime | None:
        """Return when an exercise was handed in, if the platform or the files tell."""
        if not person.platform and self.policy.has_deadline(number):
            file = person.choices[number].origin
            if file and file not in self._told:
                self._told[file] = None
                with suppress(Broken):
                    self._told[file] = walled(told_by, file)
            return self._told.get(file)
        line, book = self._sheet.get(person.ids.get("participant", "")), self._book
        if person.submitted is None and line is not None and book:
            return moodle_moment(book.table.get(book.table.rows[line], "submitted"))
        return person.submitted

    def result(
        self,
        row: Row,
        number: Number,
        done: Mapping[tuple[Number, Path], dict[str, Any]],
        nothing: Callable[[str, bool], dict[str, Any]],
    ) -> dict[str, Any]:
        """Return a person's best result of an exercise, with deadline and adjustments.

        done: results of (exercise, file). nothing: makes a result without points,
        from the reason and whether it counts as graded.
        """
        found, handed = [], row.handed(number)
        for said, part in handed:
            choice = part.choices[number]
            notes = [*choice.notes, *filter(None, [said])]
            result = done[number, choice.file] | {"notes": notes, "file": choice.file}
            moment = self.moment(part, number)
            found.append(self.policy.apply(result, row.keys, moment, part.late))
        if not found:
            choices = [part.choices[number] for part in row.parts]
            choice = next(iter(choices), Choice(problem=MISSING, unread=row.is_missing))
            result = nothing(choice.problem, not choice.unread) | {"notes": choice.notes}
            return self.policy.apply(result, row.keys, None, False)
        best = max(found, key=lambda each: (each["graded"], each["points"]))
        if len(found) > 1:
            shown = listed([part.section or part.student for _, part in handed])
            note = f"Handed in {len(found)} times ({shown}): the better one counts."
            best = best | {"notes": [*best["notes"], note]}
        return best

    def finish(self, row: Row) -> None:
        """Compute a row's total."""
        if all(result["graded"] for result in row.results):
            row.total = tidy(self.policy.weighed(row.results)[0])

    @property
    def maximum(self) -> float:
        return tidy(self.policy.weighed(self.rows[0].results)[1])

    def without_effect(self, asked: list[Number], known: Collection[Number]) -> list[str]:
        """Return sentences on settings that cannot be applied.

        known: all exercises and laboratories, () if unknown.
        """
        said, policy = [], self.policy
        for number in {*policy.due, *policy.weights} - {*known} if known else ():
            said.append(f"{policy.places[number]}: there is no {called(number).lower()}.")
        if policy.late and not (policy.due or policy.extensions):
            said.append(f"{policy.path}: 'late' has no effect without a deadline under 'due'.")
        for number in [each for each in asked if policy.has_deadline(each)]:
            parts = [(row, part) for row in self.rows for _, part in row.handed(number)]
            timeless = [
                row.name for row, part in parts
                if part.platform != "canvas"  # which marks those who are late
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


def _name(one: Person, shown: Counter) -> str:
    """Return the name of a person who is on no list; people of one name get a number."""
    numbers = [one.ids[each] for each in _NUMBERS if one.ids.get(each)]
    return f"{one.student} ({numbers[0]})" if shown[one.student] > 1 and numbers else one.student


def _both_did(one: Person, other: Person) -> bool:
    """Return whether two submissions hold work on the same exercise."""
    common = one.files.keys() & other.files.keys()
    return any(one.choices[each].changed and other.choices[each].changed for each in common)


def _is_of(row: Row, group: str) -> bool:
    """Return whether a submission has the name of a group: Canvas's, or ASSIGNMENT-GROUP."""
    name = letters(group).replace(" ", "")
    shown = [name_of for part in row.parts for name_of in (part.student, part.folder)]
    return any(
        letters(each).replace(" ", "") == name or each.casefold().endswith(f"-{group.casefold()}")
        for each in shown
    )
