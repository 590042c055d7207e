"""Frame pages for instructors and students: without scripts, for phones, dark screens and paper.

A page escapes everything that comes from a submission, and loads nothing.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Collection, Iterator
from html import escape

GENERATOR = "botschool grade-all"
FOLDED, MOST_LINES, MOST_LETTERS = 4, 3000, 500
"""Lines of the exercise that are shown one by one; lines of a program, and letters of a line."""

_STYLE = """
:root { --ink: #1d2430; --soft: #5d6878; --line: #dde2ea; --paper: #f4f6f9; --card: #fff;
 --good: #1a7f4b; --part: #b7791f; --none: #c0392b; --code: #f0f2f6; --mark: #ffe9a8;
 color-scheme: light; }
@media screen and (prefers-color-scheme: dark) { :root { --ink: #e4e8ef; --soft: #98a3b5;
 --line: #333b49; --paper: #14181f; --card: #1c222c; --good: #45c486; --part: #e0ab4f;
 --none: #ef7a6d; --code: #262d39; --mark: #5a4a17; color-scheme: dark; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink); overflow-wrap: anywhere;
 font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, sans-serif; }
main { max-width: 66rem; margin: 0 auto; padding: 2rem 1.25rem 4rem; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .6rem; }
h2 { font-size: 1.2rem; margin: 0; }
a { color: inherit; }
.soft { color: var(--soft); }
section { background: var(--card); border: 1px solid var(--line); border-radius: .75rem;
 padding: 1.1rem 1.4rem; margin: 1.1rem 0; }
.head { display: flex; justify-content: space-between; align-items: baseline; gap: 1rem; }
.head b { font-size: 1.2rem; white-space: nowrap; }
.head small { font-size: .6em; font-weight: 400; color: var(--soft); }
.note { border-left: .25rem solid var(--part); padding-left: .8rem; margin: .5rem 0; }
summary { cursor: pointer; color: var(--soft); }
pre { background: var(--code); border-radius: .5rem; padding: .7rem .9rem; margin: .4rem 0;
 white-space: pre-wrap; font: .85rem/1.45 ui-monospace, "SF Mono", Menlo, Consolas, monospace; }
.lines { padding: .1rem .6rem; margin: 0; border-radius: 0; font-size: .8rem; }
.lines > * { display: grid; grid-template-columns: 2.6rem minmax(0, 1fr); min-height: 1.45em; }
.lines i { color: var(--soft); font-style: normal; user-select: none; }
.lines mark { background: var(--mark); color: inherit; }
details.given { background: var(--code); padding: .1rem .6rem; font-size: .8rem; }
@media (max-width: 40rem) { main { padding: 1rem .7rem 2rem; } section { padding: .8rem .9rem; }
 .lines > * { grid-template-columns: 2rem minmax(0, 1fr); } h1 { font-size: 1.5rem; } }
@media print { body { background: none; font-size: 10pt; } main { max-width: none; padding: 0; }
 section { border: 0; border-top: 1px solid #999; border-radius: 0; padding: .6rem 0; margin: 0; }
 details:not(.given)::details-content { content-visibility: visible; }
 * { print-color-adjust: exact; -webkit-print-color-adjust: exact; } }
"""


def paper(title: str, body: str, style: str = "", scripts: bool = False) -> str:
    """Return a page of its own; title: as plain text, body: as HTML.

    scripts: let those run that the page itself holds, as replays do.
    """
    scripted = "; script-src 'unsafe-inline'" if scripts else ""
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta http-equiv="Content-Security-Policy"\n'
        " content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'"
        f'{scripted}">\n'
        f'<meta name="generator" content="{GENERATOR}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{escape(title)}</title>\n<style>{_STYLE}{style}</style>\n</head>\n"
        f"<body>\n<main>\n{body}\n</main>\n</body>\n</html>\n"
    )


def runs(
    text: str, skeleton: str, shown: Collection[int] = (), cuts: Collection[int] = ()
) -> Iterator[tuple[int, int, bool]]:
    """Yield (first line, line after the last, whether the exercise gave them) of a program.

    Lines count from 1. A run ends before each line of `shown`, which counts as the student's, and
    before each of `cuts`.
    """
    lines = text.splitlines()[:MOST_LINES]
    given = [False] * len(lines)
    same = difflib.SequenceMatcher(None, skeleton.splitlines(), lines, autojunk=False)
    for block in same.get_matching_blocks():
        if block.size > FOLDED:
            given[block.b : block.b + block.size] = [True] * block.size
    for line in shown:
        given[line - 1 : line] = [False] * len(given[line - 1 : line])
    start = 0
    for at in range(1, len(lines) + 1):
        if at == len(lines) or given[at] != given[start] or at + 1 in {*shown, *cuts}:
            yield start + 1, at + 1, given[start]
            start = at


def listing(
    text: str, first: int, end: int, given: bool = False, marked: frozenset[int] = frozenset()
) -> str:
    """Return lines of a program with their numbers; those that the exercise gave are folded."""
    shown = []
    for number, line in enumerate(text.splitlines()[first - 1 : end - 1], first):
        tag = "mark" if number in marked else "span"
        shown.append(
            f"<{tag}><i>{number}</i><span>{escape(line[:MOST_LETTERS]) or ' '}</span></{tag}>"
        )
    made = f'<pre class="lines">{"".join(shown)}</pre>'
    if given:
        about = f"{end - first} lines of the exercise"
        return f'<details class="given"><summary>{about}</summary>{made}</details>'
    return made


def place_of(task: dict, text: str, skeleton: str, name: str) -> int | None:
    """Return the line of a program that a task's message is about.

    It is the line that the message names, or that of the task's first function.
    """
    count = text.count("\n") + 1
    if found := re.search(rf"{re.escape(name)}:(\d+)", task["message"]):
        return int(found[1]) if 1 <= int(found[1]) <= count else None
    before, undone, _ = skeleton.partition(f'NotImplementedError("task {task["id"]}:')
    names = re.findall(r"^ *def (\w+)", before, re.MULTILINE)[-1:] if undone else []
    names += re.findall(r"\b(\w+)\(", task["message"])
    for each in names:
        head = rf"^[ \t]*(?:async )?def {re.escape(each)}\b"
        if starts := [match.start() for match in re.finditer(head, text, re.MULTILINE)]:
            return text.count("\n", 0, starts[-1]) + 1  # the last definition counts
    return None


def end_of(text: str, line: int) -> int:
    """Return the line after the function that a line of a program is in."""
    lines = text.splitlines()
    for number in range(line + 1, len(lines) + 1):
        if re.match(r"def |async def |class |@|if |# ?%%", lines[number - 1]):
            return number
    return len(lines) + 1
