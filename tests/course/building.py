"""Submissions made of a solution or a skeleton and something wrong, different or hostile.

solutions/exNN_name/cases.txt holds wrong answers to an exercise, and right ones in other styles;
botschool/grading/declare/mistakes.py describes how a case is written. The files of hostile/ have
sections, too: a name, a line that says what is hostile, and code.
"""

import ast
import hashlib
import re
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from botschool.grading.copies.skeleton import skeleton
from botschool.grading.declare import mistakes
from botschool.grading.declare.exercise import Exercise, Task, folder_of, load_exercise
from botschool.grading.declare.mistakes import case_text, inserted, read_cases
from botschool.grading.declare.same import Same

__all__ = ["inserted"]
QUICK = 20
"""Seconds of a task, at most, that is tried many times."""
ROOT = Path(__file__).parents[2]
HERE = Path(__file__).parent
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

    def reached(self, text: str) -> set[str]:
        """The tasks whose code in a changed solution differs, or uses what differs."""
        ours, theirs = parts(self.solution), parts(text)
        names = {name for name in {*ours, *theirs} if ours.get(name) != theirs.get(name)}
        found, using = set[str](), {*names}
        while using:
            found |= using
            said = {each for name in using for each in name.split(".")}
            using = {name for name, part in theirs.items() if said & words(part)} - found
        tasks = set()
        for name in found & {*ours}:
            tasks |= {*re.findall(r"### BEGIN SOLUTION task (\d+\.\d+)", ours[name])}
        return tasks

    @property
    def used_by_others(self) -> set[str]:
        """Functions that another function calls."""
        used = set()
        for node in ast.parse(self.solution).body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                names = {each.id for each in ast.walk(node) if isinstance(each, ast.Name)}
                used |= names - {node.name}
        return used


def parts(text: str) -> dict[str, str]:
    """name -> text of a file's functions, classes' methods and other statements at top level."""
    found, lines = {}, text.splitlines()
    for node in ast.parse(text).body:
        inside = node.body if isinstance(node, ast.ClassDef) else [node]
        for each in inside:
            names = [getattr(each, "name", ast.unparse(each).partition(" =")[0])]
            if isinstance(node, ast.ClassDef):
                names.insert(0, node.name)
            found[".".join(names)] = "\n".join(lines[each.lineno - 1 : each.end_lineno + 1])
    return found


@cache
def words(text: str) -> frozenset[str]:
    """The names in a piece of code."""
    return frozenset(re.findall(r"\w+", text))


@cache
def source(number: int) -> Source:
    folder = folder_of(number, ROOT).name
    file = load_exercise(number, ROOT).file
    text = (ROOT / "solutions" / folder / file).read_text(encoding="utf-8")
    return Source(number, folder, file, text)


def exercise(number: int) -> Exercise:
    """The exercise as its grader declares it."""
    return load_exercise(number, ROOT)


def write(folder: Path, number: int, text: str) -> Path:
    """The submission's file in a folder of its own."""
    place = folder / source(number).folder / source(number).file
    place.parent.mkdir(parents=True)
    place.write_text(text, encoding="utf-8")
    return place


class Case(mistakes.Case):
    """A solution with something wrong or different."""

    @property
    def submission(self) -> str:
        """The text of the submission."""
        return self.of(source(self.number).solution)

    @property
    def needs_a_process(self) -> bool:
        """Whether this process cannot judge it: no Python, a long task, a package of its own."""
        try:
            more = imported(self.submission) - imported(source(self.number).solution)
        except SyntaxError:
            return True
        long = {*self.loses} & long_tasks(self.number)
        return bool(long or more - sys.stdlib_module_names - {"numpy"})

    def tasks(self, exercise: Exercise) -> list[Task]:
        """The tasks that a wrong solution can reach. Long ones only if they lose points."""
        try:
            reached = source(self.number).reached(self.submission)
        except SyntaxError:
            return exercise.tasks
        return [
            task
            for task in exercise.tasks
            if task.id in self.loses or (task.id in reached and task.seconds <= QUICK)
        ]


@cache
def long_tasks(number: int) -> frozenset[str]:
    """The tasks of an exercise in which something is trained, so that they take long."""
    return frozenset(
        task.id
        for task in exercise(number).tasks
        if task.seconds > QUICK and not all(isinstance(check, Same) for _, _, check in task.checks)
    )


@cache
def imported(text: str) -> set[str]:
    """The packages that a text imports."""
    nodes = [*ast.walk(ast.parse(text))]
    names = {each.name for node in nodes if isinstance(node, ast.Import) for each in node.names}
    names |= {node.module or "" for node in nodes if isinstance(node, ast.ImportFrom)}
    return {name if "botschool" in name else name.partition(".")[0] for name in names}


def confined(cases: list[Case], many: int) -> list[Case]:
    """Return those that need a process, and some others, so many of each exercise at least."""
    chosen = []
    for number in GRADED:
        own = [case for case in cases if case.number == number]
        own.sort(key=lambda case: hashlib.sha256(str(case).encode()).digest())
        needy = [case for case in own if case.loses and case.needs_a_process]
        others = [case for case in own if case not in needy]
        chosen += [*needy, *others[: max(many - len(needy), many // 2)]]
    return chosen


def sections(path: Path) -> list[tuple[str, str]]:
    """Return what follows "# %%" and the text below it, for each section of a file."""
    text = path.read_text(encoding="utf-8")
    _, *parts = re.split(r"^# ?%% ?(.*)\n", text, flags=re.MULTILINE)
    return list(zip(parts[::2], parts[1::2], strict=True))


@cache
def cases(number: int) -> list[Case]:
    """Return an exercise's cases: wrong answers, and right ones in other styles."""
    return read_cases(number, case_text(ROOT, number), Case)


def wrong() -> list[Case]:
    """Return the wrong answers to all exercises."""
    return [case for number in GRADED for case in cases(number) if case.loses]


def right() -> list[Case]:
    """Return the right answers in other styles to all exercises."""
    return [case for number in GRADED for case in cases(number) if not case.loses]


@cache
def hostile() -> dict[str, str]:
    """Return the code of each hostile submission, by name."""
    paths = sorted((HERE / "hostile").glob("*.py"))
    found = [section for path in paths for section in sections(path)]
    assert len(dict(found)) == len(found), "two hostile submissions have one name"
    return dict(found)


def unearned() -> list[tuple[str, str, str]]:
    """Return (task, name, code) of each way to an answer in hostile/tasks.

    A section's line has its name and its tasks. All sections of a file begin with what stands
    above the first one.
    """
    found = []
    for path in sorted((HERE / "hostile" / "tasks").glob("ex*.py")):
        shared = re.split(r"^# ?%%", path.read_text(encoding="utf-8"), flags=re.MULTILINE)[0]
        for head, code in sections(path):
            name, *tasks = head.split()
            found += [(task, name, f"{shared}\n{code}") for task in tasks]
    return found
