"""The people of a class, what they handed in, and their points."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import datetime
from functools import cached_property
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError, BotschoolErrors
from botschool.grading.classes.candidate import Choice
from botschool.grading.classes.download import Person
from botschool.grading.classes.files import File, listed
from botschool.grading.classes.join import Values, clean, folded, join
from botschool.grading.classes.roster import PEOPLE, Answers, Named, Student
from botschool.grading.classes.rules import Policy, tidy
from botschool.grading.classes.times import told_by
from botschool.grading.classes.wall import Broken, walled
from botschool.grading.declare.checks import plain
from botschool.grading.declare.exercise import Number, called

MISSING = "Nothing was handed in."
MOST_LINES = 20
"""People whom the command lists in lines of their own."""


@dataclass
class Row:
    """A person of the class: a row of its table."""

    student: Student
    parts: list[Person] = field(default_factory=list)
    """What the person handed in: one for each download."""
    group: list[tuple[Number, str, Person]] = field(default_factory=list)
    """What members of the person's group handed in: the exercise (0: all), who, and what."""
    page: str = ""
    """The name of the feedback page; "" for somebody who handed in nothing."""
    results: list[dict[str, Any]] = field(default_factory=list)
    total: float | None = None
    """The points of all exercises; None if one of them was not graded."""
    said: list[str] = field(default_factory=list)
    """Sentences on the term's total."""
    remarks: list[str] = field(default_factory=list)
    """Sentences for the instructor alone."""

    @property
    def name(self) -> str:
        return self.student.name

    @cached_property
    def keys(self) -> list[str]:
        """Return the words by which the settings may name the person."""
        texts = {text for part in self.parts for text in part.values.values()}
        own = {folded(text) for text in texts if any(c.isdigit() or c == "@" for c in text)}
        return sorted(self.student.words | own)

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
        nothing = all(part.is_empty for part in self.parts)
        return nothing and not any(map(self.handed, numbers))

    @property
    def notes(self) -> list[str]:
        return [note for part in self.parts for note in part.notes]


class Members:
    """The people of a class, from its list, the platform's table, and what they handed in."""

    def __init__(self, policy: Policy) -> None:
        """Start with the tables. Raises BotschoolErrors."""
        self.policy = policy
        self.rows: list[Row] = []
        self.notes: list[str] = []
        self.how: list[str] = []
        """Sentences on what was joined by which values."""
        self.doubts: list[tuple[str, str]] = []
        """People whom no table surely names: the name in the download, and why."""
        people, book = policy.people, policy.gradebook
        self.has_list = bool(people or book)
        self.students = list((people or book).students) if self.has_list else []
        self._answers = policy.answers or Answers(Path())
        self.notes += self._answers.notes
        if people and book and people is not book:
            self._add_book()

    def _add_book(self) -> None:
        """Join the platform's table to the class list."""
        book, file = self.policy.gradebook, self.policy.gradebook.table.path.name
        for student in self.students:
            student.rows = []
        there = [student.values for student in book.students]
        joined = join(*_shown(self.students), there, what="columns")
        self.how += [f"{file}: {joined.said}."] * bool(joined.said)
        for at, (own, row) in enumerate(zip(book.students, joined.rows, strict=True)):
            more = {f"{label} of {file}": text for label, text in own.values.items()}
            if row is None:
                own.listed = False
                own.values = more
                self.students.append(own)
                if at in joined.why:
                    self.notes.append(f"{file}: who is {plain(own.name)}? {joined.why[at]}.")
                continue
            known = self.students[row]
            known.values = known.values | more
            known.rows = own.rows

    def join(
        self,
        entries: Sequence[Values],
        names: Sequence[Collection[str]],
        where: str,
        loose: Sequence[bool] = (),
        what: str = "names",
        clash: Callable[[int, Student], bool] = lambda at, student: False,
    ) -> list[Student | None]:
        """Return the student of each entry, by PEOPLE and by equal values.

        names: of each entry, by which PEOPLE may name it. where: the download. clash(entry,
        student): whether both did what one person does once; then a name does not join them.
        """
        found: list[Student | None] = [self._answered(own) for own in names]
        left = [at for at, student in enumerate(found) if student is None]
        if not self.students or not left:
            return found
        own_loose = [loose[at] for at in left] if loose else ()
        joined = join(*_shown(self.students), [entries[at] for at in left], own_loose, what)
        if joined.said:
            self.how.append(f"{where or 'Submissions'}: {joined.said}.")
        for student in self.students:  # called as in the download, first or last name first
            shown = student.values.get(joined.label, "")
            if sorted(folded(shown).split()) == sorted(folded(student.name).split()):
                student.name = plain(clean(shown)) if "," not in shown else student.name
        why = {left[at]: reason for at, reason in joined.why.items()}
        for at, row in zip(left, joined.rows, strict=True):
            student = None if row is None else self.students[row]
            if student and clash(at, student) and not _share_a_number(student.values, entries[at]):
                why[at] = f"{plain(student.name)} handed in the same exercise, elsewhere"
                continue
            found[at] = student
        for at in left:
            if found[at] is None and (self.has_list or at in why):
                self.doubts.append((sorted(names[at], key=len)[-1], why.get(at, "")))
        return found

    def answer(self, names: Collection[str]) -> str:
        """Return the word for a student that PEOPLE has for an entry of these names; or ""."""
        own = dict.fromkeys(clean(each) for name in names for each in (name, plain(name)))
        return next((self._answers.of[name] for name in own if name in self._answers.of), "")

    def _answered(self, names: Collection[str]) -> Student | None:
        """Return whom PEOPLE names for an entry. Raises BotschoolError for an unknown person."""
        word = self.answer(names)
        student = Named(self.students).find(word) if word else None
        if word and student is None and self.has_list:
            raise BotschoolError(
                f"{self._answers.path} names {plain(word)}, who is nobody or several: write a "
                "value of the student's row that nobody else has."
            )
        return student

    @property
    def unknown(self) -> list[str]:
        """Return the names of people who are not on the class list, if there is one."""
        return [row.name for row in self.rows if self.has_list and not row.student.listed]

    @property
    def missing(self) -> list[Row]:
        return [row for row in self.rows if row.is_missing]

    def lacking(self) -> list[str]:
        """Return sentences on people who handed in nothing, or whom no table names."""
        nothing, strangers = listed([row.name for row in self.missing]), listed(self.unknown)
        said = [f"Nothing from: {nothing}."] if nothing else []
        said += [f"Not on the roster: {strangers}."] if strangers else []
        if self.doubts:
            said.append(
                f"Whose these are, write into {self._answers.path} (its head: identifier,folder):"
            )
            for name, why in self.doubts[:MOST_LINES]:
                reason = f"   ({why})" if why else ""
                said.append(f"  {self._answers.line(plain(name))}{reason}")
            more = len(self.doubts) - MOST_LINES
            said += [f"  and {more} more."] if more > 0 else []
        return said

    @property
    def maximum(self) -> float:
        """Return the most that a total can be."""
        raise NotImplementedError

    def average(self) -> str:
        """Return the words of the mean total; "" if nobody has a total."""
        totals = [row.total for row in self.rows if row.total is not None]
        mean = sum(totals) / len(totals) if totals else 0.0
        return f"{mean:.1f} of {self.maximum} points on average" if totals else ""

    def check_names(self, numbers: Collection[Number]) -> None:
        """Raise BotschoolErrors with what is wrong in the settings, and whom they cannot mean.

        numbers: the exercises whose rules matter.
        """
        errors, policy = list(self.policy.errors), self.policy
        counts = Counter(key for row in self.rows for key in row.keys)
        for name in policy.named(numbers, with_groups=self.has_list):
            place = policy.places.get(name, "The class's settings:")
            if counts[name] == 0:
                errors.append(
                    f"{place} names {name}, who is not in the class: write the id, email or name "
                    "as it stands in the class's table."
                )
            elif counts[name] > 1:
                errors.append(
                    f"{place} names {name}, which is the name of {counts[name]} students: write "
                    "a value that nobody else has."
                )
        if errors:
            raise BotschoolErrors(errors)


def _shown(students: Sequence[Student]) -> tuple[list[Values], list[str]]:
    return [student.values for student in students], [student.name for student in students]


def _share_a_number(one: Values, other: Values) -> bool:
    """Return whether two people share a value that is more than a name."""
    own, others = (
        {folded(text) for text in values.values() if re.search(r"[\d@]", text)}
        for values in (one, other)
    )
    return bool(own & others)


class Register(Members):
    """Match submissions with the people of the class.

    Each person has one row, whatever the number of downloads. People without a submission stand at
    the end.
    """

    def __init__(self, people: list[Person], policy: Policy) -> None:
        """Match them. Raises BotschoolErrors, with all that is wrong in the settings."""
        super().__init__(policy)
        self._told: dict[File, datetime | None] = {}
        rows: dict[int, Row] = {}
        for student, one in self._matched(people):
            rows.setdefault(id(student), Row(student)).parts.append(one)
        for student in self.students:
            if student.listed and id(student) not in rows:
                rows[id(student)] = Row(student)
        self.rows = list(rows.values())
        self._distinguish()
        self._tell_times()
        self.check_names(people[0].choices if people else ())
        self._join_groups()

    def _matched(self, people: list[Person]) -> list[tuple[Student, Person]]:
        """Return each entry with its student, a new one for whom no table names."""
        found = []
        for section in dict.fromkeys(one.section for one in people):
            own = [one for one in people if one.section == section]
            names = [{one.key, one.student, *one.names} for one in own]
            done = {id(s): part for s, part in found if not s.listed}

            def clash(at: int, student: Student, own: Any = own, done: Any = done) -> bool:
                other = done.get(id(student))
                return bool(other and own[at].files.keys() & other.files.keys())

            values, loose = [one.values for one in own], [one.loose for one in own]
            students = self.join(values, names, section, loose, clash=clash)
            shown = Counter(one.student for one in own)
            new = []
            for at, (one, student) in enumerate(zip(own, students, strict=True)):
                if student is None:
                    name = one.key if shown[one.student] > 1 else one.student
                    values = one.values | {"the name": one.student, PEOPLE: self.answer(names[at])}
                    student = Student(plain(name), values, listed=False)
                    new.append(student)
                found.append((student, one))
            self.students += new
        return found

    def _distinguish(self) -> None:
        """Give those who are on no list, and have another's name, a name of their own."""
        counts = Counter(folded(row.name) for row in self.rows)
        for row in self.rows:
            if counts[folded(row.name)] > 1 and row.parts and not row.student.listed:
                row.student.name = plain(f"{row.name} ({row.parts[0].key})")

    def _tell_times(self) -> None:
        """Take times, extensions and groups from Moodle's worksheet, for its own assignment."""
        book = self.policy.gradebook or self.policy.people
        if book is None or book.kind != "moodle":
            return
        of_rows = {id(student): student.rows for student in self.students}
        for row in self.rows:
            lines = of_rows.get(id(row.student), [])
            for part in row.parts:
                parts = {folded(text) for text in part.values.values()}
                for line in [at for at in lines if book.number(at) in parts]:
                    part.submitted = part.submitted or book.times.get(line)
                    part.extended = book.extensions.get(line)
        if not self.policy.groups:
            self._tell_groups(book, of_rows)
        self.notes += [note for note in book.notes if note not in self.notes]

    def _tell_groups(self, book: Any, of_rows: Mapping[int, list[int]]) -> None:
        """Read the groups in the column whose cells begin the names of folders ("Team A-Ada")."""
        for column in book.columns[1:]:
            head, members, fits = book.heads[column], defaultdict(list), []
            for row in self.rows:
                team = row.student.cells.get(head, "") if of_rows.get(id(row.student)) else ""
                if team:
                    members[team].append(row)
                    fits += [one.key.startswith(f"{team}-") for one in row.parts]
            if fits and all(fits):
                for team, rows in members.items():
                    self._share(team, 0, rows, [])

    def _join_groups(self) -> None:
        """Give each member what the others, or the group by its own name, handed in."""
        for (group, number), members in self.policy.groups.items():
            rows = [row for row in self.rows if any(key in row.keys for key in members)]
            named = [
                row for row in self.rows
                if not row.student.listed and row not in rows and _is_of(row, group)
            ]  # fmt: skip
            self.rows = [row for row in self.rows if row not in named]
            names = {name for row in named for part in row.parts for name in part.names}
            self.doubts = [doubt for doubt in self.doubts if doubt[0] not in names]
            self._share(group, number, rows, named)

    def _share(self, group: str, number: Number, rows: list[Row], named: list[Row]) -> None:
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
            own = part if part in row.parts or not row.parts else row.parts[0]
            found.append(self.policy.apply(result, row.keys, moment, part.late, own.extended))
        if not found:
            choices = [part.choices[number] for part in row.parts if not part.is_empty]
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
            row.total = tidy(self._sums(row)[0])

    @property
    def maximum(self) -> float:
        return tidy(self._sums(self.rows[0])[1])

    def _sums(self, row: Row) -> tuple[float, float]:
        """Return points and maximum: an exercise's own ones if it is alone, else weighted sums."""
        if len(row.results) == 1:
            return row.results[0]["points"], row.results[0]["max_points"]
        return self.policy.weighed(row.results)

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


def _is_of(row: Row, group: str) -> bool:
    """Return whether a submission has the name of a group as a part of its own."""
    names = {folded(group), folded(group).replace(" ", "")}
    return any(folded(text) in names for part in row.parts for text in part.values.values())
