"""Write a student's feedback as a web page: one file without scripts, readable offline and printed.

The page escapes everything that comes from a submission, and may load nothing.
"""

from __future__ import annotations

import base64
import re
from collections.abc import Sequence
from html import escape
from string import Template
from typing import Any

from botschool.grading.declare.exercise import called

GENERATOR = "botschool grade-all"
MAX_LINES = 60
"""Lines to show of what a task printed."""

_PAGE = Template("""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy"
 content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<meta name="generator" content="$generator">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>$student: $points of $maximum points</title>
<style>
:root { --ink: #1d2430; --soft: #5d6878; --line: #dde2ea; --paper: #f4f6f9; --card: #fff;
 --good: #1a7f4b; --part: #b7791f; --none: #c0392b; --code: #f0f2f6; color-scheme: light dark; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e8ef; --soft: #98a3b5; --line: #333b49;
 --paper: #14181f; --card: #1c222c; --good: #45c486; --part: #e0ab4f; --none: #ef7a6d;
 --code: #262d39; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
 font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, sans-serif; }
main { max-width: 54rem; margin: 0 auto; padding: 2.5rem 1.25rem 4rem; }
header { display: flex; justify-content: space-between; align-items: end; gap: 1.5rem;
 flex-wrap: wrap; margin-bottom: 1.5rem; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0; overflow-wrap: anywhere; }
h2 { font-size: 1.2rem; margin: 0; }
.soft { color: var(--soft); }
.sum { font-size: 1.9rem; font-weight: 650; white-space: nowrap; }
.sum small, h2 + b small { font-size: .6em; font-weight: 400; color: var(--soft); }
section { background: var(--card); border: 1px solid var(--line); border-radius: .75rem;
 padding: 1.25rem 1.4rem; margin: 1.1rem 0; }
.head { display: flex; justify-content: space-between; align-items: baseline; gap: 1rem; }
.head b { font-size: 1.2rem; white-space: nowrap; }
.bar { height: .5rem; border-radius: .25rem; background: var(--line); margin: .6rem 0 .9rem;
 overflow: hidden; }
.bar i { display: block; height: 100%; background: var(--good); }
.task { border-top: 1px solid var(--line); padding: .65rem 0; }
.line { display: flex; gap: .7rem; align-items: baseline; }
.line .name { flex: 1; overflow-wrap: anywhere; }
.mark { width: 1.2rem; font-weight: 700; text-align: center; }
.good { color: var(--good); } .part { color: var(--part); } .none { color: var(--none); }
.number { color: var(--soft); font-variant-numeric: tabular-nums; width: 2.6rem; }
.points { font-variant-numeric: tabular-nums; white-space: nowrap; }
.why { margin: .3rem 0 .2rem 1.9rem; overflow-wrap: anywhere; }
.why p { margin: .15rem 0; }
details { margin: .35rem 0 .2rem 1.9rem; color: var(--soft); }
summary { cursor: pointer; }
pre { background: var(--code); color: var(--ink); border-radius: .5rem; padding: .7rem .9rem;
 margin: .4rem 0; white-space: pre-wrap; overflow-wrap: anywhere;
 font: .85rem/1.45 ui-monospace, "SF Mono", Menlo, Consolas, monospace; }
.problem { border-left: .25rem solid var(--none); padding-left: .8rem; overflow-wrap: anywhere; }
.note { border-left: .25rem solid var(--part); padding-left: .8rem; margin: .5rem 0;
 overflow-wrap: anywhere; }
.pictures { display: flex; flex-wrap: wrap; gap: 1rem; margin-top: .8rem; }
figure { margin: 0; flex: 1 1 20rem; }
figure img { max-width: 100%; max-height: 40rem; border: 1px solid var(--line);
 border-radius: .5rem; background: #fff; }
figcaption { color: var(--soft); font-size: .85rem; overflow-wrap: anywhere; }
@media print { body { background: none; } section { break-inside: avoid-page; } }
</style>
</head>
<body>
<main>
<header>
<div><div class="soft">Feedback for</div><h1>$student</h1></div>
<div class="sum">$points <small>of $maximum points</small></div>
</header>
$notes$sections
</main>
</body>
</html>
""")

_SECTION = Template("""<section>
<div class="head"><h2>$name. $title</h2><b>$points <small>of $maximum</small></b></div>
<div class="bar"><i style="width: $percent%"></i></div>
$problem$notes$banner$tasks$pictures
</section>""")

_TASK = Template("""<div class="task">
<div class="line"><span class="mark $kind">$mark</span><span class="number">$id</span>
<span class="name">$title</span><span class="points $kind">$points of $maximum</span></div>
$message$printed</div>
""")


def page(student: str, results: list[dict[str, Any]], notes: Sequence[str] = ()) -> str:
    """Return the page; results: as in batch.Grades, notes: sentences for its head."""
    return _PAGE.substitute(
        generator=GENERATOR,
        student=escape(student),
        points=_points(results),
        maximum=sum(result["max_points"] for result in results),
        notes=_notes(notes),
        sections="\n".join(map(_section, results)),
    )


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
