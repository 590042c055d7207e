"""Grading again whenever the student saves."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

from botschool.grading.declare.exercise import Exercise
from botschool.grading.judge.submission import TaskResult, grade
from botschool.grading.report.screen import Screen
from botschool.grading.run.confined import fork_server
from botschool.sandbox import ForkServer

POLL_SECONDS = 0.3
"""Seconds."""


class Saved(Exception):
    """The file was saved while it was being graded."""


def stamp(folder: Path) -> tuple:
    """Changes when one of the Python files in a folder is saved."""
    found = []
    for path in sorted(folder.glob("*.py")):
        try:
            status = path.stat()
            found.append((path.name, status.st_mtime_ns, status.st_size))
        except OSError:  # an editor is replacing it
            continue
    return tuple(found)


def watch(
    exercise: Exercise,
    file: Path,
    tasks: list,
    screen: Screen,
    wait: Callable[[float], None] = time.sleep,
) -> None:
    """Grades now and after every save, for ever; `wait` is called between two looks."""
    with fork_server(exercise.imports) as server:
        while True:
            seen = stamp(file.parent)
            try:
                _once(exercise, file, tasks, screen, seen, server)
            except Saved:
                continue
            screen.console.print("[dim]Waiting for the next save; Ctrl-C ends.[/]")
            while stamp(file.parent) == seen or not file.is_file():
                wait(POLL_SECONDS)


def _once(
    exercise: Exercise,
    file: Path,
    tasks: list,
    screen: Screen,
    seen: tuple,
    server: ForkServer,
) -> None:
    screen.console.clear()
    screen.start(exercise.number, exercise.title, file)

    def report(result: TaskResult) -> None:
        if stamp(file.parent) != seen:
            raise Saved
        screen.task(result)

    result = grade(exercise, file, report, tasks, server, announce=screen.banner)
    screen.end(result, whole=len(tasks) == len(exercise.tasks))
