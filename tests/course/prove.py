"""Grade an exercise's known mistakes, alternatives, skeleton and solution, and show what is said.

`python tests/course/prove.py 8 [NAME ...]`, while a grader is being written. A line for each case:
ok or BAD (it loses other tasks than its header says), then what is told: "this" (its own sentence),
"CASE" (another case's) or "-"; words of the first message; seconds.
`--new FILE` grades the cases of a file that the exercise does not know yet: those without a name
are worth keeping. A known mistake is graded in the tasks that it can reach.
"""

from __future__ import annotations

import argparse
import statistics
import tempfile
import time
from pathlib import Path

import building
from botschool.grading.judge.sentence import TOLD, line_about
from botschool.grading.judge.submission import grade
from botschool.grading.run.confined import fork_server


def told(result, case) -> str:
    """Return what a report names as the cause."""
    messages = [line for task in result.tasks for line in task.message.splitlines()]
    own = line_about(case.what)
    if own in messages:
        return "this"
    return "CASE" if any(line.startswith(TOLD) for line in messages) else "-"


def main() -> None:
    """Grade what the arguments name."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("number", type=int)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--new", type=Path)
    given = parser.parse_args()
    exercise, source = building.exercise(given.number), building.source(given.number)
    every = tuple(task.id for task in exercise.tasks)
    jobs = [("skeleton", source.skeleton, every, None), ("solution", source.solution, (), None)]
    if given.new:
        text = given.new.read_text(encoding="utf-8")
        cases, jobs = building.read_cases(given.number, text, building.Case), []
    else:
        cases = building.cases(given.number)
    jobs += [(case.name, case.submission, case.loses, case) for case in cases]
    words = []
    with fork_server(exercise.imports) as server, tempfile.TemporaryDirectory() as folder:
        for i, (name, text, loses, case) in enumerate(jobs):
            if given.names and name not in given.names:
                continue
            file = building.write(Path(folder) / str(i), given.number, text)
            start = time.monotonic()
            tasks = case.tasks(exercise) if case is not None and loses else None
            result = grade(exercise, file, tasks=tasks, server=server)
            lost = tuple(task.id for task in result.tasks if task.points < task.max_points)
            first = next((task.message for task in result.tasks if task.id in lost), "")
            how = told(result, case) if case is not None and loses else ""
            words.append(len(first.split()))
            judged = "ok " if lost == loses else f"BAD: lost {lost}, should {loses}:"
            spent = time.monotonic() - start
            print(f"{judged} {name:45} {how:5} {words[-1]:3} words {spent:5.1f} s", flush=True)
            if how != "this" and name != "skeleton" and first:
                print("      " + first.replace("\n", "\n      "))
    print(f"words: median {statistics.median(words or [0])}, most {max(words or [0])}")


if __name__ == "__main__":
    main()
