"""What a solution's README measured, for students who have all points: packed into their copy."""

from __future__ import annotations

import base64
import zlib
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.declare.exercise import folder_of, load_exercise
from botschool.grading.report.stored import recall

PACKED = "ANSWERS.packed"
"""In an exercise's folder of the copy, if the instructor allows it."""


def pack_answers(text: str) -> str:
    """The text so that nobody reads it by accident."""
    packed = base64.b85encode(zlib.compress(text.encode(), 9)).decode()
    return "\n".join(packed[at : at + 90] for at in range(0, len(packed), 90)) + "\n"


def unpack_answers(packed: str) -> str:
    """The text again. Raises ValueError or zlib.error."""
    return zlib.decompress(base64.b85decode("".join(packed.split()))).decode()


def answers(number: int, root: Path) -> str:
    """What is shown after full marks, as Markdown.

    Raises BotschoolError where it is not there, or when the student's file, as it was last
    graded, has not all points.
    """
    exercise, folder = load_exercise(number, root), folder_of(number, root)
    packed, plain = folder / PACKED, root / "solutions" / folder.name / "README.md"
    if not packed.is_file() and not plain.is_file():
        raise BotschoolError(
            f"The answers to exercise {number} are not in this copy: your instructor gives them."
        )
    tasks = (recall(root, exercise) or ([],))[0]
    points = sum(task["points"] for task in tasks)
    maximum = sum(task.max_points for task in exercise.tasks)
    if points < maximum:
        raise BotschoolError(
            f"The answers to exercise {number} are shown when 'botschool grade {number}' has given "
            f"you all points; so far it has given {points} of {maximum}."
        )
    try:
        if packed.is_file():
            return unpack_answers(packed.read_text(encoding="ascii"))
        return plain.read_text(encoding="utf-8")
    except (OSError, ValueError, zlib.error):
        raise BotschoolError(f"{packed} is damaged: ask for the file anew.") from None
