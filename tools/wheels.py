"""Build wheels into dist, and try each: `make wheels`, or `make wheels PYTHONS="3.11 3.12"`.

The wheel of Python 3.12 is for all later ones, too (the stable ABI); each earlier one has its own.
Interpreters are those on the path, pyenv's, or what uv gets. A Python that cannot be had is left
out with a sentence. A wheel is tried, away from the checkout, in a new environment of each Python
that is here and that its tags are for.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
DIST = ROOT / "dist"
EVERY, STABLE = ("3.10", "3.11", "3.12", "3.13", "3.14"), "3.12"
"""Pythons to build for or to try with; the first one that the stable ABI's wheel is for."""
UV = (
    shutil.which("uv", path=f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    or "uv"
)


def number(version: str) -> int:
    """Return 12 of "3.12"."""
    return int(version.partition(".")[2])


def interpreter(version: str) -> str:
    """Return a Python of this version; "" if there is none and none can be had."""
    candidates: list[str | Path | None] = [shutil.which(f"python{version}")]
    versions = Path(os.environ.get("PYENV_ROOT") or Path.home() / ".pyenv", "versions")
    candidates += sorted(versions.glob(f"{version}.*/bin/python{version}"))
    for candidate in filter(None, candidates):
        ask = [candidate, "-c", "import sys; print('%d.%d' % sys.version_info[:2])"]
        if subprocess.run(ask, capture_output=True, text=True).stdout.strip() == version:
            return str(candidate)
    subprocess.run([UV, "python", "install", "-q", version], capture_output=True)
    find = [UV, "python", "find", "--managed-python", version]
    return subprocess.run(find, capture_output=True, text=True).stdout.strip()


def built(python: str, version: str) -> Path:
    """Build and return the wheel. Exits with the compiler's words, or if its tags are wrong."""
    with tempfile.TemporaryDirectory() as folder:
        command = [UV, "build", "-q", "--wheel", "--python", python, "-o", folder, str(ROOT)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"error: no wheel for Python {version}:\n{done.stderr[-2000:]}")
        (made,) = Path(folder).glob("*.whl")
        own = f"cp3{number(version)}"
        wanted = f"{own}-abi3" if version == STABLE else f"{own}-{own}"
        if f"-{wanted}-" not in made.name:
            sys.exit(f"error: {made.name} should have the tags {wanted}.")
        DIST.mkdir(exist_ok=True)
        return made.replace(DIST / made.name)


def serves(wheel: Path, version: str) -> bool:
    """Return whether a wheel's tags are for a version of Python."""
    tags = re.search(r"-cp3(\d+)-(\w+)-", wheel.name)
    later = tags[2] == "abi3" and number(version) >= int(tags[1])
    return later or number(version) == int(tags[1])


def tried(wheel: Path, python: str) -> str:
    """Return "" if a wheel works in a new environment, else the command's last line."""
    with tempfile.TemporaryDirectory() as folder:
        new, own = Path(folder, "new"), [UV, "pip", "install", "-q", "--python"]
        commands = [
            [UV, "venv", "-q", "--python", python, new],
            [*own, new / "bin" / "python", "-c", ROOT / "constraints.txt", wheel],
            [new / "bin" / "botschool", "es", "-f", "acrobot.ini", "-s", "1", "--steps", "20000"],
        ]
        for command in commands:
            done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
            if done.returncode:
                return f"{command[0]} {command[1]}: {done.stderr.strip().splitlines()[-1]}"
    return ""


def main() -> None:
    """Build for the versions that the arguments name, and try what has been built."""
    asked = [*filter(None, " ".join(sys.argv[1:]).split())] or [*EVERY]
    if unknown := [version for version in asked if version not in EVERY]:
        sys.exit(f"error: '{unknown[0]}' is not one of the Pythons {', '.join(EVERY)}.")
    pythons = {version: interpreter(version) for version in EVERY}
    wheels, failed = [], False
    for version in asked:
        if not pythons[version]:
            print(f"No Python {version} here: no wheel is built for it or tried with it.")
        elif number(version) <= number(STABLE):
            wheels.append(built(pythons[version], version))
            print(f"made: {wheels[-1].relative_to(ROOT)}", flush=True)
    for wheel in wheels:
        for version in (each for each in EVERY if pythons[each] and serves(wheel, each)):
            problem = tried(wheel, pythons[version])
            failed |= bool(problem)
            print(f"Python {version}: {problem or 'the wheel works'}  {wheel.name}", flush=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
