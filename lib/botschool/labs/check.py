"""Check a laboratory's sheet and its evidence, and give points for each part."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable
from contextlib import ExitStack, nullcontext, suppress
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from botschool.errors import BotschoolError
from botschool.grading.declare.checks import Wrong
from botschool.grading.run.confined import SHORTAGES, machine_fault
from botschool.grading.run.student import Student
from botschool.labs.confined import drawn_figure, measured, student_file
from botschool.labs.declare import PARTS, STRATEGY
from botschool.labs.evolving import replayed
from botschool.labs.folder import Place
from botschool.labs.runs import LEARN, changed, drawn, own_runs
from botschool.labs.saved import SavedRun, plain_runs
from botschool.labs.sheet import Sheet, Unreadable, check_specific, numbers_in

COMPLETE, EVIDENCE = 10, 15
"""Points of the part `runs`: for complete runs; for runs that are all proven."""
MEASURE, TABLE = 10, 15
"""Points of the part `measurements`: for measure.py; for the table."""

MARK = 3
"""Points of the part `figure` for the vertical line that marks a result, if the sheet asks for one.
"""


@dataclass
class Part:
    """A part of the sheet, with its points."""

    name: str
    max_points: float
    points: float = 0
    messages: list[str] = field(default_factory=list)

    def lose(self, message: str) -> None:
        """Add a sentence about missing points."""
        self.messages.append(message)


class Check:
    """Checks one sheet. `draw` returns random bytes that decide which runs are made again."""

    def __init__(self, place: Place, draw: Callable[[int], bytes] = os.urandom) -> None:
        """Read the sheet. Raises BotschoolError."""
        self.place, self.lab, self.draw = place, place.lab, draw
        self.sheet: Sheet = place.sheet()
        self.parts = {name: Part(name, most) for name, most in PARTS.items()}
        self.answers, _ = self.sheet.values(self.lab.fields.values())
        self.runs: dict[str, list[SavedRun]] = {}
        """The student's proven runs."""
        self.data: dict[str, dict[str, np.ndarray]] = {}
        """Measurements of these runs."""
        self.picture = b""
        """The student's figure, as PNG."""
        self.strategy: Student | None = None
        """The student's own strategy in the sandbox, once a run has been replayed."""

    def all(self) -> Check:
        """Check every part; return self. Raises BotschoolError where the sheet is not to blame."""
        self._walled("prediction", self._prediction)
        self._walled("runs", self._runs)
        self._walled("measurements", self._measurements)
        self._walled("measurements", self._table)
        self._walled("figure", self._figure)
        self._walled("conclusion", self._conclusion)
        return self

    @property
    def points(self) -> float:
        """Return the points of all parts, at most 90; the instructor gives the other ten."""
        return round(sum(part.points for part in self.parts.values()), 1)

    @property
    def full(self) -> bool:
        """Return whether the check has given all that it can give."""
        return self.points >= sum(PARTS.values())

    def _walled(self, name: str, check: Callable[[Part], None]) -> None:
        """Check a part until it raises Wrong; what nobody has thought of costs this part alone."""
        part = self.parts[name]
        try:
            check(part)
        except Wrong as error:
            part.lose(str(error))
        except (BotschoolError, MemoryError):
            raise
        except Exception as error:
            if isinstance(error, OSError) and error.errno in SHORTAGES:
                raise machine_fault(error) from None
            part.points = 0
            part.lose(f"It cannot be checked ({type(error).__name__}: {str(error)[:200]}).")
            if name in ("prediction", "runs"):
                self.runs = {}  # none of them is proven

    @property
    def whole(self) -> set[str]:
        """Return the conditions with enough proven runs; only statements about these count."""
        return {name for name, runs in self.runs.items() if len(runs) == self.lab.replications}

    def _prediction(self, part: Part) -> None:
        try:
            check_specific(self.sheet, self.lab)
        except BotschoolError as error:
            raise Wrong(str(error)) from None
        self.runs = own_runs(self.lab, self.sheet, self.place.runs)
        if not any(self.runs.values()):
            why = changed(self.lab, self.sheet, self.place.runs)
            raise Wrong(why or f"There are no runs yet: botschool lab {self.lab.number} run.")

    def _runs(self, part: Part) -> None:
        lab = self.lab
        there = {c.name: len(self.runs.get(c.name, [])) for c in lab.conditions}
        lacking = [f"{c} has {n}" for c, n in there.items() if n < lab.replications]
        if lacking:
            part.lose(
                f"Each condition needs {lab.replications} finished runs with your seeds, but "
                f"{', '.join(lacking)}: botschool lab {lab.number} run."
            )
        if not any(there.values()):
            return
        if false := self._prove():
            part.lose(
                f"Evolving from the same seeds gives other files than these: {'; '.join(false[:5])}"
                f"{' and others' if len(false) > 5 else ''}. They do not count as runs: remove "
                "their files and run again."
            )
        proven = sum(map(len, self.runs.values()))
        if proven:
            self.parts["prediction"].points = PARTS["prediction"]
        else:
            self.parts["prediction"].lose("It counts once there are runs that follow from it.")
        most = len(lab.conditions)
        enough = not false and proven > most * lab.replications / 2
        part.points = round(COMPLETE * len(self.whole) / most + EVIDENCE * enough, 1)

    def _prove(self) -> list[str]:
        """Keep the proven runs; return the name of each other run, with the reason.

        Each saved robot must get the fitness in its files, and the check makes some runs again,
        drawn at random. If one of these differs, or two runs have the same robot, it makes all of
        them again.
        """
        order = drawn(self.runs, sum(map(len, self.runs.values())), self.draw)
        robots = {run.genotype.tobytes() for run in order}
        told = {run.key: "" for run in order}
        for run in order:
            if not run.condition.maker.genuine(run):
                told[run.key] = "its robot gets another fitness"
        with ExitStack() as stack:
            for number, run in enumerate(order):
                doubtful = len(robots) < len(order) or any(told.values())
                if number >= self.lab.redone and not doubtful:
                    break
                if not told[run.key]:
                    own = run.condition.own
                    told[run.key] = self._replayed(run, stack) if own else self._made_again(run)
        false = []
        for name, runs in self.runs.items():
            self.runs[name] = [run for run in runs if not told[run.key]]
            false += [f"{name}, seed {r.seed} ({told[r.key]})" for r in runs if told[r.key]]
        return false

    def _made_again(self, run: SavedRun) -> str:
        """Make a run again; return what differs, "" if nothing."""
        learns = "learner" in run.condition.experiment
        own = student_file(self.place.folder / LEARN) if learns else nullcontext()
        try:
            with own as student:
                call = student.call if student else None
                again = run.condition.maker.made(run.condition, run.seed, call)
        except (Wrong, BotschoolError) as error:
            return f"{LEARN}: {error}"
        return "" if run.same(again) else "it comes out differently"

    def _replayed(self, run: SavedRun, stack: ExitStack) -> str:
        """Replay a run of the student's own strategy; return what is wrong, "" if nothing."""
        if self.strategy is None:
            try:
                path = self.place.folder / f"{STRATEGY}.py"
                self.strategy = stack.enter_context(student_file(path))
            except Wrong as error:
                return str(error)
        rng = np.random.default_rng(int.from_bytes(self.draw(8), "big"))
        return replayed(run, self.place.runs, self.strategy, rng)

    def _measurements(self, part: Part) -> None:
        """Call measure.py for unseen runs, then for the student's own runs."""
        if not any(self.runs.values()):
            raise Wrong("Measurements count once there are runs of your own that are proven.")
        plain = {name: plain_runs(runs, self.lab.others) for name, runs in self.runs.items()}
        try:
            with student_file(self.place.folder / "measure.py") as student:
                self._unseen(student)
                for name, runs in plain.items():
                    rows = [measured(student, run, tuple(self.lab.measures)) for run in runs]
                    for row, run in zip(rows, runs, strict=True):
                        self._compare(row, run, f"your run of seed {run['seed']}")
                    self._remember(name, rows)
            part.points = MEASURE
        except Wrong as error:
            part.lose(f"measure.py: {error}")
            for name, runs in plain.items():
                self._remember(name, [self._reference(run) for run in runs])

    def _unseen(self, student: Student) -> None:
        """Raise Wrong unless measure.py is right on runs of ours, made for this check."""
        seed = int.from_bytes(self.draw(4), "big") & 0x7FFFFFFF
        made = [c.maker.made(c, seed + i) for i, c in enumerate(self.lab.unseen)]
        found = []
        for run in plain_runs(made, self.lab.others):
            found.append(measured(student, run, tuple(self.lab.measures)))
            self._compare(found[-1], run)
        if told := self.lab.separate(found):
            raise Wrong(told)

    def _reference(self, run: dict[str, Any]) -> dict[str, float]:
        return self.lab.reference(run, self.answers)

    def _remember(self, condition: str, rows: list[dict[str, float]]) -> None:
        self.data[condition] = {
            name: np.array([row[name] for row in rows]) for name in self.lab.measures
        }

    def _compare(
        self, found: dict[str, float], run: dict[str, Any], whose: str = "a run of ours"
    ) -> None:
        """Raise Wrong unless the student's measures are the ones that the sheet describes."""
        right = self._reference(run)
        for name, tolerance in self.lab.measures.items():
            if abs(found[name] - right[name]) > tolerance * max(1.0, abs(right[name])):
                raise Wrong(
                    f"of {whose} ({run['condition']}) it gives {name} = {found[name]:.4g}, "
                    f"which is not what the sheet describes: read what it says of {name}."
                )

    def _table(self, part: Part) -> None:
        cells = [(c, col) for c in self.lab.conditions for col in self.lab.columns]
        cells = [(c, col) for c, col in cells if c.name.startswith(col.only)]
        if self.whole and self._empty():
            raise Wrong("The table is empty: python measure.py prints its rows.")
        right = 0
        for condition, column in cells:
            if condition.name not in self.whole:
                continue
            try:
                row = self.sheet.row(condition.name)
                at = self.lab.columns.index(column)
                true = column.of(self.data[condition.name])
                what = f"The table, {condition.name}, {self.lab.titles[at]}:"
                cell = row[at] if at < len(row) else ""
                given = numbers_in(cell, what, len(true), "in its cell")
            except Unreadable as error:
                part.lose(str(error))
                continue
            off = max(abs(a - b) for a, b in zip(given, true, strict=True))
            if off <= column.tolerance(true) + 1e-9:
                right += 1
            else:
                part.lose(f"{what} your runs give another number: python measure.py prints it.")
        part.points = round(part.points + TABLE * right / len(cells), 1)
        part.messages = _shortened(part.messages)

    def _empty(self) -> bool:
        """Return whether no cell of the sheet's table is filled in."""
        with suppress(Unreadable):
            return not any("".join(self.sheet.row(c.name)) for c in self.lab.conditions)
        return False

    def _figure(self, part: Part) -> None:
        figure = self.lab.figure
        if not all(self.runs.get(name) for name in figure.conditions):
            raise Wrong("The figure counts once each condition that it shows has runs.")
        try:
            with student_file(self.place.folder / "figure.py") as student:
                shown = drawn_figure(student, {k: dict(v) for k, v in self.data.items()})
            self.picture = shown["png"]
            if not all(x.strip() and y.strip() for x, y in shown["labels"]):
                raise Wrong("name both axes, with set_xlabel and set_ylabel.")
            names = " ".join(y for _, y in shown["labels"]).lower()
            if not any(unit in names for unit in figure.units):
                raise Wrong(f"the vertical axis needs its unit: {' or '.join(figure.units)}.")
            _check_points(shown["points"], figure.conditions, figure.y, self.data)
            part.points = part.max_points
            place = figure.mark(self.data) if set(figure.conditions) <= self.whole else None
            if place is not None and not np.isclose(shown["verticals"], place, atol=0.01).any():
                part.points -= MARK
                raise Wrong("mark the result by a vertical line (axvline), as sheet.md asks.")
        except Wrong as error:
            raise Wrong(f"figure.py: {error}") from None

    def _conclusion(self, part: Part) -> None:
        if not any(self.runs.values()):
            raise Wrong("The conclusion counts once there are runs of your own that are proven.")
        asked = [field for field in self.lab.fields.values() if not field.predicts]
        part.messages += self.sheet.values(asked)[1]
        for id, statement in self.lab.statements.items():
            what = self.lab.fields[id].what
            if not set(statement.needs) <= self.whole:
                part.lose(f"{what} Its runs are missing or not proven.")
            elif id in self.answers:
                right, told = statement.judge(self.data, self.answers)
                if right(self.answers[id]):
                    part.points += statement.points
                else:
                    part.lose(f"{what} {told[:1].upper()}{told[1:]}")


def _check_points(
    points: np.ndarray, conditions: tuple[str, ...], y: str, data: dict[str, Any]
) -> None:
    """Raise Wrong unless the figure has a point at the height of every run's value."""
    values = np.concatenate([data[name][y] for name in conditions])
    shown = Counter(float(f"{value:.4g}") for value in points[:, 1])
    lacking = Counter(float(f"{value:.4g}") for value in values) - shown
    if lacking:
        raise Wrong(
            f"every run is a point with its {y} as height, but {sum(lacking.values())} of "
            f"{len(values)} runs are not there: draw the runs, not their means."
        )


def _shortened(messages: list[str]) -> list[str]:
    """Return the first six messages, and how many more there are."""
    rest = len(messages) - 6
    return messages[:6] + ([f"... and {rest} more of this kind."] if rest > 0 else [])
