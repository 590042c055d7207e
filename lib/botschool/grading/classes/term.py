"""Join the outputs of several gradings into one table of the term.

Each output of grade-all keeps its results in RECORD, with all that is known of the people.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from botschool.console import Console
from botschool.errors import BotschoolError
from botschool.grading.classes.files import listed
from botschool.grading.classes.register import Members, Row
from botschool.grading.classes.roster import PEOPLE, Student
from botschool.grading.classes.rules import TOTAL, Policy, tidy
from botschool.grading.classes.tables import check_own, made_table
from botschool.grading.declare.exercise import Number, called
from botschool.grading.report.paper import GENERATOR
from botschool.output import save_bytes

RECORD, TABLE = "grades.json", "gradebook.csv"
_EMPTY = {
    "points": 0.0, "graded": False, "handed in": False, "notes": [], "problem": ""
}  # fmt: skip
"""A result of somebody who handed in nothing."""


@dataclass
class Output:
    """What a grading has left: its folder, and each person with the results."""

    folder: Path
    settings: str
    """The path of its class.yaml; "" for none."""
    rules: str
    people: list[tuple[Student, list[str], dict[Number, dict[str, Any]]]]
    """Each person, what the downloads call the person, and the result of each exercise."""

    @property
    def numbers(self) -> set[Number]:
        return {number for _, _, results in self.people for number in results}


def record(rows: list[Row], policy: Policy, rules: str) -> bytes:
    """Return what the table of a term needs; rules: Policy.digest of the exercises."""
    kept = ("exercise", "title", "points", "max_points", "graded", "problem", "notes")
    people = [
        {
            "name": row.name,
            "values": row.student.values,
            "listed": row.student.listed,
            "names": [name for part in row.parts for name in part.names],
            "results": [
                {key: result[key] for key in kept}
                | {"handed in": bool(row.handed(result["exercise"]))}
                for result in row.results
            ],
        }
        for row in rows
    ]
    settings = str(policy.path.resolve()) if policy.path else ""
    made = {"made by": GENERATOR, "class": settings, "rules": rules, "people": people}
    return json.dumps(made, indent=0, default=str).encode("utf-8", "replace")


def read_output(folder: Path) -> Output:
    """Return what a grading has left in its folder. Raises BotschoolError."""
    path = folder / RECORD
    try:
        made = json.loads(path.read_bytes())
        people = []
        for person in made["people"]:
            results = {result["exercise"]: _EMPTY | result for result in person["results"]}
            values = {str(label): str(text) for label, text in person["values"].items()}
            student = Student(str(person["name"]), values, listed=bool(person["listed"]))
            people.append((student, [student.name, *map(str, person["names"])], results))
        return Output(folder, str(made["class"]), str(made["rules"]), people)
    except FileNotFoundError:
        raise BotschoolError(
            f"{folder} holds no {RECORD}: name a folder that grade-all has written, or grade again."
        ) from None
    except OSError as error:
        raise BotschoolError(f"{path} cannot be read ({error.strerror}).") from None
    except (ValueError, TypeError, KeyError, AttributeError, RecursionError):
        raise BotschoolError(f"{path} is damaged: grade again, with the same -o.") from None


class Term(Members):
    """The people of a term, with the results of all outputs."""

    def __init__(self, outputs: list[Output], policy: Policy) -> None:
        """Join the outputs. Raises BotschoolErrors, with all that is wrong in the settings."""
        super().__init__(policy)
        self.exercises = {
            number: result | _EMPTY
            for output in outputs
            for _, _, results in output.people
            for number, result in results.items()
        }
        found: dict[int, list[dict[Number, dict[str, Any]]]] = {}
        for output in outputs:
            people = [student for student, _, _ in output.people]
            names = [own for _, own, _ in output.people]
            values = [student.values for student in people]

            def clash(at: int, student: Student, output: Output = output) -> bool:
                mine = _handed(output.people[at][2])
                return any(mine & _handed(each) for each in found.get(id(student), ()))

            joined = self.join(values, names, str(output.folder), what="columns", clash=clash)
            for own, student, (_, said, results) in zip(people, joined, output.people, strict=True):
                if student is None:
                    own.values[PEOPLE] = self.answer(said)
                    own.listed = own.listed and not self.has_list
                    self.students.append(student := own)
                elif not self.has_list:
                    student.values = own.values | student.values
                found.setdefault(id(student), []).append(results)
        for student in self.students:
            if student.listed or id(student) in found:
                row = Row(student)
                own = found.get(id(student), [])
                row.results = [self._best(each, own) for each in self.exercises]
                self.rows.append(row)
        self.check_names([TOTAL])
        for row in self.rows:
            self.finish(row)

    def _best(self, number: Number, results: list[dict[Number, dict[str, Any]]]) -> dict[str, Any]:
        """Return the best result of an exercise; one without points for who handed in nothing."""
        own = [each[number] for each in results if number in each]
        made = [each for each in own if each["handed in"] or each["graded"]]
        if not made:
            return self.exercises[number]
        best = max(made, key=lambda each: (each["graded"], each["points"]))
        if sum(each["handed in"] for each in made) > 1:
            note = f"In {len(made)} outputs: the better one counts."
            best = best | {"notes": [*best["notes"], note]}
        return best

    def finish(self, row: Row) -> None:
        """Compute a row's total, in which nothing counts 0; None if a submission is not graded."""
        total, _, row.said = self.policy.of_term(row.results, row.keys)
        there = [result for result in row.results if result["handed in"] or result["graded"]]
        if all(result["graded"] for result in there) and (there or row.said):
            row.total = total

    @property
    def maximum(self) -> float:
        return self.policy.of_term(self.exercises.values(), [])[1]

    @property
    def missing(self) -> list[Row]:
        return [row for row in self.rows if not any(r["handed in"] for r in row.results)]


def _handed(results: dict[Number, dict[str, Any]]) -> set[Number]:
    return {number for number, result in results.items() if result["handed in"]}


def table(term: Term) -> bytes:
    """Return the table of the term: a row for each person."""
    heads = [called(number).lower() for number in term.exercises]
    own = ["student", "total", "maximum", *heads, "notes"]
    more = dict.fromkeys(h for row in term.rows for h in row.student.cells if h not in own)
    rows: list[list[Any]] = [[*own, *more]]
    for row in term.rows:
        points = [tidy(r["points"]) if r["graded"] else "" for r in row.results]
        notes = " ".join([*map(_said, row.results), *row.said])
        total = "" if row.total is None else row.total
        about = [row.student.cells.get(head, "") for head in more]
        rows.append([row.name, total, term.maximum, *points, notes, *about])
    return made_table(rows)


def _said(result: dict[str, Any]) -> str:
    said = " ".join(filter(None, [result["problem"], *result["notes"]]))
    return f"{called(result['exercise'])}: {said}" if said else ""


def say_term(console: Console, term: Term, outputs: list[Output]) -> bool:
    """Print what the instructor must know; True if nothing is left to do."""
    counts = [f"{len(term.rows)} people, {len(term.exercises)} exercises", term.average()]
    lines = [", ".join(filter(None, counts)) + ".", *term.how, *term.lacking()]
    lacking = ((row, r) for row in term.rows for r in row.results if not r["graded"])
    ungraded = list(dict.fromkeys(row.name for row, result in lacking if result["handed in"]))
    if ungraded:
        lines.append(f"Not graded, so without a total: {listed(ungraded)}.")
    for one in outputs:
        if one.rules != term.policy.digest(one.numbers):
            lines.append(
                f"{one.folder} was graded with other settings than the class has now: grade it "
                "again."
            )
    for line in [*lines, *term.notes]:
        console.print(line, markup=False, soft_wrap=True)
    return not (ungraded or term.missing or term.unknown or term.doubts)


def write_term(term: Term, output: Path, more: dict[str, bytes]) -> list[Path]:
    """Write the table and the platform's; return the paths. Raises BotschoolError."""
    check_own(output / TABLE, "student,total", "botschool gradebook")
    output.mkdir(parents=True, exist_ok=True)
    made = {TABLE: table(term)} | more
    for name, content in made.items():
        save_bytes(output / name, content)
    return [output / name for name in made]
