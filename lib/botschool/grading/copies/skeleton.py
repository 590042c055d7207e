"""Generate skeletons for students from the solutions, and find files that repeat a solution."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.output import save_bytes

BEGIN, END = "### BEGIN SOLUTION", "### END SOLUTION"
GENERATED = ".skeletons.json"
"""In exercises/: the digest of every generated skeleton, to recognise edited ones."""


def skeleton(solution: str) -> str:
    """Return the text of a solution file with every solution region replaced.

    `### BEGIN SOLUTION task 3.2: rank the population` ... `### END SOLUTION` becomes
    `raise NotImplementedError("task 3.2: rank the population")`. Raises ValueError for regions that
    are nested, open or without a task.
    """
    lines, inside = [], False
    for number, line in enumerate(solution.splitlines(), 1):
        if BEGIN in line:
            found = re.fullmatch(rf"(\s*){BEGIN} (task \d+\.\d+: .+)", line)
            if inside or not found:
                raise ValueError(f"line {number}: write '{BEGIN} task N.T: what to do' here")
            lines.append(f'{found[1]}raise NotImplementedError("{found[2]}")')
            inside = True
        elif END in line:
            if not inside:
                raise ValueError(f"line {number}: '{END}' without a beginning")
            inside = False
        elif not inside:
            lines.append(line)
    if inside:
        raise ValueError("the last solution region is not closed")
    return "\n".join(lines) + "\n"


def pairs(root: Path) -> list[tuple[Path, Path]]:
    """Return (solution, skeleton) files of every exercise."""
    found = sorted(root.glob("solutions/ex[0-9][0-9]_*/*.py"))
    return [(path, root / "exercises" / path.relative_to(root / "solutions")) for path in found]


def write_skeletons(root: Path) -> list[Path]:
    """Write every skeleton that is missing or unedited; return the edited ones.

    The function never touches a file that a student has edited.
    """
    folder = root / "exercises"
    texts = {to.relative_to(folder).as_posix(): _generate(solution) for solution, to in pairs(root)}
    return write_unedited(folder, texts, folder / GENERATED)


def write_unedited(folder: Path, texts: dict[str, str], generated: Path) -> list[Path]:
    """Write texts under their paths in a folder; return the files that somebody has edited.

    generated: the file with the digest of every text that was written. Raises BotschoolError.
    """
    try:
        digests = json.loads(generated.read_text())
    except FileNotFoundError:
        digests = {}
    except ValueError:
        raise BotschoolError(f"{generated} is damaged: remove it, then run this again.") from None
    edited = []
    for name, text in texts.items():
        target = folder / name
        present = target.read_text(encoding="utf-8") if target.exists() else text
        if present != text and _digest(present) != digests.get(name):
            edited.append(target)
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        save_bytes(target, text.encode())
        digests[name] = _digest(text)
    save_bytes(generated, (json.dumps(digests, indent=1, sort_keys=True) + "\n").encode())
    return edited


def _generate(solution: Path) -> str:
    try:
        return skeleton(solution.read_text(encoding="utf-8"))
    except ValueError as error:
        raise BotschoolError(f"{solution} cannot become a skeleton: {error}.") from None


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


_MIN_LEAK, _TOGETHER = 60, 3
"""Characters, and consecutive lines, of a solution that no other file may contain."""


def find_leaks(root: Path, files: Iterable[Path]) -> list[tuple[Path, str]]:
    """Return (file, line) for each file that repeats what only a solution says.

    That is: consecutive lines of a solution region (three, or all if there are fewer) that are long
    enough together, or a long line of a solution's README.
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
    """Return the runs of lines that only a solution has."""
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
    """Return the lines that are not empty, without indentation and blanks."""
    return [" ".join(line.split()) for line in text.splitlines() if line.strip()]
