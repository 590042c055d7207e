"""Show all calls of a task with both answers, or run its checks in a debugger's reach."""

from __future__ import annotations

import traceback
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
from rich.markup import escape

from botschool.console import Console
from botschool.errors import BotschoolError
from botschool.grading.declare.checks import NotDone, Wrong, plain
from botschool.grading.declare.exercise import Exercise, Task
from botschool.grading.declare.same import Same
from botschool.grading.declare.values import kind, show
from botschool.grading.judge.submission import opened
from botschool.grading.report.calls import calls_of
from botschool.grading.run.confined import fork_server
from botschool.grading.run.direct import Direct
from botschool.grading.run.ours import ours_of
from botschool.grading.run.student import Student

MOST = 3
"""Wrong calls of a check to show with their numbers."""
NUMBERS = 40
"""Numbers of an array to show."""


def explain(exercise: Exercise, task: Task, file: Path, console: Console) -> None:
    """Print the calls of a task that declares its inputs. Raises BotschoolError."""
    checks = [check for _, _, check in task.checks if isinstance(check, Same)]
    if not checks:
        raise BotschoolError(
            f"Task {task.id} has no calls to compare: botschool grade {task.id} says what it asks."
        )
    console.print(f"[bold]Task {task.id}. {escape(task.title)}[/]")
    with (
        fork_server(exercise.imports) as server,
        opened(exercise, file, server) as submission,
        closing(submission.begun(task)) as student,
    ):
        try:
            for check in checks:
                console.print(f"[bold]{check.__name__.replace('_', ' ')}[/]")
                _print(check, student, console)
        except NotDone as error:
            console.print(f" [red]✗[/] {escape(plain(str(error)))}", soft_wrap=True)


def _print(check: Same, student: Student, console: Console) -> None:
    """Print a check's calls. Raises NotDone."""
    wrong = 0
    for call in calls_of(check, student, [*check.inputs(), *(each for _, each in check.more())]):
        wrong += not call.right
        mark = "[green]✓[/]" if call.right else "[red]✗[/]"
        console.print(f" {mark} {escape(plain(call.said))}", soft_wrap=True)
        if call.message:
            console.print(f"     {escape(plain(call.message))}", soft_wrap=True)
        elif not call.right and wrong <= MOST:
            for word, answer in (("returned", call.got), ("expected", call.wanted)):
                shown = _whole(check.seen(call.said, answer, call.arguments))
                console.print(f"     {word}  {escape(plain(shown))}", soft_wrap=True)


def _whole(value: Any) -> str:
    """Return a value with its shape and its numbers."""
    if isinstance(value, dict):
        return "\n               ".join(f"{key}: {_whole(each)}" for key, each in value.items())
    if isinstance(value, (list, tuple)) and any(isinstance(e, (np.ndarray, dict)) for e in value):
        return "\n               ".join(f"[{i}]: {_whole(each)}" for i, each in enumerate(value))
    if not isinstance(value, (np.ndarray, list, tuple)):
        return show(value, 200)
    many = np.asarray(value, dtype=object if isinstance(value, (list, tuple)) else None)
    text = np.array2string(
        np.asarray(value) if many.dtype != object else many,
        precision=6, threshold=NUMBERS, separator=", ", max_line_width=88, prefix=" " * 15,
    )  # fmt: skip
    return f"{kind(value) if isinstance(value, np.ndarray) else f'a list of {len(value)}'}\n" + (
        f"               {text}"
    )


def debug_task(exercise: Exercise, id: str, file: Path) -> None:
    """Run a task's checks in this process, without limits and points."""
    task = exercise.find(id)
    with (
        fork_server(exercise.imports) as server,
        closing(ours_of(exercise, server)) as exercise.ours,
        closing(Direct(file, through=True)) as student,
    ):
        for _, name, check in task.checks:
            try:
                check(student)
                print(f"passed: {name}")
            except Wrong as error:
                print(f"failed: {name}: {error}")
            except Exception:
                print(f"failed: {name}:")
                traceback.print_exc()
