"""Measure what somebody waits for who installs a wheel in an empty folder.

    python tests/bench/wheel.py dist/*.whl [--python python3.11 --python python3.12 ...]

For each Python there must be a wheel. The script makes an environment and installs the wheel with
pip, which takes packages from its cache or the network. Then it makes a course, evolves, writes a
replay and grades an exercise. It prints seconds by the clock and megabytes.
"""

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from report import REPOSITORY, Table

EXERCISE, FILE = "ex03_evolution_strategy", "evolution_strategy.py"
EVOLVE = ["es", "-f", "acrobot.ini", "-s", "1", "-o", "run"]
STEPS = [
    ("course", ["course", "course"]),
    ("evolve, 20 M steps", EVOLVE),
    ("replay", [*EVOLVE, "-p", "-g", "run/bestgS1.npy", "--replay", "replay.html"]),
    ("task 3.1", ["grade", "3.1"]),
    ("exercise 3", ["grade", "3"]),
]


def main() -> None:
    """Print a row for each Python."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("wheels", nargs="+", type=Path)
    parser.add_argument("--python", action="append", default=[])
    parser.add_argument("--markdown", action="store_true")
    options = parser.parse_args()
    columns = ["Python", "wheel, MB", "install", "installed, MB", *(name for name, _ in STEPS)]
    about = (
        "Seconds by the clock, MB = 10^6 bytes. 'install' is an environment and pip with its cache "
        "full; 'installed' counts the wheel and all packages that it needs, without pip. To the "
        "first graded point: install, course, task 3.1."
    )
    table = Table("From a wheel in an empty folder", about, [*columns, "first point"])
    for python in options.python or [sys.executable]:
        table.add(*measured(python, options.wheels))
    table.show(options.markdown)


def measured(python: str, wheels: list[Path]) -> list[str]:
    """Return the row of a Python: install, use, measure."""
    code = "import sys; print(f'{sys.version_info[0]}.{sys.version_info[1]}')"
    version = subprocess.run([python, "-c", code], capture_output=True, text=True).stdout.strip()
    tag = f"-cp{version.replace('.', '')}-"
    (wheel,) = [path for path in wheels if tag in path.name]
    with tempfile.TemporaryDirectory(prefix="wheel") as folder:
        top = Path(folder)
        began = time.perf_counter()
        run([python, "-m", "venv", top / "venv"], top)
        before = size(top / "venv")
        run([top / "venv/bin/python", "-m", "pip", "install", "-q", wheel.resolve()], top)
        seconds = [time.perf_counter() - began]
        installed = size(top / "venv") - before
        for name, arguments in STEPS:
            inside = top if name == "course" else top / "course"
            began = time.perf_counter()
            run([top / "venv/bin/botschool", *arguments], inside)
            seconds.append(time.perf_counter() - began)
            if name == "course":
                solution = REPOSITORY / "solutions" / EXERCISE / FILE
                (top / "course/exercises" / EXERCISE / FILE).write_bytes(solution.read_bytes())
    first = seconds[0] + seconds[1] + seconds[4]
    megabytes = [f"{wheel.stat().st_size / 1e6:.1f}", f"{installed / 1e6:.0f}"]
    times = [f"{each:.1f}" for each in seconds]
    return [version, megabytes[0], times[0], megabytes[1], *times[1:], f"{first:.1f}"]


def size(folder: Path) -> int:
    """Return the bytes of all files in a folder."""
    return sum(path.stat().st_size for path in folder.rglob("*") if path.is_file())


def run(command: list, folder: Path) -> None:
    """Call a program away from the checkout; stop with its output if it fails."""
    environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "VIRTUAL_ENV")}
    command = [str(part) for part in command]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(command)} fails:\n{done.stdout[-3000:]}{done.stderr[-3000:]}")


if __name__ == "__main__":
    main()
