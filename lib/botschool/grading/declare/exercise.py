"""Exercises, their tasks and checks, and where to find them; what is installed for them."""

from __future__ import annotations

import hashlib
import importlib.util
import os
import re
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from importlib import metadata
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError, listed
from botschool.grading.declare.mistakes import Known
from botschool.grading.declare.references import pruned
from botschool.grading.declare.secret import DEFAULT, VARIABLE, grading_secret
from botschool.grading.declare.trust import check_trusted
from botschool.paths import course_root

STATE = ".botschool"
"""In the course folder: what the commands remember."""
POINTS = 100
"""What every exercise is worth."""
ABSENT = "botschool.grading.run.absent"
"""What a submission finds imported where packages are missing that its exercise imports."""
MISTAKES = "tests/course/mutants"
"""Of a course: the wrong solutions of its exercises, which the students' copy has packed."""


Check = Callable[[Any], None]
"""A function of a Student (run/student.py) that raises Wrong when the check is not passed."""


Number = int | str
"""Of an exercise, or the name of a laboratory as lab9."""


def called(number: Number) -> str:
    """Exercise 3, or Laboratory 9."""
    text = str(number)
    return f"Laboratory {text[3:]}" if text.startswith("lab") else f"Exercise {text}"


@dataclass
class Task:
    """A numbered task of an exercise: its checks are run one after another in one child."""

    id: str
    title: str
    seconds: float
    memory: int
    needs: tuple[str, ...] = ()
    """Tasks whose functions a submission calls in this one."""
    refused: tuple[str, ...] = ()
    extras: tuple[str, ...] = ()
    """Those of the exercise that the task needs."""
    checks: list[tuple[int, str, Check]] = field(default_factory=list)

    def check(self, points: int) -> Callable:
        """Decorates a check: a function of a Student that raises Wrong when it is not passed."""

        def keep(function: Check) -> Check:
            self.checks.append((points, function.__name__, function))
            return function

        return keep

    @property
    def max_points(self) -> int:
        return sum(points for points, _, _ in self.checks)


class Exercise:
    """An exercise as its grader file declares it.

    exercise = Exercise(3, "Evolution strategy", file="evolution_strategy.py")
    population = exercise.task("3.1", "The initial population")

    @population.check(10)
    def has_the_right_shape(student): ...
    """

    program = "botschool.grading.classes.batch"
    """The module that grades a submission in a process of its own."""

    def __init__(
        self,
        number: int,
        title: str,
        file: str,
        imports: tuple[str, ...] = (),
        extras: tuple[str, ...] = (),
    ) -> None:
        """What the exercise is called, the file that students write, and what it needs.

        imports: modules that take long to import; no task's time is used up by them. extras: of
        pyproject.toml, whose packages the exercise needs; `make test-exN` reads them from the
        grader's text, so they stand there as extras=("rl",), and installs them. A grader imports
        these packages inside its functions, so that it can be loaded without them.
        """
        self.number = number
        self.title = title
        self.file = file
        absent = any(importlib.util.find_spec(name.partition(".")[0]) is None for name in imports)
        self.imports = (ABSENT,) if absent else imports
        self.extras = extras
        self.tasks: list[Task] = []
        self.secret = ""
        """What the grading seeds follow from; "" for BOTSCHOOL_GRADING_SEED, or else DEFAULT."""
        self.work = ""
        """A digest of what is graded: under a secret, seeds follow from it, too."""
        self.references = ""
        """Our own functions of the tasks that others need, as a Python file (references.py)."""
        self.known = Known(number)
        """Our solution and its known mistakes, which are tried where an answer is wrong."""

    def knows(self, solution: str, mistakes: str = "") -> None:
        """Takes references and known mistakes from the texts of a solution and of wrong ones."""
        self.known = Known(self.number, solution, mistakes)
        needed = {id for task in self.tasks for id in task.needs}
        self.references = pruned(solution, needed)

    def task(
        self,
        id: str,
        title: str,
        seconds: float = 20,
        memory: int = 4096,
        needs: tuple[str, ...] = (),
        refused: tuple[str, ...] = (),
        packages: tuple[str, ...] | None = None,
    ) -> Task:
        """Adds a task; seconds: processor time of all its checks; memory: MB beyond the imports.

        needs: ids of tasks whose functions students call in this one. If one of these does not
        pass, this one is also graded with ours in its place.
        refused: functions of libraries that are the answer, as of refused.refuse.
        packages: the exercise's extras that this task needs; None for all. The task is graded
        where the others are not installed.
        """
        extras = self.extras if packages is None else packages
        self.tasks.append(Task(id, title, seconds, memory, needs, refused, extras))
        return self.tasks[-1]

    def needed(self, task: Task) -> list[Task]:
        """The tasks that a task builds on, directly or by way of others, in their order."""
        found: set[str] = set()
        waiting = [*task.needs]
        while waiting:
            if (id := waiting.pop()) not in found:
                found.add(id)
                waiting += self.find(id).needs
        return [each for each in self.tasks if each.id in found]

    def require(self, tasks: Iterable[Task] | None = None) -> None:
        """Raise BotschoolError that says what to install if one of the tasks lacks a package.

        tasks: None for all that the exercise has, and for what its file does when it is run.
        """
        wanted = self.extras
        if tasks is not None:
            wanted = tuple(e for e in self.extras if any(e in task.extras for task in tasks))
        if missing := missing_packages(wanted):
            raise BotschoolError(
                f"Exercise {self.number} needs {listed(missing)}: install what it needs with "
                f"'make test-ex{self.number}' or 'pip install botschool[{','.join(wanted)}]'."
                f"{_only_on(wanted)}"
            )

    def require_some(self, tasks: Iterable[Task]) -> None:
        """Raise BotschoolError as `require`, but only if none of the tasks can be graded."""
        tasks = list(tasks)
        if all(missing_packages(task.extras) for task in tasks):
            self.require(tasks)

    def seed(self, index: int) -> int:
        """A grading seed; they follow from the instructor's secret (secret.py) and the submission.

        So what feedback tells of the inputs of one submission helps no other one, nor the same
        one after a change. A student's own work has the same seeds each time.
        """
        secret = self.secret or os.environ.get(VARIABLE) or DEFAULT
        key = f"{secret}:{self.number}:{index}"
        if secret != DEFAULT:
            key += f":{self.work}"
        digest = hashlib.sha256(key.encode()).digest()
        return int.from_bytes(digest[:4], "little") % 2**31

    def find(self, task: str) -> Task:
        """The task with that id. Raises BotschoolError."""
        for each in self.tasks:
            if each.id == task:
                return each
        known = ", ".join(each.id for each in self.tasks)
        raise BotschoolError(f"Exercise {self.number} has no task {task}; its tasks are {known}.")


def cannot_be_graded(task: Task) -> str:
    """Return why a task cannot be graded on this machine; "" if it can."""
    missing = missing_packages(task.extras)
    if not missing:
        return ""
    return (
        f"Not graded: this task needs {listed(missing)}, not installed here: "
        f"pip install 'botschool[{','.join(task.extras)}]'.{_only_on(task.extras)}"
    )


def _only_on(extras: tuple[str, ...]) -> str:
    """Return a sentence on where packages can be had that not every system has."""
    here = sys.platform == "linux" and sys.version_info < (3, 12)
    if "pybullet" not in extras or here:
        return ""
    return " PyBullet comes ready to install for Linux with Python 3.10 or 3.11 only."


def folder_of(number: int, root: Path | None = None) -> Path:
    """exercises/exNN_name. Raises BotschoolError."""
    root = root or course_root()
    found = sorted((root / "exercises").glob(f"ex{number:02d}_*"))
    if not found:
        have = ", ".join(map(str, exercise_numbers(root)))
        raise BotschoolError(f"There is no exercise {number}; there are {have}.")
    return found[0]


def exercise_numbers(root: Path) -> list[int]:
    """The exercises that are there: those with a grader."""
    graders = (root / "exercises").glob("ex[0-9][0-9]_*/test_*.py")
    return sorted({int(path.parent.name[2:4]) for path in graders})


def load_exercise(number: int, root: Path | None = None) -> Exercise:
    """What the exercise's grader file declares.

    Runs that file. Raises BotschoolError where there is none, or for a course without trust.
    """
    check_trusted(root or course_root())
    folder = folder_of(number, root)
    graders = sorted(folder.glob("test_*.py"))
    if not graders:
        raise BotschoolError(f"{folder} holds no grader file test_*.py: restore it.")
    name = f"grader_{number}"
    spec = importlib.util.spec_from_file_location(name, graders[0])
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    exercise = module.exercise
    root = root or course_root()
    solution = root / "solutions" / folder.name / exercise.file
    if not exercise.known.solution and solution.is_file():
        mistakes = root / MISTAKES / f"ex{number:02d}.py"
        text = mistakes.read_text(encoding="utf-8") if mistakes.is_file() else ""
        exercise.knows(solution.read_text(encoding="utf-8"), text)
    return exercise


def selected(text: str, root: Path | None = None) -> dict[int, tuple[str, ...]]:
    """Return what "3", "3.2", "1-3,7" or "all" names: exercises, and the tasks of each.

    () stands for all tasks. Raises BotschoolError for what is not there.
    """
    root = root or course_root()
    if text.strip() == "all":
        return dict.fromkeys(exercise_numbers(root), ())
    found: dict[int, tuple[str, ...]] = {}
    for part in text.split(","):
        match = re.fullmatch(
            r"\s*([0-9]{1,3})(?:\.([0-9]{1,3})|\s*-\s*([0-9]{1,3}))?\s*", part, re.ASCII
        )
        if not match:
            raise BotschoolError(
                f"'{text[:30]}' names no exercise: give its number, as 3, a task, as 3.2, or "
                "several exercises, as 1-3,7."
            )
        first = int(match[1])
        for number in range(first, int(match[3] or first) + 1):
            task = f"{number}.{int(match[2])}" if match[2] else ""
            whole = not task or found.get(number) == ()
            found[number] = () if whole else (*found.get(number, ()), task)
    for number, tasks in found.items():
        folder_of(number, root)
        for task in tasks:
            load_exercise(number, root).find(task)
    if not found:
        raise BotschoolError(f"'{text[:30]}' names no exercise: the smaller number comes first.")
    return dict(sorted(found.items()))


def submission_place(submission: str, root: Path) -> Path:
    """Return the folder or file that --submission names; `solutions` is the reference.

    Raises BotschoolError where there is none.
    """
    base = Path(submission)
    if submission == "solutions" and not base.is_dir():
        base = root / "solutions"
    if not base.exists():
        raise BotschoolError(f"There is no {submission}: name a folder with --submission FOLDER.")
    return base


def submission_file(number: int, submission: str | None, root: Path | None = None) -> Path:
    """The file to grade: the student's own, the reference (`solutions`), or in another folder."""
    root = root or course_root()
    folder, exercise = folder_of(number, root), load_exercise(number, root)
    if submission is None:
        places = [folder]
    else:
        base = submission_place(submission, root)
        places = [base / folder.name, base]
    for place in places:
        if (place / exercise.file).is_file():
            return place / exercise.file
    raise BotschoolError(
        f"There is no {exercise.file} in {' or '.join(map(str, places))}: "
        "name another folder with --submission FOLDER, or SUBMISSION=FOLDER for make."
    )


def make_state(root: Path) -> Path:
    """The folder of what the commands remember. Raises OSError where it cannot be written to."""
    folder = root / STATE
    if not folder.is_dir():
        folder.mkdir()
        (folder / ".gitignore").write_text("*\n")
    if not os.access(folder, os.W_OK):
        raise PermissionError(f"no permission to write in {folder}")
    return folder


def secret_for_others(root: Path) -> tuple[str, str]:
    """Return the secret to grade other people's work with, and a sentence on where it is kept."""
    try:
        return grading_secret(make_state(root))
    except OSError:
        return grading_secret(root / STATE)


def missing_packages(extras: tuple[str, ...]) -> list[str]:
    """The names of those packages, as installed botschool's own metadata lists them."""
    try:
        requirements = metadata.requires("botschool") or []
    except metadata.PackageNotFoundError:
        return []
    wanted = []
    for requirement in requirements:
        text, _, marker = requirement.partition(";")
        if any(re.search(f"extra == ['\"]{re.escape(extra)}['\"]", marker) for extra in extras):
            wanted.append(re.match(r"[\w.-]+", text)[0])
    return [name for name in wanted if not _installed(name)]


def _installed(name: str) -> bool:
    try:
        metadata.distribution(name)
    except metadata.PackageNotFoundError:
        return False
    return True
