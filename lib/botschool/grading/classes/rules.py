"""Apply an instructor's rules: deadlines, extensions, adjustments, weights.

Each grading applies them anew (docs/specification.md, "A class"). policy.py reads them.
"""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

from botschool.grading.declare.exercise import Number

_UNITS = {"hour": timedelta(hours=1), "day": timedelta(days=1), "week": timedelta(weeks=1)}
MOST_POINTS = 1e6
TOTAL = "total"
"""What an adjustment of the term's total names instead of an exercise."""


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
    """A class's settings and tables; keys of people are Student.words."""

    roster: Path | None = None
    people: Any = None
    """The class list: a roster.Roster, as the next one."""
    gradebook: Any = None
    """The platform's table, to fill in."""
    column: str = ""
    """The column in Canvas's gradebook."""
    due: dict[Number, datetime] = field(default_factory=dict)
    late: LateRule | None = None
    extensions: dict[str, dict[Number, datetime]] = field(default_factory=dict)
    adjustments: dict[str, list[Adjustment]] = field(default_factory=dict)
    submitted: dict[str, dict[Number, datetime]] = field(default_factory=dict)
    """Times of submission from a table; exercise 0 stands for all."""
    groups: dict[tuple[str, Number], list[str]] = field(default_factory=dict)
    """A group, and the exercise for which it is one (0: all) -> its members."""
    weights: dict[Number, float] = field(default_factory=dict)
    total: float | None = None
    """The points of a total in which nothing is missing; None for the weighted sum."""
    bonus: bool = False
    """Whether points above the maximum count."""
    tasks: dict[str, int] = field(default_factory=dict)
    """Points of tasks that differ from the graders'; 0 drops a task."""
    syntax: str = ""
    """What a syntax error costs: EVERYTHING, else only what stands there."""
    path: Path | None = None
    tables: list[Path] = field(default_factory=list)
    """Tables of adjustments."""
    answers: Any = None
    """Whose entries of a download are: a roster.Answers."""
    places: dict[Any, str] = field(default_factory=dict)
    """Key of a person, or number of an exercise -> where the settings name it."""
    errors: list[str] = field(default_factory=list)
    """Sentences on what cannot be read."""

    def _own(self, rules: dict[str, Any], numbers: set[Any]) -> list[tuple[str, Any, Any]]:
        """Return (person, exercise, rule) of the rules for some exercises."""
        found = []
        for name, values in rules.items():
            is_list = isinstance(values, list)
            pairs = [(each.exercise, each) for each in values] if is_list else values.items()
            found += [(name, key, value) for key, value in pairs if key in numbers]
        return found

    def named(self, numbers: Iterable[Number], with_groups: bool) -> list[str]:
        """Return the keys of people whom rules for some exercises name."""
        wanted = {0, *numbers}
        people = (self.extensions, self.adjustments, self.submitted)
        found = [one[0] for each in people for one in self._own(each, wanted)]
        if with_groups:
            groups = [each for (_, number), each in self.groups.items() if number in wanted]
            found += [member for group in groups for member in group]
        return list(dict.fromkeys(found))

    def digest(self, numbers: Iterable[Number]) -> str:
        """Return a text that changes if a rule for one of these exercises changes."""
        wanted: set[Any] = {0, *numbers}
        people = (self.extensions, self.adjustments, self.submitted)
        own = [sorted(map(str, self._own(each, wanted))) for each in people]
        due = sorted((str(k), str(v)) for k, v in self.due.items() if k in wanted)
        groups, tasks = sorted(self.groups.items(), key=str), sorted(self.tasks.items())
        told = repr((due, self.late, own, groups, self.bonus, self.syntax, tasks))
        return hashlib.sha256(told.encode()).hexdigest()[:16]

    def has_deadline(self, number: Number) -> bool:
        """Return whether the time of submission of an exercise matters."""
        return number in self.due or any(number in each for each in self.extensions.values())

    def apply(
        self,
        result: dict[str, Any],
        names: list[str],
        moment: datetime | None,
        marked: bool,
        extended: datetime | None = None,
    ) -> dict[str, Any]:
        """Return a result with deadline and adjustments; names: the person's words.

        moment: when it was handed in. marked: whether the platform marks it as late. extended: the
        platform's own deadline for this person, which counts if class.yaml names none.
        """
        number = result["exercise"]
        points, notes = float(result["points"]), []
        for name in names:
            times = self.submitted.get(name, {})
            moment = times.get(number, times.get(0, moment))
        due = general = self.due.get(number)
        due = extended if due and extended else due
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
        result, points, said = self._adjusted(result, points, names)
        notes += said
        points, capped = self._capped(points, result["max_points"])
        return result | {"points": points, "notes": [*result["notes"], *notes, *capped]}

    def _capped(self, points: float, most: float) -> tuple[float, list[str]]:
        """Return points within their limits, and a sentence if some do not count."""
        if points > most and not self.bonus:
            return tidy(most), [f"{tidy(points)} points: {tidy(most)} count."]
        return tidy(max(0.0, points)), []

    def weighed(self, results: Iterable[dict[str, Any]]) -> tuple[float, float]:
        """Return the weighted sums of points and of their maxima."""
        weighed = [(self.weight(r["exercise"]), r["points"], r["max_points"]) for r in results]
        return sum(w * points for w, points, _ in weighed), sum(w * most for w, _, most in weighed)

    def of_term(
        self, results: Iterable[dict[str, Any]], names: list[str]
    ) -> tuple[float, float, list[str]]:
        """Return the term's total, its maximum, and sentences; names: as in `apply`."""
        points, most = self.weighed(results)
        if self.total is not None:
            points, most = points * self.total / most if most else 0.0, self.total
        whole = {"exercise": TOTAL, "graded": True, "tasks": []}
        _, points, notes = self._adjusted(whole, points, names)
        points, capped = self._capped(points, most)
        return points, tidy(most), [*notes, *capped]

    def _adjusted(
        self, result: dict[str, Any], points: float, names: list[str]
    ) -> tuple[dict[str, Any], float, list[str]]:
        """Return the result and its points after the adjustments by hand, and sentences."""
        notes = []
        for each in (a for name in dict.fromkeys(names) for a in self.adjustments.get(name, ())):
            if each.exercise == result["exercise"] and (result["graded"] or each.sets):
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
        return result, points, notes

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
            task["rubric"] = task.get("rubric", task["message"])
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
