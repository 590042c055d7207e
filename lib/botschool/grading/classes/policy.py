"""Read class.yaml, and the tables that it names, with all errors at once.

docs/specification.md, "A class".
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import Any, TypeVar

from botschool.errors import BotschoolError, BotschoolErrors
from botschool.grading.classes.join import folded
from botschool.grading.classes.rules import MOST_POINTS, TOTAL, Adjustment, LateRule, Policy
from botschool.grading.classes.tables import Table, number_in, read_table
from botschool.grading.classes.texts import is_larger
from botschool.grading.classes.times import read_moment
from botschool.grading.declare.exercise import Number
from botschool.grading.judge.submission import EVERYTHING

_LATE = re.compile(
    r"(?P<off>\d+(?:\.\d+)?)\s*(?:points?\s*)?(?:/|per)\s*(?:started\s*)?(?P<unit>day|hour|week)"
    r"(?:\s*,?\s*(?:at most|up to)\s*(?P<most>\d+(?:\.\d+)?))?",
    re.IGNORECASE,
)
FILE = "class.yaml"
MOST_VALUES = 100_000
_WHO = ("id", "email", "username", "student", "name")
"""Heads of the columns that name a student in the tables of class.yaml; the first one counts."""
T = TypeVar("T")
_KEYS = (
    "roster", "due", "late", "extensions", "adjustments", "submitted", "groups", "weights", "total",
    "bonus", "syntax", "tasks",
)  # fmt: skip


def read_policy(path: Path, collect: bool = False) -> Policy:
    """Return the settings of a class.yaml and of the tables that it names.

    All values are texts as they are written: 00144 is no octal number, and "no" a user's name.
    Raises BotschoolErrors, which names all places; collect: only if nothing can be read, and leave
    the others to Policy.errors.
    """
    import yaml

    class Loader(yaml.BaseLoader):
        """Read mappings with the line of each key."""

    Loader.add_constructor("tag:yaml.org,2002:map", lambda loader, node: _Lined(loader, node))
    try:
        text = path.read_text(encoding="utf-8-sig")
        found = yaml.load(text, Loader)
    except (OSError, UnicodeError) as error:
        raise BotschoolError(f"{path} cannot be read ({error}).") from None
    except (yaml.YAMLError, ValueError, TypeError, RecursionError) as error:
        mark = getattr(error, "problem_mark", None)
        where = f", line {mark.line + 1}" if mark else ""
        raise BotschoolError(f"{path}{where} is not valid YAML: correct it.") from None
    if is_larger(found, MOST_VALUES):
        raise BotschoolError(f"{path} holds too many values: does an alias (*) repeat them?")
    found = found or _Lined()
    if not isinstance(found, _Lined):
        raise BotschoolError(f"{path} holds no settings: write lines as 'late: 10 per day'.")
    policy = _Reader(path).read(found)
    if policy.errors and not collect:
        raise BotschoolErrors(policy.errors)
    return policy


def add_table(policy: Policy, path: Path) -> None:
    """Add the adjustments of a table that class.yaml need not name, if there is one."""
    if path.is_file() and path.resolve() not in [table.resolve() for table in policy.tables]:
        reader = _Reader(path, policy)
        for key, own in reader.adjustments(path.name).items():
            policy.adjustments.setdefault(key, []).extend(own)


class _Lined(dict):
    """A mapping of a YAML file that knows the line of each key."""

    def __init__(self, loader: Any = None, node: Any = None) -> None:
        super().__init__(loader.construct_mapping(node, deep=True) if loader else {})
        self.lines: dict[Any, int] = {}
        self.twice: list[Any] = []
        for key, _ in node.value if node else ():
            name = loader.construct_object(key, deep=True)
            self.twice += [name] * (name in self.lines)
            self.lines[name] = key.start_mark.line + 1


class _Reader:
    """Read the settings one by one, and collect what is wrong with them."""

    def __init__(self, path: Path, policy: Policy | None = None) -> None:
        self._path = path
        self._policy = policy or Policy(path=path)

    def read(self, found: _Lined) -> Policy:
        for key, value in self._items(found, "settings, such as 'late: 10 per day'"):
            if key not in _KEYS:
                raise_ = f"'{key}' is not a setting: choose from {', '.join(_KEYS)}."
                self._policy.errors.append(f"{self._place(found, key)}: {raise_}")
                continue
            with self._at(self._place(found, key)):
                setattr(self._policy, key, getattr(self, key)(value))
        return self._policy

    def _place(self, found: _Lined, key: Any) -> str:
        return f"{self._path}, line {found.lines[key]}"

    @contextmanager
    def _at(self, place: str) -> Iterator[None]:
        """Keep what is wrong within, with its place."""
        try:
            yield
        except BotschoolError as error:
            self._policy.errors.append(f"{place}: {error}" if place else str(error))

    def _items(self, value: Any, what: str) -> Iterator[tuple[Any, Any]]:
        """Yield what a setting lists. Raises BotschoolError."""
        if not isinstance(value, _Lined):
            raise BotschoolError(f"write {what}.")
        for key in dict.fromkeys(value.twice):
            self._policy.errors.append(
                f"{self._place(value, key)}: '{key}' stands there twice: keep one of them."
            )
        yield from value.items()

    def _numbered(self, value: Any, what: str, read: Callable[[Any], T]) -> dict[Number, T]:
        """Return a value for each exercise."""
        found = {}
        for key, each in self._items(value, what):
            with self._at(self._place(value, key)):
                number = _number(key)
                found[number] = read(each)
                self._policy.places.setdefault(number, self._place(value, key))
        return found

    def _table(self, value: Any, key: str) -> Iterator[tuple[Table, list[str], str]]:
        """Yield a table's rows and their places; what is wrong in one of them costs this one."""
        if not isinstance(value, str) or not value:
            raise BotschoolError(f"'{key}' is not a file name.")
        table = read_table(self._path.parent / value)
        for line, row in enumerate(table.rows, 2):
            yield table, row, f"{table.path}, row {line}"

    def _who(self, table: Table, row: list[str], place: str) -> str:
        names = (table.get(row, head).lstrip("'") for head in _WHO)
        if name := next(filter(None, names), ""):
            return self._key(name, place)
        raise BotschoolError(f"names no student in a column {', '.join(_WHO)}.")

    def _key(self, name: str, place: str) -> str:
        """Return the key of a person."""
        key = folded(name)
        self._policy.places.setdefault(key, place)
        return key

    def roster(self, value: Any) -> Path:
        if not isinstance(value, str) or not value:
            raise BotschoolError("'roster' is not a file name.")
        return self._path.parent / value

    def due(self, value: Any) -> dict[Number, datetime]:
        what = "under 'due' a line for each exercise, as '3: 2026-11-20 23:59'"
        return self._numbered(value, what, _moment)

    def late(self, value: Any) -> LateRule:
        found = _LATE.fullmatch(str(value).strip())
        if not found:
            raise BotschoolError(f"'late: {value}' is not a rule: write '10 per day, at most 50'.")
        return LateRule(float(found["off"]), found["unit"].lower(), float(found["most"] or 100))

    def extensions(self, value: Any) -> dict[str, dict[Number, datetime]]:
        what = "under 'extensions' a student, and under that '3: 2026-11-25'"
        found: dict[str, dict[Number, datetime]] = {}
        for name, dues in self._items(value, what):
            place = self._place(value, name)
            with self._at(place):
                dues = self._numbered(dues, what, _moment)
                found.setdefault(self._key(name, place), {}).update(dues)
        return found

    def weights(self, value: Any) -> dict[Number, float]:
        what = "under 'weights' a line for each exercise, as '3: 2'"
        return self._numbered(value, what, lambda each: _positive(each, f"write {what}."))

    def total(self, value: Any) -> float:
        return _positive(value, f"'total: {value}' is not a number of points: write 'total: 100'.")

    def bonus(self, value: Any) -> bool:
        said = str(value).casefold()
        if said not in ("yes", "no", "true", "false", "on", "off"):
            raise BotschoolError(f"'bonus: {value}' is neither yes nor no: write 'bonus: yes'.")
        return said in ("yes", "true", "on")

    def tasks(self, value: Any) -> dict[str, int]:
        what = "under 'tasks' a line for each task, as '3.2: 30'; 0 drops a task"
        found: dict[str, int] = {}
        for key, each in self._items(value, what):
            with self._at(self._place(value, key)):
                points = number_in(each, MOST_POINTS) if isinstance(each, str) else None
                if points is None or points != int(points) or not re.fullmatch(r"\d+\.\d+", key):
                    raise BotschoolError(f"write {what}.")
                found[key] = int(points)
        return found

    def syntax(self, value: Any) -> str:
        if value not in ("its task", EVERYTHING):
            raise BotschoolError(
                f"'syntax: {value}' is not a rule: write 'its task' or '{EVERYTHING}'."
            )
        return value

    def adjustments(self, value: Any) -> dict[str, list[Adjustment]]:
        found: dict[str, list[Adjustment]] = {}
        for each in value if isinstance(value, list) else [value]:
            for table, row, place in self._table(each, "adjustments"):
                if table.path not in self._policy.tables:
                    self._policy.tables.append(table.path)
                with self._at(place):
                    if change := adjustment(table, row):
                        found.setdefault(self._who(table, row, place), []).append(change)
        return found

    def submitted(self, value: Any) -> dict[str, dict[Number, datetime]]:
        found: dict[str, dict[Number, datetime]] = {}
        for table, row, place in self._table(value, "submitted"):
            with self._at(place):
                if moment := table.get(row, "submitted"):
                    number = table.get(row, "exercise")
                    times = found.setdefault(self._who(table, row, place), {})
                    times[_number(number) if number else 0] = _moment(moment)
        return found

    def groups(self, value: Any) -> dict[tuple[str, Number], list[str]]:
        found: dict[tuple[str, Number], list[str]] = {}
        for table, row, place in self._table(value, "groups"):
            with self._at(place):
                group = table.get(row, "group", "team").lstrip("'")
                if not group:
                    raise BotschoolError("names no group: fill in the column 'group'.")
                number = table.get(row, "exercise")
                key = group, _number(number) if number else 0
                found.setdefault(key, []).append(self._who(table, row, place))
        return found


def adjustment(table: Table, row: list[str]) -> Adjustment | None:
    """Return what a row of a table of adjustments says; None if it has neither points nor comment.

    Raises BotschoolError.
    """
    points = table.get(row, "points").lstrip("'").replace(",", ".")
    exercise, _, task = table.get(row, "exercise").partition(".")
    reason = table.get(row, "reason", "comment").rstrip(".")
    if not points and not (task and reason):
        return None
    match = re.fullmatch(r"([=+-]?)(\d+(?:\.\d+)?)", points or "0")
    if not match:
        raise BotschoolError(f"'{points}' are not points: write +5, -10 or =80.")
    change = -float(match[2]) if match[1] == "-" else float(match[2])
    number = TOTAL if exercise.strip().casefold() == TOTAL else _number(exercise)
    return Adjustment(number, change, match[1] == "=", reason, task and f"{number}.{task}")


def _positive(value: Any, otherwise: str) -> float:
    number = number_in(value, MOST_POINTS) if isinstance(value, str) else None
    if number is None:
        raise BotschoolError(otherwise)
    return number


def _number(value: Any) -> Number:
    text = str(value).strip().lower()
    if lab := re.fullmatch(r"lab(?:oratory)?\s*0?([0-9]{1,2})", text):
        return f"lab{lab[1]}"
    if not re.fullmatch(r"[0-9]{1,3}", text):
        raise BotschoolError(
            f"'{value}' is neither the number of an exercise nor a laboratory such as lab9."
        )
    return int(text)


def _moment(value: Any) -> datetime:
    moment = read_moment(value) if isinstance(value, str) else None
    if moment is None:
        raise BotschoolError(f"'{value}' is not a time: write 2026-11-20 23:59.")
    return moment
