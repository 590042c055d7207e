"""Show where a class lost points: points and frequent messages of each task."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from html import escape
from typing import Any

MOST_MESSAGES = 3
"""Messages of a task on the page."""


@dataclass
class TaskStatistics:
    """A class's points in a task."""

    id: str
    title: str
    max_points: int
    points: list[int] = field(default_factory=list)
    messages: Counter = field(default_factory=Counter)

    @property
    def mean(self) -> float:
        return sum(self.points) / len(self.points) if self.points else 0.0

    @property
    def reached(self) -> float:
        """Return the share of the points that the class reached."""
        return self.mean / self.max_points if self.max_points else 1.0

    @property
    def full(self) -> int:
        return sum(each == self.max_points for each in self.points)

    @property
    def none(self) -> int:
        return sum(each == 0 for each in self.points)


def by_task(results: Iterable[dict[str, Any]]) -> list[TaskStatistics]:
    """Return the points of each task, from submitted and graded results; in order of tasks."""
    found: dict[str, TaskStatistics] = {}
    for result in results:
        if not result["graded"] or result["problem"]:
            continue
        for task in result["tasks"]:
            one = found.setdefault(
                task["id"], TaskStatistics(task["id"], task["title"], task["max_points"])
            )
            one.points.append(task["points"])
            if task["points"] < task["max_points"] and task["message"].strip():
                one.messages[_alike(task["message"])] += 1
    return list(found.values())


def hardest(tasks: list[TaskStatistics], most: int = 3) -> list[TaskStatistics]:
    """Return the tasks in which the class lost the largest share of the points."""
    return sorted((t for t in tasks if t.reached < 0.9), key=lambda task: task.reached)[:most]


def _alike(message: str) -> str:
    """Return a message's first line without its numbers, so that equal ones are counted."""
    first = message.strip().splitlines()[0]
    return re.sub(r"-?\d+(\.\d+)?(e[+-]?\d+)?", "#", first)[:300]


_STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; margin: 2rem auto; max-width: 60rem; padding: 0 1rem;
 color: #1d2430; background: #fff; }
table { border-collapse: collapse; width: 100%; }
td, th { text-align: left; padding: .35rem .5rem; border-top: 1px solid #dde2ea;
 vertical-align: top; }
td.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.bar { background: #dde2ea; height: .6rem; width: 8rem; border-radius: .3rem; overflow: hidden; }
.bar i { display: block; height: 100%; background: #1a7f4b; }
small { color: #5d6878; overflow-wrap: anywhere; }
"""


def statistics_page(tasks: list[TaskStatistics], notes: list[str]) -> str:
    """Return a page without scripts; notes: sentences on the class."""
    rows = []
    for task in tasks:
        messages = "".join(
            f"<br><small>{count} times: {escape(text)}</small>"
            for text, count in task.messages.most_common(MOST_MESSAGES)
        )
        percent = round(100 * task.reached)
        rows.append(
            f"<tr><td>{escape(task.id)}</td><td>{escape(task.title)}{messages}</td>"
            f'<td><div class="bar"><i style="width: {percent}%"></i></div></td>'
            f'<td class="n">{task.mean:.1f} of {task.max_points}</td>'
            f'<td class="n">{task.full}</td><td class="n">{task.none}</td>'
            f'<td class="n">{len(task.points)}</td></tr>'
        )
    said = "".join(f"<li>{escape(note)}</li>" for note in notes)
    return page_without_scripts(
        "The class",
        _STYLE,
        f"<h1>Where the class stumbled</h1>\n<ul>{said}</ul>\n<table>\n<tr><th>task</th><th></th>"
        "<th></th><th>mean</th><th>full</th><th>zero</th><th>graded</th></tr>\n"
        + "\n".join(rows)
        + "\n</table>",
    )


def page_without_scripts(title: str, style: str, body: str) -> str:
    """Return a page of its own that loads nothing."""
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta http-equiv="Content-Security-Policy"\n'
        " content=\"default-src 'none'; style-src 'unsafe-inline'\">\n"
        f'<meta name="generator" content="botschool grade-all">\n<title>{title}</title>\n'
        f"<style>{style}</style>\n</head>\n<body>\n{body}\n</body>\n</html>\n"
    )
