"""Define exercises, tasks and checks, find exercises, and check which packages are installed."""

from __future__ import annotations

import functools
import hashlib
import importlib.util
import re
import sys
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from importlib import metadata
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError, listed
from botschool.grading.declare.libraries import Refused
from botschool.grading.declare.mistakes import Known, case_text
from botschool.grading.declare.modules import may_use, text_of
from botschool.grading.declare.picture import Picture
from botschool.grading.declare.references import pruned
from botschool.grading.declare.state import DEFAULT, given_secret, slow_key
from botschool.grading.declare.trust import check_trusted
from botschool.grading.declare.weights import chosen, shared_out
from botschool.paths import course_root, for_make

POINTS = 100
"""Points of every exercise."""
ABSENT = "botschool.grading.run.absent"
"""The module that replaces packages which are not installed but which a submission imports."""
PICTURES = "pictures.py"
"""The file beside a grader that says what `botschool show` draws."""
STANDS_IN = ("pybullet",)
"""Extras for which something stands in where they are not installed."""


Check = Callable[[Any], None]
"""A function of a Student (run/student.py) that raises Wrong if the student fails the check."""


Number = int | str
"""Number of an exercise, or name of a laboratory, such as lab9."""


def called(number: Number) -> str:
    """Return the name: Exercise 3, or Laboratory 9."""
    text = str(number)
    return f"Laboratory {text[3:]}" if text.startswith("lab") else f"Exercise {text}"


@dataclass
class Task:
    """A numbered task of an exercise; one child runs its checks one after another."""

    id: str
    title: str
    seconds: float
    memory: int
    needs: tuple[str, ...] = ()
    """Tasks whose functions a submission calls in this one."""
    refused: Refused = field(default_factory=Refused)
    extras: tuple[str, ...] = ()
    """The exercise's extras that the task needs."""
    exercise: Any = field(default=None, repr=False, compare=False)
    checks: list[tuple[int, str, Check]] = field(default_factory=list)
    picture: Picture | None = None
    """How its answers are drawn, if there is something to see in them."""

    def check(self, points: int) -> Callable:
        """Return a decorator for a check: a function of a Student that raises Wrong if it fails."""

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
        packages: tuple[str, ...] | None = None,
    ) -> None:
        """Declare the exercise's title, the file that students write, and its needs.

        imports: modules that take long to import; their import costs no task any time.
        extras: of pyproject.toml, whose packages the exercise needs. `make test-exN` reads them
        from the grader's text, in the form extras=("rl",), and installs them. A grader imports
        these packages inside its functions, so that it loads without them.
        packages: those of the extras that its tasks need; None for all. The picture may need more.
        """
        self.number = number
        self.title = title
        self.file = file
        absent = any(importlib.util.find_spec(name.partition(".")[0]) is None for name in imports)
        self.imports = (ABSENT,) if absent else imports
        self.extras = extras
        self.packages = extras if packages is None else packages
        self.tasks: list[Task] = []
        self.dropped: list[Task] = []
        """Tasks that the class's settings leave out; others may need their functions."""
        self.secret = ""
        """The secret for the seeds; "" means BOTSCHOOL_GRADING_SEED, or else DEFAULT."""
        self.work = ""
        """A digest of the submission: under a secret, the seeds depend on it, too."""
        self.references = ""
        """A Python file with our own functions of the tasks that others need (references.py)."""
        self.grader: Any = None
        """The module that declares the exercise: its drivers and inputs."""
        self.known = Known(number)
        """Our solution and its known mistakes, to compare with wrong answers."""
        self.ours: Any = None
        """Our solution in a process (run/ours.py), while a submission is graded."""

    def knows(self, solution: str, mistakes: str = "") -> None:
        """Take references and known mistakes from the texts of a solution and of wrong ones."""
        self.known = Known(self.number, solution, mistakes)
        needed = {id for task in self.tasks for id in task.needs}
        self.references = pruned(solution, needed)
        if self.grader is not None and solution:
            used = may_use(solution, text_of(self.grader))
            if not missing_packages(_wanted(self.extras)):  # else the submission imports them
                self.imports = (*self.imports, *sorted(used - {*self.imports}))
            for task in self.tasks:
                task.refused = replace(task.refused, may_use=used)

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
        """Add a task.

        seconds: processor time of all its checks. memory: MB beyond the imports.
        needs: ids of tasks whose functions students call in this one. If one of these fails, this
        task is also graded with our functions in its place.
        refused: what libraries have for the task, in the forms of grading/run/refused.py.
        packages: the extras that this task needs; None for the exercise's packages.
        """
        extras = _wanted(self.packages if packages is None else packages)
        given = needs, Refused(refused), extras, self
        self.tasks.append(Task(id, title, seconds, memory, *given))
        return self.tasks[-1]

    def weigh(self, points: Mapping[str, int]) -> None:
        """Give tasks other points, shared out among their checks; drop those with 0."""
        for id, most in points.items():
            task = self.find(id)
            shares = shared_out([own for own, _, _ in task.checks], most)
            task.checks = [
                (own, *more) for own, (_, *more) in zip(shares, task.checks, strict=True)
            ]
        self.dropped += [task for task in self.tasks if points.get(task.id) == 0]
        self.tasks = [task for task in self.tasks if task not in self.dropped]

    def needed(self, task: Task) -> list[Task]:
        """Return the tasks that a task needs, directly or indirectly, in the exercise's order."""
        found: set[str] = set()
        waiting = [*task.needs]
        while waiting:
            if (id := waiting.pop()) not in found:
                found.add(id)
                waiting += self.find(id).needs
        return [each for each in self.tasks if each.id in found]

    def require(self, tasks: Iterable[Task] | None = None) -> None:
        """Raise BotschoolError that says what to install if one of the tasks lacks a package.

        tasks: None for all of the exercise, and for running its file.
        """
        wanted = _wanted(self.extras)
        if tasks is not None:
            wanted = tuple(e for e in wanted if any(e in task.extras for task in tasks))
        if missing := missing_packages(wanted):
            raise BotschoolError(
                f"Exercise {self.number} needs {listed(missing)}: install this with 'botschool "
                f"start {self.number}' in a course that made its own .venv, else with 'pip install "
                f"botschool[{','.join(wanted)}]'."
            )

    def require_some(self, tasks: Iterable[Task]) -> None:
        """Raise BotschoolError as `require`, but only if none of the tasks can be graded."""
        tasks = list(tasks)
        if all(missing_packages(task.extras) for task in tasks):
            self.require(tasks)

    def seed(self, index: int | str) -> int:
        """Return a grading seed, which follows from the instructor's secret and the submission.

        Feedback about the inputs of one submission therefore helps no other submission, nor the
        same one after a change. A student's own work has the same seeds each time.
        """
        secret, work = self._sources()
        key = f"{slow_key(secret)}:{self.number}:{index}{work}"
        digest = hashlib.sha256(key.encode()).digest()
        return int.from_bytes(digest[:4], "little") % 2**31

    def _sources(self) -> tuple[str, str]:
        """Return the secret, and ":" with the digest of the submission if seeds depend on it."""
        secret = self.secret or given_secret() or DEFAULT
        return secret, f":{self.work}" if secret != DEFAULT else ""

    def cached(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Decorate a grader's function that uses seeds: keep its results while these are the same.

        functools.cache would give one submission the numbers of another.
        """
        kept: dict[tuple[str, str], dict[tuple, Any]] = {}

        @functools.wraps(function)
        def answer(*arguments: Any) -> Any:
            if (sources := self._sources()) not in kept:
                kept.clear()
            results = kept.setdefault(sources, {})
            if arguments not in results:
                results[arguments] = function(*arguments)
            return results[arguments]

        return answer

    def find(self, task: str) -> Task:
        """Return the task with that id. Raises BotschoolError."""
        for each in (*self.tasks, *self.dropped):
            if each.id == task:
                return each
        known = ", ".join(each.id for each in self.tasks)
        raise BotschoolError(f"Exercise {self.number} has no task {task}; its tasks are {known}.")


def _wanted(extras: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(extra for extra in extras if extra not in STANDS_IN)


def cannot_be_graded(task: Task) -> str:
    """Return why a task cannot be graded on this machine; "" if it can."""
    missing = missing_packages(task.extras)
    if not missing:
        return ""
    return (
        f"Not graded: this task needs {listed(missing)}, not installed here: "
        f"pip install 'botschool[{','.join(task.extras)}]'."
    )


def folder_of(number: int, root: Path | None = None) -> Path:
    """Return exercises/exNN_name. Raises BotschoolError."""
    root = root or course_root()
    found = sorted((root / "exercises").glob(f"ex{number:02d}_*"))
    if not found:
        have = ", ".join(map(str, exercise_numbers(root)))
        raise BotschoolError(f"There is no exercise {number}; there are {have}.")
    return found[0]


def exercise_numbers(root: Path) -> list[int]:
    """Return the numbers of the exercises with a grader."""
    graders = (root / "exercises").glob("ex[0-9][0-9]_*/test_*.py")
    return sorted({int(path.parent.name[2:4]) for path in graders})


def load_exercise(number: int, root: Path | None = None) -> Exercise:
    """Run an exercise's grader file and return the exercise that it declares.

    Raises BotschoolError if there is no such file, or if the user does not trust the course.
    """
    check_trusted(root or course_root())
    folder = folder_of(number, root)
    graders = sorted(folder.glob("test_*.py"))
    if not graders:
        raise BotschoolError(f"{folder} holds no grader file test_*.py: restore it.")
    module = _module(f"grader_{number}", graders[0])
    exercise = module.exercise
    exercise.grader = exercise.grader or module
    if (folder / PICTURES).is_file():
        shown = _module(f"pictures_{number}", folder / PICTURES)
        for id, picture in vars(shown).get("PICTURES", {}).items():  # a student's own has none
            exercise.find(id).picture = picture
    root = root or course_root()
    solution = root / "solutions" / folder.name / exercise.file
    if not exercise.known.solution and solution.is_file():
        exercise.knows(solution.read_text(encoding="utf-8"), case_text(root, number))
    exercise.weigh(chosen(root, number))
    return exercise


def _module(name: str, file: Path) -> Any:
    """Run a file of the course and return it as a module."""
    spec = importlib.util.spec_from_file_location(name, file)
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    return module


def selected(text: str, root: Path | None = None) -> dict[int, tuple[str, ...]]:
    """Return the exercises that "3", "3.2", "1-3,7" or "all" names, and the tasks of each.

    () stands for all tasks. Raises BotschoolError for an exercise or task that does not exist.
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
                f"'{text[:30]}' names no exercise: give its number, for example 3, a task, "
                "for example 3.2, or several exercises, for example 1-3,7."
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
        raise BotschoolError(f"'{text[:30]}' is not a range: write the smaller number first.")
    return dict(sorted(found.items()))


def submission_place(submission: str, root: Path) -> Path:
    """Return the folder or file that --submission names; `solutions` is the reference.

    Raises BotschoolError if it does not exist.
    """
    base = Path(submission)
    if submission == "solutions" and not base.is_dir():
        base = root / "solutions"
    if not base.exists():
        raise BotschoolError(f"There is no {submission}: name a folder with --submission FOLDER.")
    return base


def submission_file(number: int, submission: str | None, root: Path | None = None) -> Path:
    """Return the file to grade: the student's own, the reference (`solutions`), or another one."""
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
        f"name another folder with --submission FOLDER{for_make(root)}."
    )


def missing_packages(extras: tuple[str, ...]) -> list[str]:
    """Return the names of the missing packages, as botschool's own metadata lists them."""
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
