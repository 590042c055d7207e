"""Apply an instructor's rules: deadlines, extensions, adjustments, weights.

One file, class.yaml, and the tables that it names hold all rules; each grading applies them anew
(docs/specification.md, "Collecting submissions").
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from datetime import date, datetime, time, timedelta
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.classes.roster import Student, words
from botschool.grading.classes.tables import Table, read_table
from botschool.grading.classes.texts import is_larger
from botschool.grading.declare.exercise import Number

_LATE = re.compile(
    r"(?P<off>\d+(?:\.\d+)?)\s*(?:points?\s*)?(?:/|per)\s*(?:started\s*)?(?P<unit>day|hour|week)"
    r"(?:\s*,?\s*(?:at most|up to)\s*(?P<most>\d+(?:\.\d+)?))?",
    re.IGNORECASE,
)
FILE = "class.yaml"
MOST_VALUES = 100_000
_UNITS = {"hour": timedelta(hours=1), "day": timedelta(days=1), "week": timedelta(weeks=1)}
_KEYS = ("roster", "due", "late", "extensions", "adjustments", "submitted", "weights")


@dataclass
class LateRule:
    """A loss of points, out of a hundred, for each started day (hour, week)."""

    off: float
    unit: str
    most: float = 100.0

    def points(self, by: timedelta) -> float:
        """Return how many of a hundred points a delay costs."""
        return min(self.most, self.off * math.ceil(by / _UNITS[self.unit])) if by > _NONE else 0.0


_NONE = timedelta()


@dataclass
class Adjustment:
    """A manual change of a person's points."""

    exercise: Number
    points: float
    sets: bool
    """Whether the number is the points themselves, not a change."""
    reason: str
    task: str = ""
    """The task whose points change; "" for the exercise's."""


@dataclass
class Policy:
    """A class's settings; keys of people are those of roster.words or student ids."""

    roster: Path | None = None
    due: dict[Number, datetime] = field(default_factory=dict)
    late: LateRule | None = None
    extensions: dict[str, dict[Number, datetime]] = field(default_factory=dict)
    adjustments: dict[str, list[Adjustment]] = field(default_factory=dict)
    submitted: dict[str, dict[Number, datetime]] = field(default_factory=dict)
    """Times of submission from a table; exercise 0 stands for all."""
    weights: dict[Number, float] = field(default_factory=dict)
    tables: list[Path] = field(default_factory=list)
    """Tables of adjustments."""

    def names(self, student: Student | None, shown: str) -> list[str]:
        """Return the keys under which the settings may name a person."""
        keys = sorted(student.keys()) if student else []
        return [*keys, words(student.name if student else shown), shown.casefold()]

    def has_deadline(self, number: Number) -> bool:
        """Return whether the time of submission of an exercise matters."""
        return number in self.due or any(number in each for each in self.extensions.values())

    def apply(
        self, result: dict[str, Any], names: list[str], moment: datetime | None, marked: bool
    ) -> dict[str, Any]:
        """Return a result with deadline and adjustments; names: as returned by `names`.

        moment: when it was handed in. marked: whether the platform marks it as late.
        """
        number = result["exercise"]
        points, notes = float(result["points"]), []
        for name in names:
            times = self.submitted.get(name, {})
            moment = times.get(number, times.get(0, moment))
        due = general = self.due.get(number)
        for name in names:
            due = self.extensions.get(name, {}).get(number, due)
        if moment:
            moment = moment.replace(second=0, microsecond=0)  # 23:59 lasts a minute
        if result["graded"] and due and moment and moment > due:
            off = self.late.points(moment - due) * result["max_points"] / 100 if self.late else 0
            off = min(points, off)
            points -= off
            notes.append(f"Late by {_duration(moment - due)}: {tidy(off)} points off.")
        elif result["graded"] and due and marked and moment is None:
            notes.append("The platform marks it late, but not how late.")
            if due != general:
                notes[-1] += f" The extension until {due:%Y-%m-%d %H:%M} counts: nothing is off."
            elif self.late:
                off = self.late.points(_UNITS[self.late.unit]) * result["max_points"] / 100
                off = min(points, off)
                points -= off
                notes[-1] += f" Counted as one {self.late.unit}: {tidy(off)} points off."
        for each in (a for name in dict.fromkeys(names) for a in self.adjustments.get(name, ())):
            if each.exercise == number and (result["graded"] or each.sets):
                if each.task:
                    result, change = _with_task(result, each)
                    points += change
                    continue
                points = each.points if each.sets else points + each.points
                result = result | {"graded": True}
                what = "Set to" if each.sets else "Adjusted by"
                sign = "+" if each.points > 0 and not each.sets else ""
                notes.append(
                    f"{what} {sign}{tidy(each.points)} points: {each.reason or 'by hand'}."
                )
        return result | {"points": tidy(max(0.0, points)), "notes": [*result["notes"], *notes]}

    def weight(self, number: Number) -> float:
        return self.weights.get(number, 1.0)


def _with_task(result: dict[str, Any], by: Adjustment) -> tuple[dict[str, Any], float]:
    """Return the result with a task's points changed within its limits, and the change."""
    tasks, change = [dict(task) for task in result["tasks"]], 0.0
    for task in tasks:
        if task["id"] == by.task:
            wanted = by.points if by.sets else task["points"] + by.points
            points = tidy(min(float(task["max_points"]), max(0.0, wanted)))
            change += points - task["points"]
            task["points"] = points
            task["message"] = "" if by.reason in ("", "words") else by.reason
    return result | {"tasks": tasks, "graded": True}, change


def tidy(number: float) -> int | float:
    """Return a number with at most two decimals; whole if possible."""
    rounded = round(number, 2)
    return int(rounded) if rounded == int(rounded) else rounded


def _duration(by: timedelta) -> str:
    hours = by / timedelta(hours=1)
    if hours < 1:
        return f"{max(1, round(hours * 60))} minutes"
    return f"{hours:.1f} hours" if hours < 48 else f"{hours / 24:.1f} days"


def read_policy(path: Path) -> Policy:
    """Return the settings of a class.yaml. Raises BotschoolError, which names the place."""
    import yaml

    try:
        text = path.read_text(encoding="utf-8-sig")
        found = yaml.safe_load(text)
    except (OSError, UnicodeError) as error:
        raise BotschoolError(f"{path} cannot be read ({error}).") from None
    except (yaml.YAMLError, ValueError) as error:
        mark = getattr(error, "problem_mark", None)
        where = f", line {mark.line + 1}" if mark else ""
        raise BotschoolError(f"{path}{where} is not valid YAML: correct it.") from None
    if is_larger(found, MOST_VALUES):
        raise BotschoolError(f"{path} holds too many values: does an alias (*) repeat them?")
    found = found or {}
    if not isinstance(found, dict):
        raise BotschoolError(f"{path} holds no settings: write lines as 'late: 10 per day'.")
    for key in found:
        if key not in _KEYS:
            raise BotschoolError(
                f"{path}: '{key}' is not a setting: choose from {', '.join(_KEYS)}."
            )
    reader = _Reader(path)
    policy = Policy()
    for key, value in found.items():
        setattr(policy, key, getattr(reader, key)(value))
    policy.tables = reader.tables
    return policy


class _Reader:
    """Read the settings one by one."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self.tables: list[Path] = []

    def _wrong(self, what: str) -> BotschoolError:
        return BotschoolError(f"{self._path}: {what}")

    def _file(self, value: Any, key: str) -> Path:
        if not isinstance(value, str):
            raise self._wrong(f"'{key}' is not a file name.")
        return self._path.parent / value

    def roster(self, value: Any) -> Path:
        return self._file(value, "roster")

    def due(self, value: Any) -> dict[Number, datetime]:
        if not isinstance(value, dict):
            raise self._wrong(
                "write under 'due' a line for each exercise, as '3: 2026-11-20 23:59'."
            )
        return {self._number(key): self._moment(each) for key, each in value.items()}

    def late(self, value: Any) -> LateRule:
        found = _LATE.fullmatch(str(value).strip())
        if not found:
            raise self._wrong(f"'late: {value}' is not a rule: write '10 per day, at most 50'.")
        return LateRule(float(found["off"]), found["unit"].lower(), float(found["most"] or 100))

    def extensions(self, value: Any) -> dict[str, dict[Number, datetime]]:
        if not isinstance(value, dict):
            raise self._wrong("write under 'extensions' a student, and under that '3: 2026-11-25'.")
        return {_key(str(name)): self.due(dues) for name, dues in value.items()}

    def weights(self, value: Any) -> dict[Number, float]:
        try:
            return {self._number(key): float(each) for key, each in dict(value).items()}
        except (TypeError, ValueError):
            raise self._wrong(
                "write under 'weights' a line for each exercise, as '3: 2'."
            ) from None

    def adjustments(self, value: Any) -> dict[str, list[Adjustment]]:
        found: dict[str, list[Adjustment]] = {}
        for each in value if isinstance(value, list) else [value]:
            self.tables.append(self._file(each, "adjustments"))
            self._adjust(read_table(self.tables[-1]), found)
        return found

    def _adjust(self, table: Table, found: dict[str, list[Adjustment]]) -> None:
        for line, row in enumerate(table.rows, 2):
            if not table.get(row, "points"):
                continue
            points = table.get(row, "points").lstrip("'").replace(",", ".")
            match = re.fullmatch(r"([=+-]?)(\d+(?:\.\d+)?)", points)
            if not match:
                raise BotschoolError(
                    f"{table.path}, row {line}: '{points}' are not points: write +5, -10 or =80."
                )
            change = -float(match[2]) if match[1] == "-" else float(match[2])
            exercise, _, task = table.get(row, "exercise").partition(".")
            number = self._number(exercise)
            task = task and f"{number}.{task}"
            reason = table.get(row, "reason").rstrip(".")
            one = Adjustment(number, change, match[1] == "=", reason, task)
            found.setdefault(_named(table, row, line), []).append(one)

    def submitted(self, value: Any) -> dict[str, dict[Number, datetime]]:
        table = read_table(self._file(value, "submitted"))
        found: dict[str, dict[Number, datetime]] = {}
        for line, row in enumerate(table.rows, 2):
            if moment := table.get(row, "submitted"):
                number = table.get(row, "exercise")
                times = found.setdefault(_named(table, row, line), {})
                times[self._number(number) if number else 0] = self._moment(moment)
        return found

    def _number(self, value: Any) -> Number:
        if lab := re.fullmatch(r"lab(?:oratory)?\s*0?([0-9]{1,2})", str(value).strip().lower()):
            return f"lab{lab[1]}"
        if not re.fullmatch(r"[0-9]{1,3}", str(value).strip()):
            raise self._wrong(
                f"'{value}' is neither the number of an exercise nor a laboratory such as lab9."
            )
        return int(value)

    def _moment(self, value: Any) -> datetime:
        if isinstance(value, datetime):
            moment = value
        elif isinstance(value, date):
            moment = datetime.combine(value, time(23, 59, 59))
        else:
            try:
                text = str(value).strip()
                moment = datetime.fromisoformat(text)
                if re.fullmatch(r"\d{4}-\d\d-\d\d", text):
                    moment = datetime.combine(moment, time(23, 59, 59))
            except ValueError:
                moment = moodle_moment(text)
                if moment is None:
                    raise self._wrong(f"'{value}' is not a time: write 2026-11-20 23:59.") from None
        return moment if moment.tzinfo is None else moment.astimezone().replace(tzinfo=None)


def moodle_moment(text: str) -> datetime | None:
    """Return the time of a text such as "Friday, 20 November 2026, 9:14 PM"; None for others."""
    for pattern in ("%A, %d %B %Y, %I:%M %p", "%A, %d %B %Y, %H:%M", "%A, %B %d, %Y, %I:%M %p"):
        try:
            return datetime.strptime(text.strip(), pattern)
        except ValueError:
            continue
    return None


def _named(table: Table, row: list[str], line: int) -> str:
    for meaning in ("id", "mail", "user", "name"):
        if name := table.get(row, meaning).lstrip("'"):
            return _key(name)
    raise BotschoolError(f"{table.path}, row {line} names no student (by name, id or email).")


def _key(name: str) -> str:
    """Return the key of a person: an id, mail or user name as it is, a name by its words."""
    return words(name) if " " in name.strip() else name.strip().casefold()


def unknown_names(policy: Policy, known: set[str]) -> list[str]:
    """Return names in extensions, adjustments and times that belong to nobody."""
    named = [*policy.extensions, *policy.adjustments, *policy.submitted]
    return [name for name in dict.fromkeys(named) if name not in known]
