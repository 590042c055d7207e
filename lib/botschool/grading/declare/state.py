"""Keep what commands store in a course, and the secret behind the grading seeds there.

Nobody can record answers beforehand whose inputs follow from a secret.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import json
import os
import secrets
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.lock import alone
from botschool.sandbox.inside import read_inside

STATE = ".botschool"
"""A folder in the course in which the commands store data."""
MAX_STORED = 2**20
"""Bytes of a file in it that is read again."""
VARIABLE = "BOTSCHOOL_GRADING_SEED"
"""Environment variable with the instructor's own secret."""
DEFAULT = "botschool"
"""The secret for students' own grading."""
LEAST = 16
"""Characters of a secret: fewer can be found by trying."""
FILE = "secret"
"""A file in the course's state folder: the secret made for an instructor without one."""


def grading_secret(state: Path) -> tuple[str, str]:
    """Return (the secret to grade a class with, a sentence on where it is).

    The sentence is "" for the instructor's own secret. state: the folder that keeps the secret; a
    missing or read-only folder keeps none.
    """
    if given := given_secret():
        return given, ""
    with alone(state):
        return _kept_or_made(state / FILE)


def given_secret() -> str:
    """Return the instructor's own secret; "" if there is none. Raises BotschoolError."""
    return _long_enough(os.environ.get(VARIABLE, ""), VARIABLE)


def _long_enough(secret: str, place: str) -> str:
    if secret and secret != DEFAULT and len(secret) < LEAST:
        raise BotschoolError(
            f"The secret in {place} has {len(secret)} characters, so it can be found by trying: "
            f"take {LEAST} or more. This makes one: python3 -c 'import secrets; "
            "print(secrets.token_hex(16))'."
        )
    return secret


@functools.cache
def slow_key(secret: str) -> str:
    """Return what seeds follow from: each try to guess the secret takes some 50 ms."""
    if secret == DEFAULT:
        return secret
    return hashlib.scrypt(secret.encode(), salt=b"botschool", n=2**14, r=8, p=1, dklen=32).hex()


def _kept_or_made(place: Path) -> tuple[str, str]:
    try:
        kept = _long_enough(place.read_text(encoding="utf-8").strip(), str(place))
        if kept:
            return kept, f"Grading seeds follow from the secret in {place}."
    except (OSError, UnicodeDecodeError):
        pass
    made = secrets.token_hex(16)
    try:
        with open(os.open(place, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "w") as file:
            file.write(f"{made}\n")
    except OSError as error:
        return made, (
            f"{VARIABLE} is not set, and {place} cannot keep a secret for the grading seeds "
            f"({error.strerror}): the next grading will use other seeds."
        )
    return made, (
        f"{VARIABLE} is not set: botschool made a secret for the grading seeds and keeps it "
        f"in {place}; do not show it to students."
    )


def make_state(root: Path) -> Path:
    """Make and return the folder in which the commands store data. Raises OSError if that fails."""
    folder = root / STATE
    if not folder.is_dir():
        folder.mkdir(exist_ok=True)
        (folder / ".gitignore").write_text("*\n")
    if not os.access(folder, os.W_OK):
        raise PermissionError(f"no permission to write in {folder}")
    return folder


def stored(place: Path) -> dict[str, Any]:
    """Return the stored data of a command; a missing or damaged file counts as empty."""
    with contextlib.suppress(OSError, ValueError, RecursionError):
        found = json.loads(read_inside(place.parent, place.name, MAX_STORED))
        return found if isinstance(found, dict) else {}
    return {}


def secret_for_others(root: Path) -> tuple[str, str]:
    """Return the secret to grade other people's work with, and a sentence on where it is kept."""
    try:
        return grading_secret(make_state(root))
    except OSError:
        return grading_secret(root / STATE)
