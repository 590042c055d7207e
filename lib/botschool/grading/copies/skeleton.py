"""Skeletons: what students get, generated from the solutions, their single source."""

from __future__ import annotations

import hashlib
import json
import re
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.output import written_whole

BEGIN, END = "### BEGIN SOLUTION", "### END SOLUTION"
GENERATED = ".skeletons.json"
"""In exercises/: the digest of every skeleton as it was generated, to know edited ones."""


def skeleton(solution: str) -> str:
    """The text of a solution file with every solution region replaced.

    `### BEGIN SOLUTION task 3.2: rank the population` ... `### END SOLUTION` becomes
    `raise NotImplementedError("task 3.2: rank the population")`. Raises ValueError when regions
    are nested, open or without a task.
    """
    lines, inside = [], False
    for number, line in enumerate(solution.splitlines(), 1):
        if BEGIN in line:
            found = re.fullmatch(rf"(\s*){BEGIN} (task \d+\.\d+: .+)", line)
            if inside or not found:
                raise ValueError(f"line {number}: '{BEGIN} task N.T: what to do' is needed here")
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
    """(solution, skeleton) files of every exercise."""
    found = sorted(root.glob("solutions/ex[0-9][0-9]_*/*.py"))
    return [(path, root / "exercises" / path.relative_to(root / "solutions")) for path in found]


def write_skeletons(root: Path) -> list[Path]:
    """Writes every skeleton that is absent or as it was generated; returns those left alone.

    A file that a student has edited is never touched.
    """
    digests_file = root / "exercises" / GENERATED
    digests = json.loads(digests_file.read_text()) if digests_file.exists() else {}
    edited = []
    for solution, target in pairs(root):
        name = target.relative_to(root / "exercises").as_posix()
        text = _generate(solution)
        if target.exists():
            present = target.read_text(encoding="utf-8")
            if present != text and _digest(present) != digests.get(name):
                edited.append(target)
                continue
        target.parent.mkdir(parents=True, exist_ok=True)
        with written_whole(target) as temporary:
            temporary.write_text(text, encoding="utf-8", newline="\n")
        digests[name] = _digest(text)
    with written_whole(digests_file) as temporary:
        temporary.write_text(json.dumps(digests, indent=1, sort_keys=True) + "\n")
    return edited


def _generate(solution: Path) -> str:
    try:
        return skeleton(solution.read_text(encoding="utf-8"))
    except ValueError as error:
        raise BotschoolError(f"{solution} cannot become a skeleton: {error}.") from None


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()
