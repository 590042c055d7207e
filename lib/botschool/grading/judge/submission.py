"""Grade a student's submission of an exercise."""

from __future__ import annotations

import os
import re
import shutil
import tempfile
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from botschool.grading.declare.checks import Wrong, plain
from botschool.grading.declare.exercise import Exercise, Task, cannot_be_graded
from botschool.grading.declare.references import functions_of, pruned
from botschool.grading.judge.points import TaskResult, grade_task, tried_twice
from botschool.grading.judge.sentence import built_on
from botschool.grading.run.cells import NEWER, Script, Unreadable, gives_builtins, scripts
from botschool.grading.run.confined import (
    content_digest,
    fork_server,
    submission_files,
)
from botschool.grading.run.failures import Origin, SourceLines, marked
from botschool.grading.run.loading import left_out_of, trouble_of
from botschool.grading.run.notebooks import code_cells, names_in_other_cells
from botschool.grading.run.ours import ours_of
from botschool.grading.run.student import Student
from botschool.sandbox import ForkServer
from botschool.sandbox.inside import read_inside
from botschool.sandbox.scratch import MAX_COPIED

_CELL = re.compile(r"^(?=# %%)", re.MULTILINE)
_DEFINITION = re.compile(r"^(async def|def|class)\b", re.MULTILINE)
_NOT_GRADED = "Not graded: mend the file first, as said above."
SYNTAX, EVERYTHING = "BOTSCHOOL_SYNTAX_ERROR", "everything"
"""The environment variable that says what a syntax error costs, else only what stands there."""


@dataclass
class Result:
    """A submission's result for an exercise."""

    exercise: int
    title: str
    tasks: list[TaskResult]
    banner: str = ""
    """What must be mended first: why the file cannot be loaded."""

    @property
    def points(self) -> int:
        return sum(task.points for task in self.tasks)

    @property
    def max_points(self) -> int:
        return sum(task.max_points for task in self.tasks)

    @property
    def missing(self) -> list[str]:
        """Return what this system could not confine, in words."""
        return list(dict.fromkeys(part for task in self.tasks for part in task.missing))

    def to_json(self) -> dict:
        """Return the form of `botschool grade --json`."""
        shown = ("id", "title", "points", "max_points", "message")
        tasks = [
            {name: getattr(task, name) for name in shown}
            | ({} if task.graded else {"graded": False})
            for task in self.tasks
        ]
        return {
            "exercise": self.exercise,
            "points": self.points,
            "max_points": self.max_points,
            "banner": self.banner,
            "tasks": tasks,
        }


def grade(
    exercise: Exercise,
    file: Path,
    report: Callable[[TaskResult], None] = lambda result: None,
    tasks: Iterable[Task] | None = None,
    server: ForkServer | None = None,
    alone: bool = True,
    announce: Callable[[str], None] = lambda banner: None,
) -> Result:
    """Grade a submission's file, a script or a notebook; report each task once it is judged.

    tasks: None for all. server: None for one that is made and closed here.
    alone: whether no other submission is graded at the same time; then a possible fault of the
    machine leads to a second try.
    announce: called first, with the banner if there is one.
    Raises BotschoolError, or MachineFault for a fault of the machine.
    """
    if server is None:
        with fork_server(exercise.imports) as own:
            return grade(exercise, file, report, tasks, own, alone, announce)
    results = []
    with opened(exercise, file, server, alone) as submission:
        if submission.banner:
            announce(submission.banner)
        for task in exercise.tasks if tasks is None else tasks:
            results.append(submission.grade(task))
            report(results[-1])
            results[-1].complete()
    return Result(exercise.number, exercise.title, results, submission.banner)


def opened(exercise: Exercise, file: Path, server: ForkServer, alone: bool = True) -> Submission:
    """Return a submission's file, a script or a notebook, to be entered by `with`."""
    sources = code_cells(file) if file.suffix == ".ipynb" else None
    name = exercise.file if sources is not None else ""
    return Submission(file, server, sources, name, alone, exercise)


class Submission:
    """A submission's file, ready to be graded; if it cannot be loaded, only its definitions.

    A part that fails, or is not Python, then costs only its own points. This holds for notebooks
    and for scripts, whose cells begin at lines `# %%`.
    """

    def __init__(
        self,
        file: Path,
        server: ForkServer,
        sources: list[str] | None = None,
        name: str = "",
        alone: bool = True,
        exercise: Exercise | None = None,
    ) -> None:
        """Take the file.

        sources: the texts of the code cells, if the file is a notebook. name: of the notebook's
        script.
        alone: as in `grade`. exercise: for the functions that its tasks need of each other.
        """
        self._alone = alone
        self._given = file
        self._sources = sources
        self._server = server
        self._exercise = exercise
        self._base = Path(tempfile.mkdtemp(prefix="botschool-"))
        self._file = self._base / "submission" / (name or file.name)
        self._script: Script | None = None
        self._starts: list[int] = []
        self._results: dict[str, TaskResult] = {}
        self._lost: dict[str, str] = {}
        self._in_parts = False
        self._failure = ""
        self.banner = ""
        """Why the file, or a part of it, cannot be loaded, in some lines."""

    def __enter__(self) -> Submission:
        if self._exercise is not None:
            self._exercise.work = self._digest()
            self._exercise.ours = ours_of(self._exercise, self._server)
        try:
            if self._exercise is not None:
                self._exercise.seed(0)  # raises at once for a secret that is too short
            self._prepare()
        except (Wrong, Unreadable) as error:
            self.banner, self._failure = self.banner or str(error), _NOT_GRADED
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        if self._exercise is not None and self._exercise.ours is not None:
            self._exercise.ours.close()
            self._exercise.ours = None
        shutil.rmtree(self._base, ignore_errors=True)

    def grade(self, task: Task) -> TaskResult:
        """Grade a task; the message gives lines of the file, or of a notebook's cell."""
        if self._exercise is not None and (reason := cannot_be_graded(task)):
            return TaskResult(task.id, task.title, 0, task.max_points, reason, graded=False)
        if self._failure:
            return TaskResult(task.id, task.title, 0, task.max_points, self._failure)
        if task.id not in self._results:
            done = [self._results.get(other.id) for other in self._needed(task)]
            if any(other and other.hung for other in done):
                result = TaskResult(task.id, task.title, 0, task.max_points, "")
            else:
                result = self._attempt(task)
            if self._exercise is not None and result.points < result.max_points:
                result = self._with_references(task, result)
                own = functions_of(self._exercise.known.solution).get(task.id, ())
                result.note = self._twice(own)
            self._results[task.id] = result
        return self._results[task.id]

    def begun(self, task: Task) -> Student:
        """Return the submission in a process of its own, as a task runs it. Raises Wrong."""
        file = self._file if self._script else self._given
        limits = task.seconds, task.memory, self._server, True
        return Student(file, *limits, origin=self._origin(), refused=task.refused)

    def _twice(self, names: Iterable[str]) -> str:
        """Return a line on each of these functions that the file defines twice."""
        file = self._file if self._script else self._given
        return SourceLines(file, self._origin()).twice(names)

    def _needed(self, task: Task) -> list[Task]:
        return self._exercise.needed(task) if self._exercise is not None else []

    def _origin(self) -> Origin:
        return Origin(self._place if self._script else None, self._lost, self._in_parts)

    def _attempt(self, task: Task, references: dict | None = None) -> TaskResult:
        file = self._file if self._script else self._given
        origin = self._origin()
        known = self._exercise.known if self._exercise else None
        return grade_task(task, file, self._server, self._alone, origin, references, known)

    def _with_references(self, task: Task, result: TaskResult) -> TaskResult:
        """Return the result, or a better one with our functions for failing tasks."""
        exercise = self._exercise
        if not exercise.references or not task.needs or result.undone == task.id:
            return result
        needed = exercise.needed(task)
        functions = functions_of(exercise.known.solution or exercise.references)
        broken = [
            other
            for other in needed
            if other.id in functions and self.grade(other).points < other.max_points
        ]
        if not broken:
            return result
        names = [name for other in broken for name in functions[other.id]]
        source = pruned(exercise.references, [other.id for other in needed])
        again = self._attempt(task, {"source": source, "names": names})
        missing = again.max_points - again.points
        gain = max(0, again.points - result.points)
        line = built_on([(other.id, functions[other.id]) for other in broken], gain, missing)
        result.hung |= again.hung
        # without our functions the same call fails, and its answer may be shown
        own = result.message if again.failing == result.failing else ""
        below = own or again.message
        result.message = _lines(line, below) if gain else _lines(below, line)
        result.explain = partial(_of_both, line, own, again, gain)
        if gain:
            result.points, result.checks = again.points, again.checks
        return result

    def _digest(self) -> str:
        """Return a digest of this submission's content; "" if it cannot be copied."""
        try:
            files = content_digest(self._given, self._sources)
        except (Wrong, OSError):
            return ""
        return files.hexdigest()

    def _prepare(self) -> None:
        defined = None
        if self._sources is not None or self._gives_builtins():
            everything, defined = scripts(self._cells() if self._sources is None else self._sources)
            if self._sources is not None or everything.undone:
                self._write(everything)
                self.banner = "\n".join(map(self._undone, everything.undone))
        with suppress(OSError):
            self._lost |= names_in_other_cells(self._given, self._text())
        file = self._file if self._script else self._given
        place = self._place if self._script else None
        trouble = tried_twice(partial(trouble_of, file, self._server, Origin(place)), self._alone)
        if trouble is None:
            return
        banner = getattr(trouble, "banner", str(trouble))
        if self._sources is not None:
            banner = banner.replace("Your file", "The notebook", 1)
        self.banner = "\n".join(filter(None, [banner, self.banner]))
        if defined is None:
            _, defined = scripts(self._cells())
        parts = self._sources if self._sources is not None else _CELL.split(self._text())
        broken = [self._not_python(parts, *place) for place in defined.left_out]
        if broken:
            what = "Your file" if self._sources is None else "The notebook"
            newer = all(NEWER in error for _, _, _, error, _ in defined.left_out)
            head = "is not Python yet. Mend this first:"
            if newer:
                head = "needs a newer Python than the one that grades. This cannot be read:"
            self.banner = "\n".join([f"{what} {head}", *broken])
        strict = broken and os.environ.get(SYNTAX) == EVERYTHING
        if strict or not _DEFINITION.search(defined.text):
            raise Wrong(_NOT_GRADED)
        self._write(defined)
        self._in_parts = True
        self.banner += (
            "\nUntil then, only functions, classes and imports count, with the names that they use."
        )
        lost = [name for *_, names in defined.left_out for name in names]
        for name, line, said in left_out_of(self._file, self._server, self._origin()):
            lost.append(name)
            self._lost[name] = f"{self._place(line)} raised {said}"
        if lost:
            self.banner += f"\nLeft out: {', '.join(dict.fromkeys(lost))}."

    def _undone(self, place: list) -> str:
        """Return some lines on a name of Python that has been given another value."""
        number, line, name = place
        return (
            f"You give Python's name {name} another value, but your functions need Python's own.\n"
            f"  {self._at(number, line)}: choose another name."
        )

    def _not_python(
        self, parts: list[str], number: int, line: int, column: int, error: str, names: list[str]
    ) -> str:
        """Return some lines on a statement that is left out; keep the names of its functions."""
        lines, where = parts[number - 1].splitlines(), self._at(number, line)
        text = lines[line - 1] if line <= len(lines) else ""
        why = f"{where} is not Python ({error}): mend this line first"
        if not re.match(r"\w+Error: ", error):
            why = f"{where}: {error}"
        self._lost |= dict.fromkeys(names, why)
        return f"{marked(where, plain(text.expandtabs(4)), column)}\n  {error}"

    def _gives_builtins(self) -> bool:
        with suppress(OSError):
            return gives_builtins(self._text())
        return False

    def _text(self) -> str:
        content = read_inside(self._given.parent, self._given.name, MAX_COPIED)
        return content.decode("utf-8", "replace").replace("\r\n", "\n").replace("\r", "\n")

    def _cells(self) -> list[str]:
        """Return a script's cells; store the line before each."""
        cells = _CELL.split(self._text())
        self._starts = [0]
        for cell in cells:
            self._starts.append(self._starts[-1] + cell.count("\n"))
        return cells

    def _write(self, script: Script) -> None:
        if self._script is None:
            self._file.parent.mkdir()
            for path in submission_files(self._given):
                name = path.relative_to(self._given.parent)
                place = self._file.parent / name
                if path != self._given and path.suffix != ".ipynb" and place != self._file:
                    place.parent.mkdir(parents=True, exist_ok=True)
                    place.write_bytes(read_inside(self._given.parent, name, MAX_COPIED))
        self._script = script
        self._file.write_bytes(script.text.encode("utf-8", "replace"))

    def _place(self, line: int) -> str:
        """Return the place of a script's line: in the file, or in a cell of the notebook."""
        if not 1 <= line <= len(self._script.places):
            return f"line {line}"
        return self._at(*self._script.places[line - 1])

    def _at(self, number: int, line: int) -> str:
        """Return words for a line of a part: of the file, or of a notebook's cell."""
        if self._sources is None:
            return f"{self._given.name}:{self._starts[number - 1] + line}"
        lines = [line.strip() for line in self._sources[number - 1].splitlines() if line.strip()]
        shown = lines[0] if lines else ""
        return f"line {line} of the cell '{shown[:40]}{'...' if len(shown) > 40 else ''}'"


def _lines(*parts: str) -> str:
    return "\n".join(filter(None, parts))


def _of_both(line: str, own: str, again: TaskResult, gain: int) -> tuple[str, str]:
    """Return the cause of a failure with our functions, and the whole message.

    line: on the tasks that this one builds on. own: what failed without our functions, if that is
    the same call. gain: the points that it gets by our functions.
    """
    again.complete()
    below = _lines(again.cause, own) if own else again.message
    return again.cause, _lines(line, below) if gain else _lines(below, line)
