"""Match submissions with the people of the class, and compute each person's points."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Mapping
from datetime import datetime
from typing import Any

from botschool.grading.classes.choice import Choice
from botschool.grading.classes.files import File, listed
from botschool.grading.classes.finding import Submission
from botschool.grading.classes.identity import Student, letters
from botschool.grading.classes.members import Members, Row, Settings
from botschool.grading.classes.people import Person
from botschool.grading.classes.policy import moodle_moment
from botschool.grading.classes.rules import tidy
from botschool.grading.classes.times import told_by
from botschool.grading.classes.wall import Broken, walled
from botschool.grading.declare.exercise import Number, called

_NUMBERS = ("participant", "user", "sid", "submission")
"""Ids that distinguish people of one name."""
MISSING = "Nothing was handed in."


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


class Register(Members):
    """Match submissions with the people of the class.

    Each person has one row, whatever the number of downloads. People without a submission stand at
    the end.
    """

    def __init__(self, submissions: list[Submission], settings: Settings) -> None:
        """Match them. Raises BotschoolErrors, with all that is wrong in the settings."""
        super().__init__(settings)
        self._enter(submissions, self._number(submissions))
        self.check_names(submissions[0].choices if submissions else ())
        self._join_groups()
        self._told = {
            (id(part), number): _told(choice.origin)
            for part in submissions
            for number, choice in part.choices.items()
            if choice.origin and not part.person.platform and self.policy.has_deadline(number)
        }
        self.ask()

    def _number(self, submissions: list[Submission]) -> list[int]:
        """Return the number of each submission's person among the known ones."""
        book = self.settings.gradebook
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
                return any(_both_did(submissions[those[index]], other) for other in others)

            at = self._known.add(entries, section or "this download", clash=clash)
            for index, number in zip(those, at, strict=True):
                numbers[index] = number
                self._known.learn(number, _entry(submissions[index].person, -1 - index))
        return [numbers[index] for index in range(len(submissions))]

    def _enter(self, submissions: list[Submission], number_of: list[int]) -> None:
        """Make a row for each person; those of the class list who handed in nothing come last."""
        parts: dict[int, list[Submission]] = {}
        for one, number in zip(submissions, number_of, strict=True):
            parts.setdefault(number, []).append(one)
        students = range(len(self.roster.students) if self.roster else 0)
        parts |= {number: [] for number in students if number not in parts}
        shown = Counter(own[0].student for own in parts.values() if own)
        for number, own in parts.items():
            row = self.row(number, _name(own[0], shown) if own else "")
            row.parts = own
            self.rows.append(row)

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
            missing = Choice(problem=MISSING, unread=row.is_missing)
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
        if all(result["graded"] for result in row.results):
            row.total = tidy(self.policy.weighed(row.results)[0])

    def maximum(self) -> float:
        """Return the most that a total can be."""
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


def _name(one: Submission, shown: Counter) -> str:
    """Return the name of a person who is on no list; people of one name get a number."""
    numbers = [one.person.ids[each] for each in _NUMBERS if one.person.ids.get(each)]
    return f"{one.student} ({numbers[0]})" if shown[one.student] > 1 and numbers else one.student


def _both_did(one: Submission, other: Submission) -> bool:
    """Return whether two submissions hold work on the same exercise."""
    common = one.files.keys() & other.files.keys()
    return any(one.choices[each].changed and other.choices[each].changed for each in common)


def _is_of(row: Row, group: str) -> bool:
    """Return whether a submission has the name of a group: Canvas's, or ASSIGNMENT-GROUP."""
    name = letters(group).replace(" ", "")
    shown = [name_of for part in row.parts for name_of in (part.student, part.person.folder)]
    return any(
        letters(each).replace(" ", "") == name or each.casefold().endswith(f"-{group.casefold()}")
        for each in shown
    )
