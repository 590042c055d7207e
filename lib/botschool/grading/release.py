"""A copy of the repository for students: everything to build and work with, and no answers."""

from __future__ import annotations

import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterable
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.packed import pack
from botschool.grading.skeleton import BEGIN, END, pairs, skeleton
from botschool.sandbox.scratch import remove_tree

RELEASED = (
    "lib", "data", "exercises", "tools", "docs", "tests", "Makefile", "pyproject.toml",
    "constraints.txt", "README.md", "CONTRIBUTING.md", "LICENSE", ".gitignore", ".clang-format",
)  # fmt: skip
"""At the top of the repository; everything else stays (envs/ is what exercise 10 builds)."""
_WITHHELD = re.compile(
    r"tests/course(/|$)|docs/(instructor|answer|solution)|(^|/)(__pycache__|\..*_cache|results)/"
    r"|\.(pyc|so|pyd|dylib|dll|ipynb|egg-info)$|(^|/)(?!\.gitignore$|\.clang-format$)\.[^/]*$",
    re.IGNORECASE,
)
_MIN_LEAK, _TOGETHER = 60, 3
"""Characters, and consecutive lines, of a solution that may not occur in the copy."""


def release(root: Path, target: Path) -> int:
    """Makes the copy, whole or not at all; returns the number of files. Raises BotschoolError."""
    root, target = root.resolve(), target.absolute()
    if not (root / "solutions").is_dir():
        raise BotschoolError(f"{root} holds no solutions: it is a student's copy already.")
    if target.is_symlink() or (target.exists() and not target.is_dir()):
        raise BotschoolError(f"{target} is no folder: name a new one.")
    if target.is_dir() and any(target.iterdir()):
        raise BotschoolError(f"{target} is not empty: name a new folder, or empty this one.")
    for name in (*RELEASED, "solutions"):
        if target.resolve().is_relative_to(root / name):
            raise BotschoolError(f"{target} lies inside the course's {name}: choose another place.")
    files = released_files(root)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        made = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
    except OSError as error:
        raise BotschoolError(f"{target} cannot be made ({error.strerror}).") from None
    try:
        for path in files:
            place = made / path.relative_to(root)
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(path, place)
        for solution, place in pairs(root):
            text = skeleton(solution.read_text(encoding="utf-8"))
            released = made / place.relative_to(root)
            released.parent.mkdir(parents=True, exist_ok=True)
            released.write_text(text, encoding="utf-8", newline="\n")
        for grader in made.glob("exercises/ex[0-9][0-9]_*/test_*.py"):
            text = pack(grader.read_text(encoding="utf-8"))
            grader.write_text(text, encoding="utf-8", newline="\n")
        leaks = find_leaks(root, (path for path in made.rglob("*") if path.is_file()))
        if leaks:
            path, line = leaks[0]
            raise BotschoolError(
                f"{path.relative_to(made)} tells a part of a solution ('{line[:60]}'): nothing was "
                "released; take it out and try again."
            )
        made.chmod(0o755)
        if target.is_dir():
            target.rmdir()
        made.rename(target)
    except BaseException:
        remove_tree(made)
        raise
    return sum(path.is_file() for path in target.rglob("*"))


def released_files(root: Path) -> list[Path]:
    """What is copied; the exercises' own files are generated anew."""
    generated = {place for _, place in pairs(root)}
    return [
        path
        for path in _candidates(root)
        if path.relative_to(root).parts[0] in RELEASED
        and not _WITHHELD.search(path.relative_to(root).as_posix())
        and not path.is_symlink()
        and path.is_file()
        and path not in generated
    ]


def _candidates(root: Path) -> list[Path]:
    """Files that belong to the repository: without what git ignores, where there is git."""
    command = ["git", "-C", str(root), "ls-files", "-z", "--cached", "--others"]
    try:
        done = subprocess.run([*command, "--exclude-standard"], capture_output=True, check=True)
        names = done.stdout.decode(errors="surrogateescape").split("\0")
        return sorted({root / name for name in names if name})
    except (OSError, subprocess.CalledProcessError):
        tops = [root / name for name in RELEASED]
        return sorted(path for top in tops for path in (top, *top.rglob("*")) if path.is_file())


def find_leaks(root: Path, files: Iterable[Path]) -> list[tuple[Path, str]]:
    """(file, line) where a file repeats what only a solution says.

    That is: consecutive lines of a solution region (three, or all if there are fewer) that are
    long enough together, or a long line of a solution's README.
    """
    tales = _tell_tales(root)
    found = []
    for path in files:
        try:
            lines = _lines(path.read_text(encoding="utf-8"))
        except (UnicodeDecodeError, OSError):
            continue
        for at in range(len(lines)):
            for count in (1, 2, _TOGETHER):
                tale = tuple(lines[at : at + count])
                if tale in tales:
                    found.append((path, max(tale, key=len)))
    return found


def _tell_tales(root: Path) -> set[tuple[str, ...]]:
    """Runs of lines that only a solution has."""
    tales = set()
    for solution, _ in pairs(root):
        text = solution.read_text(encoding="utf-8")
        for region in re.findall(rf"{BEGIN}[^\n]*\n(.*?){END}", text, re.DOTALL):
            lines = _lines(region)
            count = min(_TOGETHER, len(lines))
            tales |= {tuple(lines[at : at + count]) for at in range(len(lines) - count + 1)}
        for answers in solution.parent.glob("*.md"):
            lines = _lines(answers.read_text(encoding="utf-8"))
            tales |= {(line,) for line in lines if not line.startswith(("#", "|--"))}
    return {tale for tale in tales if sum(map(len, tale)) >= _MIN_LEAK}


def _lines(text: str) -> list[str]:
    """Lines without their indentation and blanks, empty ones left out."""
    return [" ".join(line.split()) for line in text.splitlines() if line.strip()]
