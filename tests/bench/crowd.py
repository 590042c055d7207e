"""Grade a class on a busy machine, and compare every point with those of a quiet one.

    python tests/bench/crowd.py [--submissions 100] [--busy 20] [--exercises 1,2,3] [--workers 2]

One solution and one half-done file of each exercise are graded first. Then many submissions, each
with a comment of its own (so none is known, and each has its own grading seeds), are graded by
`grade-all` while busy processes hold the processors. The exit code is 1 if a point differs.
"""

import argparse
import csv
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from botschool.grading.copies.skeleton import skeleton
from botschool.grading.declare.exercise import folder_of, load_exercise

ROOT = Path(__file__).parents[2]
END = "### END SOLUTION"


def main() -> int:
    """Grade quietly, then under load; print what differs."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--submissions", type=int, default=100)
    parser.add_argument("--busy", type=int, default=20)
    parser.add_argument("--exercises", default="1,2,3")
    parser.add_argument("--workers", type=int, default=2)
    options = parser.parse_args()
    numbers = [int(number) for number in options.exercises.split(",")]
    kinds = [(number, half) for number in numbers for half in (False, True)]
    with tempfile.TemporaryDirectory(prefix="crowd") as folder:
        top = Path(folder)
        quiet = graded(top / "quiet", kinds, options)
        print("alone:", *(f"{kind(*k)} {points}" for k, points in zip(kinds, quiet, strict=True)))
        crowd = [kinds[i % len(kinds)] for i in range(options.submissions)]
        busy = [
            subprocess.Popen([sys.executable, "-c", "while True: pass"])
            for _ in range(options.busy)
        ]
        try:
            began, load = time.monotonic(), os.getloadavg()[0]
            found = graded(top / "crowd", crowd, options)
        finally:
            for each in busy:
                each.kill()
    expected = dict(zip(kinds, quiet, strict=True))
    wrong = [
        f"{i} ({kind(*k)}): {points}, alone {expected[k]}"
        for i, (k, points) in enumerate(zip(crowd, found, strict=True))
        if points != expected[k]
    ]
    minutes = (time.monotonic() - began) / 60
    loads = f"load {load:.0f} at the start, {os.getloadavg()[0]:.0f} at the end"
    print(f"{len(crowd)} submissions in {minutes:.1f} min, {loads}: {len(wrong)} differ")
    print(*wrong, sep="\n", end="\n" if wrong else "")
    return 1 if wrong or any(quiet[i] != "100" for i in range(0, len(quiet), 2)) else 0


def kind(number: int, half: bool) -> str:
    """Return what a submission is, in words."""
    return f"{'half' if half else 'solution'} {number}"


def text_of(number: int, half: bool) -> str:
    """Return a solution, or one whose second half is not done."""
    exercise = load_exercise(number, ROOT)
    file = ROOT / "solutions" / folder_of(number, ROOT).name / exercise.file
    text = file.read_text()
    if not half:
        return text
    parts = text.split(END)
    middle = len(parts) // 2
    done = re.sub(r"^ *### BEGIN SOLUTION.*\n", "", END.join(parts[:middle]), flags=re.MULTILINE)
    done = re.sub(rf"^ *{END}.*\n", "", done + END + "\n", flags=re.MULTILINE)
    return skeleton(done + END.join(parts[middle:]).removeprefix("\n"))


def graded(folder: Path, kinds: list[tuple[int, bool]], options: argparse.Namespace) -> list[str]:
    """Grade a class with a submission of each kind; return the points as the table has them."""
    for i, (number, half) in enumerate(kinds):
        place = folder / "class" / f"s{i:03d}"
        place.mkdir(parents=True)
        text = f"{text_of(number, half)}\n# {folder.name} {i}\n"
        (place / load_exercise(number, ROOT).file).write_text(text)
    command = [sys.executable, "-m", "botschool", "grade-all", folder / "class"]
    command += ["-o", folder / "out", "-e", options.exercises, "-w", str(options.workers)]
    environment = os.environ | {"BOTSCHOOL_GRADING_SEED": "a crowd", "BOTSCHOOL_COURSE": str(ROOT)}
    done = subprocess.run([*command, "--fresh"], env=environment, capture_output=True, text=True)
    with open(folder / "out" / "grades.csv", encoding="utf-8-sig", newline="") as file:
        rows = {row["student"]: row for row in csv.DictReader(file)}
    assert len(rows) == len(kinds), done.stdout + done.stderr
    return [rows[f"s{i:03d}"][f"exercise {number}"] for i, (number, _) in enumerate(kinds)]


if __name__ == "__main__":
    sys.exit(main())
