"""All exercises in one table: points, tasks done, and what comes next."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rich.markup import escape
from rich.table import Table
from rich.text import Text

from botschool.errors import BotschoolError
from botschool.grading.copies.starting import original
from botschool.grading.declare.exercise import load_exercise, submission_file
from botschool.grading.report.stored import digest, recall

_BAR = 12
CHANGED, UNKNOWN = "changed since", "not graded yet"


def stored_result(number: int, root: Path) -> dict[str, Any]:
    """An exercise as it was last graded, without grading: a result as of batch.Grades.

    Its "state" is CHANGED if the file is not as it was graded, UNKNOWN if no task was graded,
    else "". A file as it began has 0 points. "problem" says that the file is missing.
    """
    exercise = load_exercise(number, root)
    tasks = [
        {"id": task.id, "title": task.title, "points": 0, "max_points": task.max_points}
        for task in exercise.tasks
    ]
    state = problem = ""
    try:
        file = submission_file(number, None, root)
    except BotschoolError:
        problem = f"missing: botschool start {number}"
    else:
        found = None if _untouched(number, root, file) else recall(root, exercise)
        if found:
            tasks, digests = found
            state = "" if digests == {digest(file)} else CHANGED
        elif not _untouched(number, root, file):
            state = UNKNOWN
    return {
        "exercise": number,
        "title": exercise.title,
        "points": sum(task["points"] for task in tasks),
        "max_points": sum(task["max_points"] for task in tasks),
        "tasks": tasks,
        "problem": problem,
        "state": state,
    }


def _untouched(number: int, root: Path, file: Path) -> bool:
    try:
        return file.read_bytes() == original(number, root).encode()
    except (BotschoolError, OSError):
        return False


def table(results: dict[int, dict[str, Any]]) -> Table:
    """A line for each; results: exercise number -> result as of batch.Grades or stored_result."""
    shown = Table(box=None, pad_edge=False, padding=(0, 1), header_style="dim")
    shown.add_column("", justify="right", no_wrap=True, min_width=2)
    shown.add_column("exercise", no_wrap=True, overflow="ellipsis", min_width=21)
    shown.add_column("points", no_wrap=True, min_width=_BAR)
    shown.add_column("", justify="right", no_wrap=True, min_width=3)
    shown.add_column("tasks", justify="right", no_wrap=True, min_width=5)
    shown.add_column("next")  # the only one that gives way, to a problem told in a sentence
    for number in sorted(results):
        shown.add_row(str(number), *_row(results[number]))
    return shown


def _row(result: dict[str, Any]) -> tuple[str | Text, ...]:
    tasks, state = result["tasks"], result.get("state", "")
    undone = [task for task in tasks if task["points"] < task["max_points"]]
    if result["problem"]:
        next_ = f"[red]{escape(result['problem'])}[/]"
    elif state:
        next_ = f"[yellow]{state}[/]"
    elif undone:
        next_ = f"{undone[0]['id']} {escape(undone[0]['title'])}"
    else:
        next_ = "[green]all done[/]"
    told = Text.from_markup(next_, overflow="ellipsis")
    told.no_wrap = not result["problem"]
    return (
        escape(result["title"]),
        _bar(result["points"] / max(1, result["max_points"])),
        "?" if state == UNKNOWN else str(result["points"]),
        f"{len(tasks) - len(undone)}/{len(tasks)}",
        told,
    )


def _bar(part: float) -> str:
    full = int(part * _BAR) if part < 1 else _BAR
    return f"[green]{'━' * full}[/][dim]{'─' * (_BAR - full)}[/]"


def summary(results: dict[int, dict[str, Any]]) -> str:
    """The lines below the table."""
    points = sum(result["points"] for result in results.values())
    maximum = sum(result["max_points"] for result in results.values())
    lines = [f"[bold]{points} of {maximum} points[/]"]
    undone = [
        task
        for number in sorted(results)
        for task in results[number]["tasks"]
        if task["points"] < task["max_points"]
    ]
    if undone:
        lines[0] += f"   Next: botschool grade {undone[0]['id']}"
    states = {result.get("state", "") for result in results.values()} - {""}
    if states:
        what = " or ".join(state for state in (CHANGED, UNKNOWN) if state in states)
        lines.append(f"To grade what is {what}: botschool progress --grade")
    return "\n".join(lines)
