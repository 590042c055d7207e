"""Read class lists, recognise people in tables and downloads, and ask who doubtful ones are.

docs/specification.md, "A term".
"""

from __future__ import annotations

import re
import unicodedata
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.classes.export import Person
from botschool.grading.classes.tables import Table, made_table, read_table
from botschool.grading.declare.checks import plain
from botschool.output import save_bytes

PEOPLE = "people.csv"
"""The table of doubtful people, in the class's folder."""
NEW = "new"
"""The answer for a person who is nobody else."""
_HEAD = ["person", "name", "where", "student", "may be"]
_KEYS, _NUMBERS = ("id", "mail", "user"), ("participant", "canvas")


def letters(text: str) -> str:
    """Return the letters and digits of a text in lower case, without accents."""
    plain_text = unicodedata.normalize("NFKD", text.casefold())
    plain_text = "".join(each for each in plain_text if not unicodedata.combining(each))
    return " ".join(re.findall(r"[^\W_]+", plain_text))


def words(name: str) -> str:
    """Return the words of a name in a fixed order."""
    return " ".join(sorted(letters(name).split()))


@dataclass(frozen=True)
class Student:
    """A person of the class, as a table names him."""

    name: str
    id: str = ""
    mail: str = ""
    user: str = ""
    participant: str = ""
    """Moodle's number, another one in each assignment."""
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

    @property
    def key(self) -> str:
        """Return the shortest word that names this student in tables that people edit."""
        return self.id or self.mail or self.user or next(iter(self.numbers()), self.name)

    def numbers(self) -> list[str]:
        """Return the platforms' numbers, in words that name only this student."""
        given = (("moodle", self.participant), ("canvas", self.canvas))
        own = [f"{platform} {number}" for platform, number in given if number]
        return [*own, *(each for row in self.again for each in row.numbers())]

    def keys(self) -> set[str]:
        """Return the words that name only this student, in lower case."""
        given = (self.id, self.mail, self.user, self.mail.partition("@")[0])
        own = {key.casefold() for key in given if key}.union(self.numbers())
        return own.union(*(each.keys() for each in self.again))

    def called(self) -> list[str]:
        """Return all words by which tables may name this student, keys first."""
        shown = {each.name.casefold() for each in (self, *self.again)}
        return list(dict.fromkeys([*sorted(self.keys()), *sorted(self.names() | shown)]))

    def names(self) -> set[str]:
        """Return the words of the name, as each row has it."""
        return {words(each.name) for each in (self, *self.again)}

    def turned(self) -> list[str]:
        """Return the words of the name in one, from each of them on: lastnamefirst."""
        parts = letters(self.name.replace(",", " ")).split()
        return ["".join(parts[at:] + parts[:at]) for at in range(len(parts))]

    def differs(self, other: Student) -> bool:
        """Return whether the ids of two students of one name say that they are two people."""
        both = [(getattr(self, key), getattr(other, key)) for key in ("id", "canvas")]
        return any(a and b and a.casefold() != b.casefold() for a, b in both)

    def is_alike(self, other: Student) -> bool:
        """Return whether two names may be of one student."""
        mine, others = set(words(self.name).split()), set(words(other.name).split())
        return mine <= others or others <= mine or not (self.is_named and other.is_named)


@dataclass
class Doubt:
    """A person who may be one of several, or is taken for one of another email."""

    person: Student
    where: str
    candidates: list[Student]
    taken: str = ""
    """The key of the student whom he is taken for until somebody says otherwise."""


@dataclass
class Known:
    """The people of a class, each once, with all that tables and downloads say of them."""

    settled: Mapping[str, str] = field(default_factory=dict)
    """What the instructor has answered: Student.key -> a student's key or name, or NEW."""
    people: list[Student] = field(default_factory=list)
    doubts: list[Doubt] = field(default_factory=list)
    _places: dict[tuple, list[int]] = field(default_factory=dict)
    _rows: dict[Student, int] = field(default_factory=dict)

    def add(
        self,
        rows: Sequence[Student],
        where: str = "",
        equal: Sequence[tuple] = (),
        clash: Callable[[int, int], bool] = lambda index, at: False,
    ) -> list[int]:
        """Return the number of each row's person; new people get the next ones.

        A number of a platform, an id, an email or a user name decides, then a name that only one
        person has, here and in earlier tables. where: the table or download, for questions.
        equal: a key of each row, which equal rows share. clash(index, number): whether a row and a
        person of its name did what only two people do.
        """
        before, found = len(self.people), dict[int, int]()
        for index, row in enumerate(rows):
            keys = [*_keys(row), *(("row", *each) for each in equal[index : index + 1])]
            at = self._rows.get(row, self._answered(row))
            at = self._same(row, keys, before) if at is None else at
            if at is not None or not before:
                found[index] = self._enter(row, at, keys)
        left = [index for index in range(len(rows)) if index not in found]
        counts = Counter(words(rows[index].name) for index in left)
        free = [at for at in range(before) if at not in found.values()]
        for index in left:
            row = rows[index]
            alone = [at for at in free if counts[words(row.name)] == 1 and not clash(index, at)]
            at = self._by_name(row, free, alone, where)
            found[index] = self._enter(row, at, _keys(row))
        return [found[index] for index in range(len(rows))]

    def learn(self, number: int, row: Student) -> None:
        """Add what a table or a download says of a known person."""
        self._enter(row, number, _keys(row))

    def find(self, text: str) -> int | None:
        """Return the number of the only person with this id, mail, user name, number or name."""
        for place in (("word", text.strip().casefold()), ("name", words(text))):
            found = self._places.get(place, ())
            if place[1] and len(found) == 1:
                return found[0]
        return None

    def _answered(self, row: Student) -> int | None:
        """Return who a row is as the table says, which may name either of two first."""
        mine = {key.casefold() for key in questions(row)}
        pairs = [pair for pair in self.settled.items() if NEW not in pair and mine & {*pair}]
        found = (self.find(each) for pair in pairs for each in pair if each not in mine)
        return next((at for at in found if at is not None), None)

    def _same(self, row: Student, keys: list[tuple], before: int) -> int | None:
        """Return the person who shares a key with a row.

        Tables put the same dash into many cells, so a key needs a name that fits; an email that
        only one person of earlier tables has needs none.
        """
        for key in keys:
            there = self._places.get(key, [])
            for at in there:
                known = self.people[at]
                alone = key[0] == "mail" and "@" in key[1] and len(there) == 1 and at < before
                fits = alone or any(row.is_alike(each) for each in (known, *known.again))
                if key[0] not in _KEYS or (fits and not (alone and row.differs(known))):
                    return at
        return None

    def _by_name(self, row: Student, free: list[int], alone: list[int], where: str) -> int | None:
        """Return the person of this name, and note what is doubtful.

        free: people whom no other row names. alone: those whom the name may stand for.
        """
        if any(self.settled.get(key.casefold()) == NEW for key in questions(row)):
            return None
        others = [at for at in free if not row.differs(self.people[at])]
        equal = [at for at in others if words(row.name) in self.people[at].names()]
        if len(equal) == 1 and equal[0] in alone:
            known = self.people[equal[0]]
            if row.mail and known.mail and row.mail.casefold() not in set(known.keys()):
                self.doubts.append(Doubt(row, where, [known], known.key))
            return equal[0]
        named = [at for at in others if row.is_named and self.people[at].is_named]
        alike = [at for at in named if words(row.name) and row.is_alike(self.people[at])]
        same_id = [at for key in _keys(row) for at in self._places.get(key, []) if at in free]
        if near := list(dict.fromkeys([*equal, *alike, *same_id])):
            self.doubts.append(Doubt(row, where, [self.people[at] for at in near]))
        return None

    def _enter(self, row: Student, at: int | None, keys: list[tuple]) -> int:
        if at is None:
            at = len(self.people)
            self.people.append(row)
        elif row != self.people[at] and row not in self.people[at].again:
            known = self.people[at]
            filled = {key: getattr(known, key) or getattr(row, key) for key in (*_KEYS, *_NUMBERS)}
            name = known.name if known.is_named or not row.is_named else row.name
            self.people[at] = replace(known, name=name, again=(*known.again, row), **filled)
        self._rows[row] = at
        words_of = {"word": row.keys(), "name": row.names()}
        for key in [*keys, *((kind, each) for kind in words_of for each in words_of[kind])]:
            places = self._places.setdefault(key, [])
            places += [at] * (at not in places)
        return at


def _keys(row: Student) -> list[tuple]:
    """Return what identifies a row: (field, value), the platforms' numbers first."""
    rows, kinds = (row, *row.again), (*_NUMBERS, *_KEYS)
    given = [(key, getattr(each, key).casefold()) for key in kinds for each in rows]
    return list(dict.fromkeys((key, value) for key, value in given if value))


def questions(row: Student) -> list[str]:
    """Return the words under which PEOPLE may name a person, the best one first."""
    return [*filter(None, (row.mail, row.id, row.user)), *row.numbers()] or [row.name]


def read_answers(folder: Path) -> dict[str, str]:
    """Return what the instructor wrote into PEOPLE: person -> student. Raises BotschoolError."""
    path = folder / PEOPLE
    if not path.is_file():
        return {}
    table = read_table(path)
    if missing := [name for name in _HEAD[:4] if table.column(name) is None]:
        raise BotschoolError(f"{path} has no column '{missing[0]}': put it back.")
    names = ("person", "student")
    pairs = [[table.get(row, n).lstrip("'").casefold() for n in names] for row in table.rows]
    return {person: student for person, student in pairs if person and student}


def ask(folder: Path, doubts: Sequence[Doubt]) -> list[str]:
    """Add people to the class's table of doubtful ones; return sentences for the instructor.

    What stands in the table stays. Raises BotschoolError.
    """
    if not doubts:
        return []
    path, answers, rows = folder / PEOPLE, read_answers(folder), []
    if path.is_file():
        table = read_table(path)
        columns = [*_HEAD[:4], "maybe"]
        rows = [[table.get(row, name) for name in columns] for row in table.rows]
    there = {row[0].lstrip("'").casefold() for row in rows}
    taken, open_ = [], []
    for doubt in doubts:
        key, name = questions(doubt.person)[0], plain(doubt.person.name)
        answer = answers.get(key.casefold())
        unknown = f": nobody is called {plain(answer)}" if answer else ""
        (taken if doubt.taken else open_).append(f"{name} ({key}{unknown})")
        if key.casefold() not in there:
            there.add(key.casefold())
            may_be = "; ".join(_shown(each) for each in doubt.candidates)
            cells = [key, doubt.person.name, doubt.where, doubt.taken, may_be]
            rows.append(cells)
    folder.mkdir(parents=True, exist_ok=True)
    save_bytes(path, made_table([_HEAD, *rows]))
    said = []
    if taken:
        said.append(
            f"Another email than before, but the same name: {', '.join(taken)}. Each counts as one "
            f"person; if that is wrong, correct the column 'student' of {path}."
        )
    if open_:
        said.append(
            f"Doubtful: {', '.join(open_)}. Each has a row of its own until you write who it is "
            f"into the column 'student' of {path} (an id, an email, or '{NEW}'), and repeat this."
        )
    return said


def _shown(student: Student) -> str:
    keys = [key for key in (student.key, student.mail) if key != student.name]
    return " ".join([student.name, *(f"({key})" for key in dict.fromkeys(keys) if key)])


@dataclass
class Roster:
    """The students of a class, from a table of any platform."""

    table: Table
    kind: str
    """moodle (a grading worksheet), canvas (a gradebook) or plain."""
    known: Known
    notes: list[str] = field(default_factory=list)
    """Sentences on students who stand there more than once."""

    @property
    def students(self) -> list[Student]:
        return self.known.people

    def find(self, name: str) -> Student | None:
        """Return the only student whom a word names; None if there is none, or more than one."""
        at = self.known.find(name)
        return None if at is None else self.students[at]

    def match(self, person: Person) -> Student | None:
        """Return the student who handed this in; None if there is none or more than one."""
        ids, platform = person.ids, person.platform
        number = ids.get("participant") or ids.get("user")
        names = [f"{platform} {number}"] if number else []
        names += [ids.get("email", ""), ids.get("sid", ""), person.student]
        if platform in ("", "moodle"):
            # ASSIGNMENT-USER or GROUP-NAME; the longest user name wins, as it may hold hyphens
            whole = person.student if platform else person.folder
            parts = re.sub(r"-(main|master)$", "", whole).split("-")
            names += [whole, *("-".join(parts[at:]) for at in range(1, len(parts)))]
        if found := next(filter(None, map(self.find, names)), None):
            return found
        fitting = set[Student]()
        if not platform:  # NAME - FILE, TITLE_USER_attempt_TIME_FILE
            pieces = re.split(r"\s+-\s+|_", person.folder)
            fitting = {*filter(None, map(self.find, pieces))}
        if platform == "canvas":  # lastnamefirst
            squashed = letters(person.student).replace(" ", "")
            fitting = {each for each in self.students if squashed in each.turned()}
        return fitting.pop() if len(fitting) == 1 else None


def read_roster(path: Path) -> Roster:
    """Return the class of a CSV file. Raises BotschoolError."""
    table = read_table(path)
    get, points_row, kind = table.get, 0, "plain"
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
    return Roster(table, kind, known, notes)
