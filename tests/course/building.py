"""Submissions made of a solution or a skeleton and something wrong or hostile."""

import ast
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from botschool.grading.exercise import Exercise, folder_of, load_exercise
from botschool.grading.skeleton import skeleton

ROOT = Path(__file__).parents[2]
HERE = Path(__file__).parent
MAIN = re.compile(r'^if __name__ == "__main__":', re.MULTILINE)
NUMBERS = sorted(int(path.name[2:4]) for path in (ROOT / "solutions").glob("ex[0-9][0-9]_*"))
GRADED = [
    number for number in NUMBERS if list((ROOT / "exercises").glob(f"ex{number:02d}_*/test_*.py"))
]


@dataclass(frozen=True)
class Source:
    """An exercise's folder name, file name and solution."""

    number: int
    folder: str
    file: str
    solution: str

    @property
    def skeleton(self) -> str:
        return skeleton(self.solution)

    @property
    def functions(self) -> dict[str, list[str]]:
        """task -> the functions (and classes) that students write for it."""
        found: dict[str, list[str]] = {}
        lines = self.solution.splitlines()
        for node in ast.parse(self.solution).body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                inside = "\n".join(lines[node.lineno - 1 : node.end_lineno + 1])
                for task in dict.fromkeys(re.findall(r"BEGIN SOLUTION task (\d+\.\d+)", inside)):
                    found.setdefault(task, []).append(node.name)
        return found

    @property
    def used_by_others(self) -> set[str]:
        """Functions that another function calls."""
        used = set()
        for node in ast.parse(self.solution).body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                names = {each.id for each in ast.walk(node) if isinstance(each, ast.Name)}
                used |= names - {node.name}
        return used


@cache
def source(number: int) -> Source:
    folder = folder_of(number, ROOT).name
    file = load_exercise(number, ROOT).file
    text = (ROOT / "solutions" / folder / file).read_text(encoding="utf-8")
    return Source(number, folder, file, text)


def exercise(number: int) -> Exercise:
    """The exercise as its grader declares it."""
    return load_exercise(number, ROOT)


def inserted(text: str, addition: str) -> str:
    """A file with something added behind its functions, before its main part."""
    found = MAIN.search(text)
    at = found.start() if found else len(text)
    return f"{text[:at]}\n{addition}\n\n{text[at:]}"


def write(folder: Path, number: int, text: str) -> Path:
    """The submission's file in a folder of its own."""
    place = folder / source(number).folder / source(number).file
    place.parent.mkdir(parents=True)
    place.write_text(text, encoding="utf-8")
    return place
