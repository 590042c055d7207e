"""Files that repeat what only a solution says."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

from botschool.grading.copies.skeleton import BEGIN, END, pairs

_MIN_LEAK, _TOGETHER = 60, 3
"""Characters, and consecutive lines, of a solution that may not occur elsewhere."""


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
