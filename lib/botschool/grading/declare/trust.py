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
    raise BotschoolError(
        f"botschool does not know the course in {root}, and its graders run with all your "
        f"rights: if you trust its author, run 'botschool trust {quote(str(root))}'."
    )


def trust(root: Path) -> None:
    """Remember that the user trusts a course. Raises BotschoolError."""
    place = _place()
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise BotschoolError(
            f"Cannot write {place} ({error.strerror}): change its permissions."
        ) from None
    known = sorted({*_trusted(), str(root.resolve())})
    save_bytes(place, json.dumps(known, indent=1).encode())


def _trusted() -> list[str]:
    """Return the remembered courses; a damaged file counts as empty."""
    try:
        found = json.loads(_place().read_bytes())
    except (OSError, ValueError):
        return []
    return [each for each in found if isinstance(each, str)] if isinstance(found, list) else []


def _place() -> Path:
    import typer

    return Path(typer.get_app_dir("botschool")) / FILE
