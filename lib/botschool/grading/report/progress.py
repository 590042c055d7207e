"""Store the last points, show them as one table, and show the answers after full marks."""

from __future__ import annotations

import contextlib
import json
import zlib
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from rich.markup import escape
from rich.table import Table
from rich.text import Text

from botschool.errors import BotschoolError
from botschool.grading.copies.starting import original
from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.exercise import Exercise, folder_of, load_exercise, submission_file
from botschool.grading.declare.state import STATE, make_state, stored
from botschool.grading.packed import PACKED, unpack_answers
from botschool.grading.run.confined import content_digest
from botschool.lock import alone
from botschool.output import save_bytes

_BAR = 12
CHANGED, UNKNOWN = "changed since", "not graded yet"


def stored_result(number: int, root: Path) -> dict[str, Any]:
    """Return an exercise's last result without grading it, as in batch.Grades.

    Its "state" is CHANGED if the file has changed since, UNKNOWN if no task was graded, else "". An
    unedited file has 0 points. "problem" says that the file is missing.
    """
    exercise = load_exercise(number, root)
    tasks, digests = recall(root, exercise)
    state = problem = ""
    try:
        file = submission_file(number, None, root)
    except BotschoolError:
        problem = f"missing: botschool start {number}"
    else:
        state = "" if digests == {digest(file)} else CHANGED if digests else UNKNOWN
    if problem or _untouched(number, root, file):
        state, tasks = "", [task | {"points": 0} for task in tasks]
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
    """Return a table with a line per exercise.

    results: exercise number -> result as in batch.Grades or from stored_result.
    """
    shown = Table(box=None, pad_edge=False, padding=(0, 1), header_style="dim")
    shown.add_column("", justify="right", no_wrap=True, min_width=2)
    shown.add_column("exercise", no_wrap=True, overflow="ellipsis", min_width=21)
    shown.add_column("points", no_wrap=True, min_width=_BAR)
    shown.add_column("", justify="right", no_wrap=True, min_width=3)
    shown.add_column("tasks", justify="right", no_wrap=True, min_width=5)
    shown.add_column("next")  # the only column that shrinks, to make room for the text of a problem
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
    """Return the lines below the table."""
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


FOLDER = "last"
"""A folder in the commands' state folder, with a file for each exercise."""


def digest(file: Path) -> str:
    """Return a digest of the submission's files; "" if they cannot be read."""
    try:
        return content_digest(file).hexdigest()
    except (Wrong, OSError):
        return ""


def remember(root: Path, number: int, points: Iterable[tuple[str, int, int]], graded: str) -> None:
    """Store (task, points, maximum points); graded: the digest of the graded files.

    Tasks that were not graded now keep their points. Errors in storing are ignored.
    """
    new = {task: {"points": p, "max_points": most, "digest": graded} for task, p, most in points}
    with contextlib.suppress(OSError, BotschoolError):
        place = _place(root, number)
        make_state(root)
        place.parent.mkdir(exist_ok=True)
        with alone(place.parent):
            save_bytes(place, json.dumps(_read(root, number) | new, indent=1).encode())


def recall(root: Path, exercise: Exercise) -> tuple[list[dict[str, Any]], set[str]]:
    """Return the last results of an exercise's tasks, and the digests of the graded files.

    Each result has id, title, points (0 for a task that was not graded) and max_points.
    """
    stored, tasks, digests = _read(root, exercise.number), [], set()
    for task in exercise.tasks:
        one = stored.get(task.id, {"max_points": None})
        known = one["max_points"] == task.max_points
        points = one["points"] if known else 0
        digests |= {one["digest"]} if known else set()
        tasks.append({"id": task.id, "title": task.title, "points": points})
        tasks[-1]["max_points"] = task.max_points
    return tasks, digests


def _place(root: Path, number: int) -> Path:
    return root / STATE / FOLDER / f"ex{number:02d}.json"


def _read(root: Path, number: int) -> dict[str, dict[str, Any]]:
    """Return task -> points, max_points, digest; damaged entries are left out."""
    found = stored(_place(root, number))
    return {task: one for task, one in found.items() if isinstance(one, dict) and _is_whole(one)}


def _is_whole(one: dict[str, Any]) -> bool:
    """Return whether points, their maximum and the digest are what `remember` writes."""
    points, most = one.get("points"), one.get("max_points")
    whole = type(points) is int and type(most) is int and isinstance(one.get("digest"), str)
    return whole and 0 <= points <= most


def answers(number: int, root: Path) -> str:
    """Return the text shown after full marks, as Markdown.

    Raises BotschoolError if the text is missing, or if the student's last result has not all
    points.
    """
    exercise, folder = load_exercise(number, root), folder_of(number, root)
    packed, plain = folder / PACKED, root / "solutions" / folder.name / "README.md"
    if not packed.is_file() and not plain.is_file():
        raise BotschoolError(
            f"This copy has no answers to exercise {number}: ask your instructor for them."
        )
    points = sum(task["points"] for task in recall(root, exercise)[0])
    maximum = sum(task.max_points for task in exercise.tasks)
    if points < maximum:
        raise BotschoolError(
            f"The answers to exercise {number} need all points from 'botschool grade "
            f"{number}'; you have {points} of {maximum}."
        )
    try:
        if packed.is_file():
            return unpack_answers(packed.read_text(encoding="ascii"))
        return plain.read_text(encoding="utf-8")
    except (OSError, ValueError, zlib.error):
        raise BotschoolError(
            f"{packed} is damaged: ask your instructor for the file again."
        ) from None
