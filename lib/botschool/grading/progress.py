"""All exercises in one table: points, tasks done, and what comes next."""

from __future__ import annotations

from typing import Any

from rich.markup import escape
from rich.table import Table

_BAR = 12


def table(results: dict[int, dict[str, Any]]) -> Table:
    """A line for each; results: exercise number -> result as of batch.Grades."""
    shown = Table(box=None, pad_edge=False, padding=(0, 1), header_style="dim")
    shown.add_column("", justify="right", no_wrap=True)
    shown.add_column("exercise", no_wrap=True, overflow="ellipsis", min_width=18)
    shown.add_column("points", no_wrap=True)
    shown.add_column("", justify="right", no_wrap=True)
    shown.add_column("tasks", justify="right", no_wrap=True)
    shown.add_column("next", no_wrap=True, overflow="ellipsis")
    for number in sorted(results):
        shown.add_row(str(number), *_row(results[number]))
    return shown


def _row(result: dict[str, Any]) -> tuple[str, ...]:
    tasks = result["tasks"]
    undone = [task for task in tasks if task["points"] < task["max_points"]]
    if result["problem"]:
        next_ = f"[red]{escape(result['problem'])}[/]"
    elif undone:
        next_ = f"{undone[0]['id']} {escape(undone[0]['title'])}"
    else:
        next_ = "[green]all done[/]"
    return (
        escape(result["title"]),
        _bar(result["points"] / max(1, result["max_points"])),
        str(result["points"]),
        f"{len(tasks) - len(undone)}/{len(tasks)}",
        next_,
    )


def _bar(part: float) -> str:
    full = int(part * _BAR) if part < 1 else _BAR
    return f"[green]{'━' * full}[/][dim]{'─' * (_BAR - full)}[/]"


def summary(results: dict[int, dict[str, Any]]) -> str:
    """The sentence below the table."""
    points = sum(result["points"] for result in results.values())
    maximum = sum(result["max_points"] for result in results.values())
    line = f"[bold]{points} of {maximum} points[/]"
    for number in sorted(results):
        for task in results[number]["tasks"]:
            if task["points"] < task["max_points"]:
                return f"{line}   Next: botschool grade {task['id']}"
    return line
