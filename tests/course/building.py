"""Submissions made of a solution or a skeleton and something wrong, different or hostile.

mutants/exNN.py holds the wrong solutions of an exercise, alternatives/exNN.py right ones in other
styles. A case is a section of the file:

    # %% one_noise_for_all loses 3.3, 3.4
    # One vector of noise is added to all copies.
    # says: the same noise for all
    # -     noise = rng.standard_normal((half, population.shape[1]))
    # +     noise = rng.standard_normal(population.shape[1])

The first line gives the name and the tasks that lose points; an alternative loses none. The second
line tells the reader what is wrong or different. `says` is optional: a regular expression that the
message of the first of these tasks matches, and that no message matches which does not name the
mistake. Lines with `-` are lines of the solution, which must hold them once and without a gap; the
lines with `+` take their place; the next `-` begins another change. Code that follows is put behind
the solution's functions: what it defines takes the place of the solution's.

The files of hostile/ have sections, too: a name, a line that says what is hostile, and code.
"""

import ast
import re
from dataclasses import dataclass
from functools import cache
from itertools import groupby
from pathlib import Path

from botschool.grading.copies.skeleton import skeleton
from botschool.grading.declare.exercise import Exercise, folder_of, load_exercise

ROOT = Path(__file__).parents[2]
HERE = Path(__file__).parent
MAIN = re.compile(r'^if __name__ == "__main__":', re.MULTILINE)
NUMBERS = sorted(int(path.name[2:4]) for path in (ROOT / "solutions").glob("ex[0-9][0-9]_*"))
GRADED = [
    number for number in NUMBERS if list((ROOT / "exercises").glob(f"ex{number:02d}_*/test_*.py"))
]


TITLE = re.compile(r"(\w+)(?: loses (\d+\.\d+(?:, \d+\.\d+)*))?")


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


@dataclass(frozen=True)
class Case:
    """A solution with something wrong or different."""

    number: int
    name: str
    loses: tuple[str, ...]
    """Tasks."""
    what: str
    says: str | None
    changes: tuple[tuple[str, str], ...]
    """Lines of the solution, and the lines that take their place."""
    code: str

    def __str__(self) -> str:
        return f"ex{self.number:02d}-{self.name}"

    @property
    def submission(self) -> str:
        """The text of the submission."""
        text = source(self.number).solution
        for old, new in self.changes:
            assert text.count("\n" + old) == 1, f"{self}: the solution must hold this once:\n{old}"
            text = text.replace("\n" + old, "\n" + new)
        return inserted(text, self.code) if self.code else text


def read_case(number: int, title: str, text: str) -> Case:
    """Return the case of a section; text is what follows the section's first line."""
    found = TITLE.fullmatch(title)
    assert found, f"exercise {number}: write '# %% NAME loses N.2, N.4', not '# %% {title}'"
    name, loses = found.groups()
    head = re.match(r"(?:#.*\n)*", text).group()
    what, *lines = [line[2:] for line in head.splitlines()]
    assert re.match(r"\w", what), f"{name}: the second line says what is wrong or different"
    says = [line[6:] for line in lines if line.startswith("says: ")]
    edits = re.findall(r"^# ([-+])(?: (.*))?\n", head, re.MULTILINE)
    assert len(says) + len(edits) == len(lines), f"{name}: a comment that is neither says, - nor +"
    changes = []
    for is_old, group in groupby(edits, key=lambda edit: edit[0] == "-"):
        block = "".join(f"{line}\n" for _, line in group)
        if is_old:
            changes.append((block, ""))
        else:
            changes[-1] = (changes[-1][0], block)
    code = text[len(head) :].strip("\n")
    tasks = tuple(loses.split(", ")) if loses else ()
    return Case(number, name, tasks, what, says[0] if says else None, tuple(changes), code)


def sections(path: Path) -> list[tuple[str, str]]:
    """Return what follows "# %%" and the text below it, for each section of a file."""
    text = path.read_text(encoding="utf-8")
    _, *parts = re.split(r"^# ?%% ?(.*)\n", text, flags=re.MULTILINE)
    return list(zip(parts[::2], parts[1::2], strict=True))


def cases(kind: str) -> list[Case]:
    """Return all cases of "mutants" or "alternatives"."""
    found = []
    for path in sorted((HERE / kind).glob("ex[0-9][0-9].py")):
        found += [read_case(int(path.stem[2:]), title, text) for title, text in sections(path)]
    return found


@cache
def hostile() -> dict[str, str]:
    """Return the code of each hostile submission, by name."""
    paths = sorted((HERE / "hostile").glob("*.py"))
    found = [section for path in paths for section in sections(path)]
    assert len(dict(found)) == len(found), "two hostile submissions have one name"
    return dict(found)
