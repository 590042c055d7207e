"""Show one more hint each time. An exercise's text ends with its hints, in a comment that pages
leave out: a section `## N.T` with a numbered list for each task.
"""

from __future__ import annotations

import json
import re
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.declare.exercise import folder_of
from botschool.grading.declare.state import make_state, stored
from botschool.lock import alone
from botschool.output import save_bytes
from botschool.paths import HINTS

_SECTION = re.compile(r"^##\s+(?:Task\s+)?(\d+\.\d+)\b", re.IGNORECASE)
_ITEM = re.compile(r"^(\d+)[.)]\s+")


def read_hints(text: str) -> dict[str, list[str]]:
    """Return task -> its hints, from the text of an exercise."""
    text = text.partition(HINTS)[2].partition("\n-->")[0]
    hints: dict[str, list[str]] = {}
    task, fenced = None, False
    for line in text.splitlines():
        fenced ^= line.lstrip().startswith("```")
        heading = None if fenced else _SECTION.match(line)
        if heading:
            task = heading[1]
            hints[task] = []
        elif line.startswith("#") and not fenced:
            task = None
        elif task and not fenced and _ITEM.match(line):
            hints[task].append(_ITEM.sub("", line))
        elif task and hints[task]:
            hints[task][-1] += "\n" + line
    return {task: [_unindented(each) for each in found] for task, found in hints.items()}


def _unindented(hint: str) -> str:
    first, *rest = hint.rstrip().split("\n")
    return "\n".join([first, *(re.sub(r"^ {1,3}", "", line) for line in rest)])


def next_hints(task: str, root: Path) -> tuple[list[str], int, bool]:
    """Return (hints to show now, number of hints, whether the last shown one is new).

    The course folder stores how many hints were shown. Raises BotschoolError.
    """
    path = folder_of(int(task.split(".")[0]), root) / "README.md"
    older = path.with_name("HINTS.md")  # of copies that were made before
    try:
        text = HINTS + older.read_text("utf-8") if older.is_file() else path.read_text("utf-8")
        hints = read_hints(text).get(task)
    except OSError:
        raise BotschoolError(f"Cannot read the hints in {path}: restore the file.") from None
    if not hints:
        raise BotschoolError(f"Task {task} has no hints in {path}.")
    place = _memory(root)
    with alone(place.parent):
        shown = {key: many for key, many in stored(place).items() if type(many) is int and many > 0}
        before = shown.get(task, 0)
        now = min(before + 1, len(hints))
        shown[task] = now
        save_bytes(place, json.dumps(shown, indent=1, sort_keys=True).encode())
    return hints[:now], len(hints), now > before


def _memory(root: Path) -> Path:
    """Return the file that counts the hints shown: in the course folder, or else in the user's."""
    try:
        return make_state(root) / "hints.json"
    except OSError:
        import typer

        folder = Path(typer.get_app_dir("botschool"))
        folder.mkdir(parents=True, exist_ok=True)
        return folder / "hints.json"
