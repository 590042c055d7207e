"""Keep the secret behind the grading seeds, so that nobody can record answers beforehand."""

from __future__ import annotations

import os
import secrets
from pathlib import Path

from botschool.lock import alone

VARIABLE = "BOTSCHOOL_GRADING_SEED"
"""Environment variable with the instructor's own secret."""
DEFAULT = "botschool"
"""The secret for students' own grading."""
FILE = "secret"
"""A file in the course's state folder: the secret made for an instructor without one."""


def grading_secret(state: Path) -> tuple[str, str]:
    """Return (the secret to grade a class with, a sentence on where it is).

    The sentence is "" for the instructor's own secret. state: the folder that keeps the secret; a
    missing or read-only folder keeps none.
    """
    given = os.environ.get(VARIABLE)
    if given:
        return given, ""
    with alone(state):
        return _kept_or_made(state / FILE)


def _kept_or_made(place: Path) -> tuple[str, str]:
    try:
        kept = place.read_text(encoding="utf-8").strip()
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
