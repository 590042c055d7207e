"""Run the subcommands that make copies of the course."""

from __future__ import annotations

import contextlib
from collections.abc import Sequence
from pathlib import Path
from shlex import quote

from botschool.errors import BotschoolError
from botschool.grading.copies.release import release
from botschool.grading.declare.exercise import course_root, selected
from botschool.paths import MATERIAL, material


def course_command(folder: Path, exercises: str) -> None:
    """Make a copy of the course that the installed botschool grades, or update it."""
    _copy(material(), folder, exercises, compiled=False)
    first = min(selected(exercises, material()))
    print(f"Begin with: cd {quote(str(folder))}; botschool start {first}")


def release_command(
    folder: Path, exercises: str, answers: bool | None, wheels: list[Path], tasks: str = ""
) -> None:
    """Make the students' copy of the repository, or update it; tasks: as in declare/weights.py."""
    root = material() if material().name == MATERIAL else course_root()
    with contextlib.suppress(BotschoolError):
        root = course_root()
    for wheel in wheels:
        if not wheel.is_file() or wheel.suffix != ".whl":
            raise BotschoolError(f"{wheel} is not a wheel: name a file botschool-....whl.")
    _copy(root, folder, exercises, answers=answers, wheels=wheels, tasks=tasks)


def _copy(
    root: Path,
    folder: Path,
    exercises: str,
    answers: bool | None = None,
    compiled: bool = True,
    wheels: Sequence[Path] = (),
    tasks: str = "",
) -> None:
    asked = selected(exercises, root)
    if any(asked.values()):
        raise BotschoolError(f"'{exercises[:30]}' names a task: release works on whole exercises.")
    numbers = None if exercises == "all" else set(asked)
    done = release(root, folder, numbers, answers, compiled=compiled, wheels=wheels, tasks=tasks)
    for path in done.edited:
        print(f"not changed, because it was edited: {path}")
    print(f"{folder}: {done.files} files for students, {done.written} of them new or changed.")
    if done.unknown:
        print(f"botschool could not note that you trust this course. {done.unknown}")
