"""What a student hands in, and what it gets."""

from __future__ import annotations

import re
import shutil
import tempfile
import traceback
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TypeVar

from botschool.errors import BotschoolError
from botschool.grading.cells import Script, Unreadable, scripts
from botschool.grading.checks import Wrong, plain
from botschool.grading.confined import (
    MachineFault,
    fork_server,
    machine_fault,
    submission_files,
)
from botschool.grading.exercise import Exercise, Task
from botschool.grading.student import Student
from botschool.grading.timelimit import TookTooLong, processor_time_limit
from botschool.sandbox import ForkServer

T = TypeVar("T")
LOADING_SECONDS = 10
"""Processor time for all that a file or a notebook does besides defining functions."""
CHECK_SECONDS = 20
"""Processor time that a check may use in the grader's own thread; our solutions need up to 3."""
_CELL = re.compile(r"^(?=# %%)", re.MULTILINE)
_DEFINITION = re.compile(r"^(async def|def|class)\b", re.MULTILINE)
_LINE = re.compile(r" in line (\d+)")
_FILE = re.compile(r" \(\w+\.py, line \d+\)")


@dataclass
class TaskResult:
    """What a submission got for a task."""

    id: str
    title: str
    points: int
    max_points: int
    message: str
    """Why points are missing, in sentences; empty for full marks."""
    printed: str = ""
    """The beginning of what the submission printed."""
    missing: list[str] = field(default_factory=list)
    """What this system could not confine, in words."""
    pictures: list[tuple[str, bytes]] = field(default_factory=list)
    """(name, PNG) of those beside the submission's file after the task."""


@dataclass
class Result:
    """What a submission got for an exercise."""

    exercise: int
    title: str
    tasks: list[TaskResult]

    @property
    def points(self) -> int:
        return sum(task.points for task in self.tasks)

    @property
    def max_points(self) -> int:
        return sum(task.max_points for task in self.tasks)

    @property
    def missing(self) -> list[str]:
        """What this system could not confine, in words."""
        return list(dict.fromkeys(each for task in self.tasks for each in task.missing))

    def to_json(self) -> dict:
        """The form of `botschool grade --json`."""
        shown = ("id", "title", "points", "max_points", "message")
        tasks = [{name: getattr(task, name) for name in shown} for task in self.tasks]
        return {
            "exercise": self.exercise,
            "points": self.points,
            "max_points": self.max_points,
            "tasks": tasks,
        }


class GraderFault(BotschoolError):
    """A check failed by a fault of its own, not by what a submission did."""


def grade(
    exercise: Exercise,
    file: Path,
    report: Callable[[TaskResult], None] = lambda result: None,
    tasks: Iterable[Task] | None = None,
    server: ForkServer | None = None,
    alone: bool = True,
) -> Result:
    """Grades a submission's file; reports each task as soon as it is judged.

    tasks: else all; server: else one is made and closed.
    alone: whether no others are graded at the same time; what may be the fault of the machine is
    then tried once more. Raises BotschoolError, of which MachineFault says that it was its fault.
    """
    if server is None:
        with fork_server(exercise.imports) as own:
            return grade(exercise, file, report, tasks, own, alone)
    results = []
    with Submission(file, server, alone=alone) as submission:
        for task in exercise.tasks if tasks is None else tasks:
            results.append(submission.grade(task))
            report(results[-1])
    return Result(exercise.number, exercise.title, results)


class Submission:
    """A file, ready to be graded: as it is if it can be loaded, else what its cells define.

    So a part that fails, or is no Python, costs no points of others: alike in a script, whose
    cells begin at lines `# %%`, and in a notebook.
    """

    def __init__(
        self,
        file: Path,
        server: ForkServer,
        sources: list[str] | None = None,
        name: str = "",
        alone: bool = True,
    ) -> None:
        """sources: of a notebook (the file), the texts of its code cells; name: of its script.

        alone: as of `grade`.
        """
        self._alone = alone
        self._given = file
        self._sources = sources
        self._server = server
        self._base = Path(tempfile.mkdtemp(prefix="botschool-"))
        self._file = self._base / "submission" / (name or file.name)
        self._script: Script | None = None
        self._starts: list[int] = []
        self._notes: list[str] = []
        self._failure = ""

    def __enter__(self) -> Submission:
        try:
            self._prepare()
        except (Wrong, Unreadable) as error:
            self._failure = str(error)
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        shutil.rmtree(self._base, ignore_errors=True)

    def grade(self, task: Task) -> TaskResult:
        """Grades a task; lines in the message are those of the file, or of a notebook's cell."""
        if self._failure:
            return TaskResult(task.id, task.title, 0, task.max_points, self._failure)
        file = self._file if self._script else self._given
        result = grade_task(task, file, self._server, self._alone)
        result.message = self._placed(result.message)
        if result.message:
            result.message = "\n".join([result.message, *self._notes])
        return result

    def _prepare(self) -> None:
        what = "Your file" if self._sources is None else "The notebook"
        if self._sources is not None:
            everything, defined = scripts(self._sources)
            self._write(everything)
        file = self._file if self._script else self._given
        trouble = _twice(partial(_trouble, file, self._server), self._alone)
        if not trouble:
            return
        trouble = self._placed(trouble).removeprefix("Your file cannot be loaded: ").rstrip(".")
        if self._sources is None:
            everything, defined = scripts(self._cells())
        if not _DEFINITION.search(defined.text):
            raise Wrong(f"{what} cannot be loaded: {trouble}.")
        self._write(defined)
        self._notes = [
            f"{what} as a whole cannot be loaded ({trouble}), so only functions, classes and "
            "imports count, with the names that these use."
        ]
        for number in defined.left_out:
            self._notes.append(f"{self._cell(number).capitalize()} is no Python: left out.")

    def _cells(self) -> list[str]:
        """Of a script; notes the line before each."""
        text = self._given.read_bytes().decode("utf-8", "replace").replace("\r\n", "\n")
        cells = _CELL.split(text)
        self._starts = [0]
        for cell in cells:
            self._starts.append(self._starts[-1] + cell.count("\n"))
        return cells

    def _write(self, script: Script) -> None:
        if self._script is None:
            self._file.parent.mkdir()
            for path in submission_files(self._given):
                place = self._file.parent / path.relative_to(self._given.parent)
                if path != self._given and path.suffix != ".ipynb" and place != self._file:
                    place.parent.mkdir(parents=True, exist_ok=True)
                    shutil.copyfile(path, place, follow_symlinks=False)
        self._script = script
        self._file.write_bytes(script.text.encode("utf-8", "replace"))

    def _placed(self, message: str) -> str:
        def place(found: re.Match) -> str:
            line = int(found[1])
            if self._script is None or not 1 <= line <= len(self._script.places):
                return found[0]
            number, inside = self._script.places[line - 1]
            if self._sources is None:
                return f" in line {self._starts[number - 1] + inside}"
            return f" in line {inside} of {self._cell(number)}"

        return _LINE.sub(place, _FILE.sub("", message))

    def _cell(self, number: int) -> str:
        if self._sources is None:
            first, last = self._starts[number - 1 : number + 1]
            return f"the part from line {first + 1} to {last}"
        lines = [line.strip() for line in self._sources[number - 1].splitlines() if line.strip()]
        shown = lines[0] if lines else ""
        return f"the cell '{shown[:40]}{'...' if len(shown) > 40 else ''}'"


def _twice(attempt: Callable[[bool], T], alone: bool) -> T:
    """attempt(whether it was tried before), once more after a MachineFault if nobody else runs."""
    try:
        return attempt(False)
    except MachineFault:
        if not alone:
            raise
    return attempt(True)


def _trouble(file: Path, server: ForkServer, tried: bool) -> str:
    """Why a submission's file cannot be loaded, in a sentence; "" if it can.

    Raises Wrong when it may not be.
    """

    def loads(module):
        return True

    student = Student(file, LOADING_SECONDS, server=server, tried=tried)
    try:
        student.run(loads, said="the code outside functions")
    except Wrong as error:
        return str(error)
    finally:
        student.close()
    return ""


def grade_task(task: Task, file: Path, server: ForkServer, alone: bool = True) -> TaskResult:
    """Runs a task's checks on a file, in a child of its own; alone: as of `grade`.

    Raises BotschoolError.
    """
    return _twice(partial(_grade_task, task, file, server), alone)


def _grade_task(task: Task, file: Path, server: ForkServer, tried: bool) -> TaskResult:
    result = TaskResult(task.id, task.title, 0, task.max_points, "")
    problems: list[str] = []
    student = None
    try:
        student = Student(file, task.seconds, task.memory, server, tried, task.refused)
        for worth, _, check in task.checks:
            problem = _problem(task, check, student)
            if problem is None:
                result.points += worth
            else:
                problems.append(problem)
        student.stop()
        result.printed, result.missing = plain(student.printed), student.missing
        result.pictures = student.pictures()
    except Wrong as error:
        problems.append(str(error))
    finally:
        if student is not None:
            student.close()
    result.message = plain("\n".join(dict.fromkeys(problems)))
    return result


def _problem(task: Task, check: Callable[[Student], None], student: Student) -> str | None:
    """Why a check is not passed, in a sentence; None when it is."""
    answers = student.answers
    try:
        with processor_time_limit(CHECK_SECONDS):
            check(student)
    except TookTooLong:
        return f"{student.said} returned something that takes too long to judge."
    except Wrong as error:
        return str(error)
    except BotschoolError:
        raise  # the grader's own trouble, not the submission's
    except OSError as error:
        fault = machine_fault(error)
        if isinstance(fault, MachineFault):
            raise fault from error
        return _unjudged(task, student, answers, error)
    except Exception as error:
        return _unjudged(task, student, answers, error)
    return None


def _unjudged(task: Task, student: Student, answers: int, error: Exception) -> str:
    """An exception in a check: a sentence. Raises GraderFault if no answer can have caused it."""
    said = f"{type(error).__name__}: {str(error)[:200]}"
    # with nothing from the submission at hand, or by a name that is not there
    if student.answers == answers or isinstance(error, (NameError, ImportError)):
        place = traceback.extract_tb(error.__traceback__)[-1]
        raise GraderFault(
            f"The grader of task {task.id} has a fault, which is not the submission's "
            f"({said}, in {Path(place.filename).name} line {place.lineno}): it must be mended."
        ) from error
    return (
        f"{student.said} returned something that cannot be judged ({said}). If it is what the "
        "task asks for, tell your instructor."
    )
