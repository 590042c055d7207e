"""Ten mistakes of beginners an exercise: the message names at least eight of them.

mistakes/exNN.py holds MISTAKES, a list of (task, what the learner does, words, code).
The words are a regular expression that only a message which names the mistake fits. Code is added
to the solution, and redefines its functions; or it is "mutant NAME", one of mutants/exNN; or a
pair (old, new) of texts in the solution. Run as a program it prints the table:

    .venv/bin/python tests/course/test_mistakes.py 3 8
"""

import re
import runpy
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import pytest

import building
from botschool.grading.confined import fork_server
from botschool.grading.submission import grade

pytestmark = pytest.mark.course

TABLES = {int(path.stem[2:]): path for path in sorted((building.HERE / "mistakes").glob("ex*.py"))}
NAMED = 8
"""Of ten."""


@dataclass
class Row:
    """A mistake, what the grader said, and whether that names it."""

    task: str
    what: str
    message: str
    points: bool
    """Whether the task lost any."""
    named: bool


def text_with(number: int, code: str | tuple[str, str]) -> str:
    """The solution with a mistake."""
    solution = building.source(number).solution
    if isinstance(code, tuple):
        assert solution.count(code[0]) == 1, code
        return solution.replace(*code)
    if code.startswith("mutant "):
        place = building.HERE / "mutants" / f"ex{number:02d}" / f"{code.split()[1]}.py"
        code = place.read_text(encoding="utf-8")
    return building.inserted(solution, code)


def rows_of(number: int) -> list[Row]:
    """Grades the mistakes of an exercise, each in its task."""
    exercise, rows = building.exercise(number), []
    with fork_server(exercise.imports) as server, tempfile.TemporaryDirectory() as folder:
        for index, (id, what, words, code) in enumerate(
            runpy.run_path(str(TABLES[number]))["MISTAKES"]
        ):
            file = building.write(Path(folder) / str(index), number, text_with(number, code))
            result = grade(exercise, file, tasks=[exercise.find(id)], server=server)
            (task,) = result.tasks
            message = f"{result.banner}\n{task.message}".strip()
            lost = task.points < task.max_points
            rows.append(Row(id, what, message, lost, lost and bool(re.search(words, message))))
    return rows


def table_of(number: int, rows: list[Row]) -> str:
    """As Markdown."""
    named = sum(row.named for row in rows)
    lines = [f"Exercise {number}: {named} of {len(rows)} named", "", "| task | mistake | named |"]
    lines += ["|---|---|---|"]
    lines += [f"| {row.task} | {row.what} | {'yes' if row.named else 'no'} |" for row in rows]
    return "\n".join(lines)


@pytest.mark.parametrize("number", TABLES, ids="ex{:02d}".format)
def test_eight_of_ten_mistakes_are_named(number):
    rows = rows_of(number)
    print(table_of(number, rows))
    assert len(rows) == len({(row.task, row.what) for row in rows}) == 10
    for row in rows:
        assert row.points, f"{row.what}: no points lost"
    unnamed = [(row.task, row.what, row.message) for row in rows if not row.named]
    assert len(unnamed) <= len(rows) - NAMED, unnamed


def main() -> None:
    for number in map(int, sys.argv[1:] or TABLES):
        rows = rows_of(number)
        print(table_of(number, rows), end="\n\n", flush=True)
        for row in rows:
            if not row.named or not row.points:
                print(f"not named: {row.task} {row.what}\n{row.message}\n", flush=True)


if __name__ == "__main__":
    main()
