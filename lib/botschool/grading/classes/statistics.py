"""Show where a class lost points: points, their spread and the frequent mistakes of each task."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from html import escape
from statistics import median, quantiles
from typing import Any
from urllib.parse import quote

from botschool.grading.judge.sentence import TOLD
from botschool.grading.report.paper import paper

MOST_MISTAKES = 5
"""Mistakes of a task on the page."""


@dataclass
class TaskStatistics:
    """A class's points in a task."""

    id: str
    title: str
    max_points: int
    points: list[float] = field(default_factory=list)
    mistakes: dict[str, list[tuple[str, str, str]]] = field(default_factory=dict)
    """A mistake -> (student, feedback page, message) of all who made it."""

    @property
    def mean(self) -> float:
        return sum(self.points) / len(self.points) if self.points else 0.0

    @property
    def middle(self) -> tuple[float, float]:
        """Return the quartiles: half of the class lies between them."""
        points = self.points if len(self.points) > 1 else 2 * self.points
        low, _, high = quantiles(points, n=4, method="inclusive")
        return low, high

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


def by_task(
    people: Iterable[tuple[str, str, Iterable[dict[str, Any]]]],
) -> list[TaskStatistics]:
    """Return the points of each task, from submitted and graded results; in order of tasks.

    people: name, feedback page and results of each.
    """
    found: dict[str, TaskStatistics] = {}
    for student, page, results in people:
        for result in results:
            if not result["graded"] or result["problem"]:
                continue
            for task in result["tasks"]:
                one = found.setdefault(
                    task["id"], TaskStatistics(task["id"], task["title"], task["max_points"])
                )
                one.points.append(task["points"])
                if task["points"] < task["max_points"] and (told := task["message"].strip()):
                    empty = not result.get("code", told).strip()
                    what = "the file is empty" if empty else _kind(mistake(told))
                    one.mistakes.setdefault(what, []).append((student, page, told))
    return list(found.values())


def hardest(tasks: list[TaskStatistics], most: int = 3) -> list[TaskStatistics]:
    """Return the tasks in which the class lost the largest share of the points."""
    return sorted((t for t in tasks if t.reached < 0.9), key=lambda task: task.reached)[:most]


def mistake(message: str) -> str:
    """Return what is wrong: the cause, if the message has found it, else its first line."""
    lines = message.splitlines()
    if named := [line for line in lines if line.startswith(TOLD)]:
        return named[0][len(TOLD) :].strip()[:300]
    return NOT_DONE if lines[0].startswith(NOT_DONE) else lines[0][:300]


NOT_DONE = "not done yet"


def _kind(what: str) -> str:
    """Return the words by which equal mistakes are counted: without numbers."""
    return re.sub(r"-?\d+(\.\d+)?(e[+-]?\d+)?", "#", what)


_STYLE = """
.what { display: grid; grid-template-columns: minmax(0, 1fr) 9rem; gap: .2rem 1.2rem; }
.what p, .what ul { margin: .3rem 0; }
.what ul { grid-column: 1 / -1; padding: 0; margin-bottom: 0; list-style: none; }
.what li { border-top: 1px solid var(--line); padding: .35rem 0; }
.what summary { color: inherit; }
svg { width: 9rem; height: 4.2rem; fill: var(--good); }
svg text { fill: var(--soft); font: 9px system-ui, sans-serif; text-anchor: middle; }
@media print { section { break-inside: avoid-page; } }
"""
_BINS = ("0", "", "", "", "", "all")
"""Labels of a histogram's columns: no points, four quarters, all points."""


def statistics_page(tasks: list[TaskStatistics], notes: list[str]) -> str:
    """Return a page without scripts; notes: sentences on the class."""
    said = "".join(f"<li>{escape(note)}</li>" for note in notes)
    body = "".join(map(_section, tasks))
    return paper("The class", f"<h1>Where the class stumbled</h1>\n<ul>{said}</ul>\n{body}", _STYLE)


def _section(task: TaskStatistics) -> str:
    count, low, high = len(task.points), *task.middle
    wrong = sorted(task.mistakes.items(), key=lambda each: (-len(each[1]), each[0]))
    items = ""
    for what, examples in wrong[:MOST_MISTAKES]:
        student, page, message = examples[0]
        first = mistake(message)
        if what == _kind(first):
            alike = len({mistake(each[2]) for each in examples}) > 1
            what = f"{first} (or with other numbers)" if alike else first
        link = f'<a href="feedback/{quote(page)}">{escape(student)}</a>'
        items += (
            f"<li><details><summary><b>{len(examples)} of {count}</b>: {escape(what)}</summary>"
            f"<p>For example {link}:</p><pre>{escape(message)}</pre></details></li>"
        )
    if others := sum(len(examples) for _, examples in wrong[MOST_MISTAKES:]):
        items += f"<li>{others} of {count}: other mistakes</li>"
    return (
        f'<section><div class="head"><h2>{escape(task.id)} {escape(task.title)}</h2>'
        f"<b>{task.mean:.1f} <small>of {task.max_points}</small></b></div>"
        f'<div class="what"><p>Median {median(task.points):g}, the middle half from {low:g} to '
        f"{high:g}. {task.full} of {count} have all points, {task.none} have none.</p>"
        f"{_histogram(task)}<ul>{items}</ul></div></section>\n"
    )


def _histogram(task: TaskStatistics) -> str:
    """Return a small picture of how many have no points, a share in each quarter, and all."""
    most, counts = task.max_points or 1, [0] * len(_BINS)
    for each in task.points:
        share = each / most
        counts[0 if share <= 0 else 5 if share >= 1 else 1 + int(4 * share)] += 1
    bars = ""
    for at, (count, label) in enumerate(zip(counts, _BINS, strict=True)):
        height = 40 * count / max(counts)
        bars += (
            f'<rect x="{24 * at + 2}" y="{54 - height:.1f}" width="20" height="{height + 1:.1f}"/>'
            f'<text x="{24 * at + 12}" y="{50 - height:.1f}">{count or ""}</text>'
            f'<text x="{24 * at + 12}" y="66">{label}</text>'
        )
    return f'<svg viewBox="0 0 144 68" role="img" aria-label="points: {counts}">{bars}</svg>'
