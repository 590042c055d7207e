"""Give tasks other points, or drop them, as a class's settings say (docs/specification.md)."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

VARIABLE, FILE = "BOTSCHOOL_TASKS", "exercises/tasks.txt"
"""Where the points of tasks stand: for grade-all, and in a copy made by `botschool release`."""


def text_of(points: Mapping[str, int]) -> str:
    """Return the points of tasks as one line, which `chosen` reads."""
    return " ".join(f"{task}={most}" for task, most in sorted(points.items()))


def chosen(root: Path, number: int) -> dict[str, int]:
    """Return the points of an exercise's tasks that differ from the grader's; 0 drops a task."""
    text = os.environ.get(VARIABLE, "")
    if not text and (root / FILE).is_file():
        text = (root / FILE).read_text(encoding="utf-8")
    pairs = [each.partition("=") for each in text.split()]
    return {task: int(most) for task, _, most in pairs if task.startswith(f"{number}.")}


def shared_out(points: list[int], most: int) -> list[int]:
    """Return whole points with the sum `most`, in the proportions of others."""
    total, done, found = sum(points), 0, []
    for at in range(len(points)):
        until = most * sum(points[: at + 1]) // total if total else 0
        found.append(until - done)
        done = until
    return found
