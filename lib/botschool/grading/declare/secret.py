"""The secret that grading seeds follow from, so that answers cannot be recorded beforehand."""

from __future__ import annotations

import os
import secrets
from pathlib import Path

VARIABLE = "BOTSCHOOL_GRADING_SEED"
"""Of the environment: the instructor's own secret."""
DEFAULT = "botschool"
"""What students grade with."""
FILE = "secret"
"""In the course's state folder: the secret that was made for an instructor without one."""


def grading_secret(state: Path) -> tuple[str, str]:
    """(the secret to grade a class with, a sentence on where it is; "" for the instructor's own).

    state: the folder that keeps it; one that is not there, or cannot be written to, keeps none.
    """
    given = os.environ.get(VARIABLE)
    if given:
        return given, ""
    place = state / FILE
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
            f"{VARIABLE} is not set, and a secret for the grading seeds cannot be kept in {place} "
            f"({error.strerror}): the next grading will use other seeds."
        )
    return made, (
        f"{VARIABLE} is not set: made a secret for the grading seeds and keep it in {place}; "
        "students must not see it."
    )
