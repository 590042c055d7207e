"""Runs a reference solution end to end and says what it has made: `make solution-ex3`."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.exercise import load_exercise
from botschool.paths import course_root


def run_solution(number: int, root: Path | None = None) -> list[Path]:
    """Runs it in results/exNN; returns the files that it made or changed. Raises BotschoolError."""
    root = (root or course_root()).resolve()
    exercise = load_exercise(number, root)
    exercise.require()
    found = sorted(root.glob(f"solutions/ex{number:02d}_*/{exercise.file}"))
    if not found:
        raise BotschoolError(
            f"There is no solution of exercise {number} here: run your own file instead."
        )
    folder = root / "results" / f"ex{number:02d}"
    folder.mkdir(parents=True, exist_ok=True)
    before = _stamps(folder)
    variables = {"MPLBACKEND": "Agg"} if not os.environ.get("DISPLAY") else {}
    code = subprocess.run([sys.executable, str(found[0])], cwd=folder, env=os.environ | variables)
    if code.returncode != 0:
        raise BotschoolError(f"{found[0].relative_to(root)} ended with an error, see above.")
    return [path for path, stamp in _stamps(folder).items() if before.get(path) != stamp]


def _stamps(folder: Path) -> dict[Path, int]:
    return {path: path.stat().st_mtime_ns for path in sorted(folder.rglob("*")) if path.is_file()}


def main() -> None:
    """Argument: the exercise's number."""
    try:
        made = run_solution(int(sys.argv[1]))
    except (BotschoolError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(2)
    for path in made:
        print(f"made: {os.path.relpath(path)}  ({path.stat().st_size / 1000:.0f} kB)")


if __name__ == "__main__":
    main()
