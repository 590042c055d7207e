"""Runs a finished exercise from beginning to end, in results/exNN, and says what it has made."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.exercise import load_exercise, submission_file
from botschool.paths import course_root


def show(number: int, submission: str | None = None, root: Path | None = None) -> list[Path]:
    """Runs a submission's file (None: the student's own) and returns what it made or changed.

    Raises BotschoolError when the file ends with an error.
    """
    root = (root or course_root()).resolve()
    load_exercise(number, root).require()
    file = submission_file(number, submission, root).resolve()
    folder = root / "results" / f"ex{number:02d}"
    folder.mkdir(parents=True, exist_ok=True)
    before = _stamps(folder)
    variables = {"BOTSCHOOL_COURSE": str(root)}
    if not os.environ.get("DISPLAY"):
        variables["MPLBACKEND"] = "Agg"
    done = subprocess.run([sys.executable, str(file)], cwd=folder, env=os.environ | variables)
    if done.returncode != 0:
        raise BotschoolError(
            f"{file.name} ended with an error, see above; is it finished? 'botschool grade "
            f"{number}' says so."
        )
    return [path for path, stamp in _stamps(folder).items() if before.get(path) != stamp]


def _stamps(folder: Path) -> dict[Path, int]:
    return {path: path.stat().st_mtime_ns for path in sorted(folder.rglob("*")) if path.is_file()}
