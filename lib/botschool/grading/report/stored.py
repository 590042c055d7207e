"""What the tasks of the student's own files were worth when they were last graded."""

from __future__ import annotations

import contextlib
import hashlib
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.classes.batch import STATE, make_state
from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.exercise import Exercise
from botschool.grading.run.confined import submission_files
from botschool.output import save_bytes

FOLDER = "last"
"""In the folder of what the commands remember: a file for each exercise."""


def digest(file: Path) -> str:
    """Of all files that are handed in with this one; "" if they cannot be read."""
    found = hashlib.sha256()
    try:
        for path in submission_files(file):
            name = str(path.relative_to(file.parent)).encode(errors="surrogateescape")
            found.update(hashlib.sha256(name).digest())
            found.update(hashlib.sha256(path.read_bytes()).digest())
    except (Wrong, OSError):
        return ""
    return found.hexdigest()


def remember(root: Path, number: int, points: Iterable[tuple[str, int, int]], graded: str) -> None:
    """Stores (task, points, most points); graded: the digest of what was graded.

    Tasks that were not graded now keep what they have. What cannot be stored is dropped.
    """
    tasks = _read(root, number)
    for task, reached, most in points:
        tasks[task] = {"points": reached, "max_points": most, "digest": graded}
    with contextlib.suppress(OSError, BotschoolError):
        place = _place(root, number)
        make_state(root)
        place.parent.mkdir(exist_ok=True)
        save_bytes(place, json.dumps(tasks, indent=1).encode())


def recall(root: Path, exercise: Exercise) -> tuple[list[dict[str, Any]], set[str]] | None:
    """An exercise's tasks as they were last graded, None if none of them was.

    Gives their id, title, points (0 where a task was not graded) and max_points; and the digests
    of what was graded.
    """
    stored = _read(root, exercise.number)
    tasks, digests = [], set()
    for task in exercise.tasks:
        one = stored.get(task.id)
        known = one is not None and one["max_points"] == task.max_points
        tasks.append(
            {
                "id": task.id,
                "title": task.title,
                "points": one["points"] if known else 0,
                "max_points": task.max_points,
            }
        )
        if known:
            digests.add(one["digest"])
    return (tasks, digests) if digests else None


def _place(root: Path, number: int) -> Path:
    return root / STATE / FOLDER / f"ex{number:02d}.json"


def _read(root: Path, number: int) -> dict[str, dict[str, Any]]:
    """task -> points, max_points, digest; what is damaged counts as not stored."""
    try:
        found = json.loads(_place(root, number).read_bytes())
        return {
            str(task): {
                "points": int(one["points"]),
                "max_points": int(one["max_points"]),
                "digest": str(one["digest"]),
            }
            for task, one in found.items()
        }
    except (OSError, ValueError, LookupError, TypeError, AttributeError):
        return {}
