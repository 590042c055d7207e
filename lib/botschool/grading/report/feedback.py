"""Write a student's feedback as a web page: one file without scripts, readable offline and printed.

It shows the student's program, too, and each message beside its line.
"""

from __future__ import annotations

import base64
import re
from collections.abc import Sequence
from html import escape, unescape
from string import Template
from typing import Any

from botschool.grading.declare.exercise import called
from botschool.grading.report.paper import end_of, listing, paper, place_of, runs

MAX_LINES, MOST_BESIDE = 60, 300
"""Lines to show of what a task printed, and letters of a message beside its line."""

_STYLE = """
header { display: flex; justify-content: space-between; align-items: end; gap: 1.5rem;
 flex-wrap: wrap; margin-bottom: 1.5rem; }
header h1 { margin: 0; }
.sum { font-size: 1.9rem; font-weight: 650; white-space: nowrap; }
.sum small { font-size: .6em; font-weight: 400; color: var(--soft); }
.bar { height: .5rem; border-radius: .25rem; background: var(--line); margin: .6rem 0 .9rem;
 overflow: hidden; }
.bar i { display: block; height: 100%; background: var(--good); }
.task { border-top: 1px solid var(--line); padding: .65rem 0; break-inside: avoid-page; }
.line { display: flex; gap: .7rem; align-items: baseline; }
.line .name { flex: 1; }
.mark { width: 1.2rem; font-weight: 700; text-align: center; }
.good { color: var(--good); } .part { color: var(--part); } .none { color: var(--none); }
.number { color: var(--soft); font-variant-numeric: tabular-nums; min-width: 2.6rem;
 white-space: nowrap; }
.points { font-variant-numeric: tabular-nums; white-space: nowrap; }
.why, .task details { margin: .3rem 0 .2rem 1.9rem; }
.why p { margin: .15rem 0; white-space: pre-wrap; }
.problem { border-left: .25rem solid var(--none); padding-left: .8rem; }
.pictures { display: flex; flex-wrap: wrap; gap: 1rem; margin-top: .8rem; }
figure { margin: 0; flex: 1 1 20rem; }
figure img { max-width: 100%; max-height: 40rem; border: 1px solid var(--line);
 border-radius: .5rem; background: #fff; }
figcaption { color: var(--soft); font-size: .85rem; }
.work { border-top: 1px solid var(--line); padding-top: .65rem; }
.code { margin-top: .5rem; }
.code aside { border-left: .25rem solid var(--none); padding: .1rem .7rem; margin: .4rem 0;
 font-size: .85rem; }
.code aside p { margin: .1rem 0; white-space: pre-wrap; }
@media (min-width: 52rem) { .code > :not(.beside) { margin-right: 36%; }
 .beside { display: flex; flex-direction: row-reverse; }
 .beside > div { width: 64%; background: var(--code); }
 .code aside { width: 36%; margin: 0; } }
"""

_BODY = Template("""<header>
<div><div class="soft">Feedback for</div><h1>$student</h1></div>
<div class="sum">$points <small>of $maximum points</small></div>
</header>
$notes$sections""")

_SECTION = Template("""<section>
<div class="head"><h2>$name. $title</h2><b>$points <small>of $maximum</small></b></div>
<div class="bar"><i style="width: $percent%"></i></div>
$problem$notes$banner$tasks$pictures$code
</section>""")

_TASK = Template("""<div class="task">
<div class="line"><span class="mark $kind">$mark</span><span class="number">$id</span>
<span class="name">$title</span><span class="points $kind">$points of $maximum</span></div>
$message$printed</div>
""")


def page(student: str, results: list[dict[str, Any]], notes: Sequence[str] = ()) -> str:
    """Return the page; results: as in batch.Grades, notes: sentences for its head."""
    points, maximum = _points(results), sum(result["max_points"] for result in results)
    body = _BODY.substitute(
        student=escape(student),
        points=points,
        maximum=maximum,
        notes=_notes(notes),
        sections="\n".join(map(_section, results)),
    )
    return paper(f"{student}: {unescape(points)} of {maximum} points", body, _STYLE)


def _notes(notes: Sequence[str]) -> str:
    return "".join(f'<p class="note">{escape(note)}</p>\n' for note in notes)


def _points(results: list[dict[str, Any]]) -> str:
    """Return the sum, or a dash if an exercise was not graded."""
    graded = all(result["graded"] for result in results)
    return f"{sum(float(result['points']) for result in results):g}" if graded else "&ndash;"


def _section(result: dict[str, Any]) -> str:
    problem, banner = result["problem"], result["banner"]
    return _SECTION.substitute(
        name=called(result["exercise"]),
        title=escape(result["title"]),
        points=_points([result]),
        maximum=int(result["max_points"]),
        percent=round(100 * result["points"] / max(1, result["max_points"])),
        problem=f'<p class="problem">{escape(problem)}</p>\n' if problem else "",
        notes=_notes(result.get("notes", ())),
        banner=f'<pre class="problem">{escape(banner)}</pre>\n' if banner else "",
        tasks="" if problem else "".join(map(_task, result["tasks"])),
        pictures=_pictures(result["pictures"]),
        code=_code(result) if result.get("code") else "",
    )


def _code(result: dict[str, Any]) -> str:
    """Return the student's program, each message beside its line; the exercise's text is folded."""
    text, skeleton = result["code"], result["skeleton"]
    beside: dict[int, list[dict[str, Any]]] = {}
    for task in [t for t in result["tasks"] if t["message"] and t["points"] < t["max_points"]]:
        if line := place_of(task, text, skeleton, result["file"].name):
            beside.setdefault(line, []).append(task)
    ends = {line: end_of(text, line) for line in beside}
    parts, until = [], 0
    for first, end, given in runs(text, skeleton, beside, {*ends.values()}):
        parts += ["</div></div>"] if until and first >= until else []
        until = 0 if first >= until else until
        if tasks := beside.get(first):
            said = "".join(
                f"<p><b>{escape(task['id'])}</b> {escape(task['message'][:MOST_BESIDE])}</p>"
                for task in tasks
            )
            parts += ["</div></div>"] if until else []
            parts.append(f'<div class="beside"><aside>{said}</aside><div>')
            until = ends[first]
        parts.append(listing(text, first, end, given))
    parts += ["</div></div>"] if until else []
    shown = " open" if beside else ""
    return (
        f'<details class="work"{shown}><summary>your program</summary>'
        f'<div class="code">{"".join(parts)}</div></details>'
    )


def _task(task: dict[str, Any]) -> str:
    points, maximum = task["points"], int(task["max_points"])
    kind = "good" if points == maximum else "part" if points else "none"
    message = "".join(f"<p>{escape(line)}</p>" for line in task["message"].splitlines())
    return _TASK.substitute(
        kind=kind,
        mark={"good": "&#10003;", "part": "&#9681;", "none": "&#10007;"}[kind],
        id=escape(task["id"]),
        title=escape(task["title"]),
        points=f"{points:g}",
        maximum=maximum,
        message=f'<div class="why">{message}</div>\n' if message else "",
        printed=_printed(task["printed"]),
    )


def _printed(text: str) -> str:
    lines = text.strip("\n").splitlines()
    if not lines:
        return ""
    if len(lines) > MAX_LINES:
        lines = [*lines[:MAX_LINES], f"... and {len(lines) - MAX_LINES} more lines"]
    return (
        "<details><summary>what your code printed</summary>"
        f"<pre>{escape(chr(10).join(lines))}</pre></details>\n"
    )


def _pictures(pictures: list[list[str]]) -> str:
    shown = ""
    for name, content in pictures:
        if not re.fullmatch(r"[A-Za-z0-9+/=]*", content) or not base64.b64decode(content):
            continue
        shown += (
            f'<figure><img alt="{escape(name)}" src="data:image/png;base64,{content}">'
            f"<figcaption>{escape(name)}</figcaption></figure>\n"
        )
    return f'<div class="pictures">\n{shown}</div>' if shown else ""
