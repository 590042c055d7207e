"""Decide which courses' graders may run: a grader runs with the user's rights, unconfined.

A folder with exercises/ may be a course, or a student's submission. Three kinds of courses are
trusted: the one that botschool is installed from (a checkout, or a student's copy, after `make`),
the one in BOTSCHOOL_COURSE, and all that the user named with `botschool trust` or made with
`botschool release`.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from shlex import quote

from botschool.errors import BotschoolError
from botschool.lock import alone
from botschool.output import save_bytes
from botschool.paths import material

FILE = "trusted.json"
"""A file in the user's settings folder: the courses that the user trusts."""


def check_trusted(root: Path) -> None:
    """Raise BotschoolError for a course that the user does not trust."""
    root = root.resolve()
    named = os.environ.get("BOTSCHOOL_COURSE")
    if root == material() or (named and root == Path(named).resolve()):
        return
    if str(root) in _trusted():
        return
    way = f"run 'botschool trust {quote(str(root))}'"
    if not _can_be_written():
        way = f"type 'export {_way_out(root)}' (botschool cannot write {_place()})"
    raise BotschoolError(
        f"botschool does not know the course in {root}, and its graders run with all your "
        f"rights: if you trust its author, {way}."
    )


def trust(root: Path) -> None:
    """Remember that the user trusts a course. Raises BotschoolError."""
    place = _place()
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
        with alone(place.parent):
            known = sorted({*_trusted(), str(root.resolve())})
            save_bytes(place, json.dumps(known, indent=1).encode())
    except (OSError, BotschoolError):
        raise BotschoolError(
            f"Cannot write {place}: type 'export {_way_out(root.resolve())}' in each terminal "
            "before you grade."
        ) from None


def _way_out(root: Path) -> str:
    return f"BOTSCHOOL_COURSE={quote(str(root))}"


def _can_be_written() -> bool:
    """Return whether the file, or the nearest folder above it that exists, can be written."""
    place = _place()
    return os.access(next(each for each in (place, *place.parents) if each.exists()), os.W_OK)


def _trusted() -> list[str]:
    """Return the remembered courses; a damaged file counts as empty."""
    try:
        found = json.loads(_place().read_bytes())
    except (OSError, ValueError, RecursionError):
        return []
    return [each for each in found if isinstance(each, str)] if isinstance(found, list) else []


def _place() -> Path:
    import typer

    return Path(typer.get_app_dir("botschool")) / FILE
