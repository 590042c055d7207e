"""Grading in a notebook: what its test cells call, and its code as a submission."""

from __future__ import annotations

import contextlib
import io
import json
import re
import shutil
import tempfile
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.cells import Script, Unreadable, scripts
from botschool.grading.checks import Wrong
from botschool.grading.exercise import Exercise, TaskResult, grade_task, load_exercise
from botschool.grading.scratch import submission_files
from botschool.grading.student import Student

LOADING_SECONDS = 10
"""Time for all that a notebook's cells do besides defining functions, when it is graded."""
LONGEST_PRINTED = 1500
"""Characters of what a task's code printed that are shown."""
_LINE = re.compile(r" in line (\d+)")
_FILE = re.compile(r" \(\w+\.py, line \d+\)")


class NotebookSubmission:
    """The code cells of a notebook as a submission's file, and what is to be said of it."""

    def __init__(self, exercise: Exercise, file: Path, sources: list[str]) -> None:
        self._exercise = exercise
        self._file = file
        self._sources = sources
        self._notes: list[str] = []
        self._script = Script()
        self._failure = ""

    def prepare(self) -> None:
        """Writes the file: all that the cells hold if that can be loaded, else what they define."""
        try:
            everything, defined = scripts(self._sources)
        except Unreadable as error:
            self._failure = str(error)
            return
        self._write(everything)
        trouble = _trouble(self._file)
        if trouble:
            trouble = self._with_cells(trouble).removeprefix("Your file cannot be loaded: ")
            self._write(defined)
            self._notes.append(
                f"The notebook as a whole cannot be run ({trouble.rstrip('.')}), so only its "
                "functions, classes and imports count, with the names that these use."
            )
            for number in defined.left_out:
                self._notes.append(f"{self._cell(number).capitalize()} is no Python: left out.")

    def grade(self, task: str) -> TaskResult:
        """Grades a task, as `botschool grade` does; the message names cells and their lines."""
        asked = self._exercise.find(task)
        if self._failure:
            return TaskResult(asked.id, asked.title, 0, asked.max_points, self._failure)
        result = grade_task(asked, self._file)
        result.message = self._with_cells(result.message)
        if result.message:
            result.message = "\n".join([result.message, *self._notes])
        return result

    def _write(self, script: Script) -> None:
        self._script = script
        self._file.write_bytes(script.text.encode("utf-8", "replace"))

    def _with_cells(self, message: str) -> str:
        def place(found: re.Match) -> str:
            line = int(found[1])
            if not 1 <= line <= len(self._script.places):
                return found[0]
            number, inside = self._script.places[line - 1]
            return f" in line {inside} of {self._cell(number)}"

        return _LINE.sub(place, _FILE.sub("", message))

    def _cell(self, number: int) -> str:
        lines = [line.strip() for line in self._sources[number - 1].splitlines() if line.strip()]
        shown = lines[0] if lines else ""
        return f"the cell '{shown[:40]}{'...' if len(shown) > 40 else ''}'"


@contextmanager
def notebook_submission(
    exercise: Exercise, notebook: Path, sources: list[str]
) -> Iterator[NotebookSubmission]:
    """A notebook's code, ready to be graded in a copy of its folder that is removed at the end.

    sources: the texts of its code cells. Raises Wrong when the folder is too large.
    """
    base = Path(tempfile.mkdtemp(prefix="botschool-"))
    try:
        file = base / "submission" / exercise.file
        file.parent.mkdir()
        for path in submission_files(notebook):
            place = file.parent / path.relative_to(notebook.parent)
            if path.suffix != ".ipynb" and place != file:
                place.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(path, place, follow_symlinks=False)
        submission = NotebookSubmission(exercise, file, sources)
        submission.prepare()
        yield submission
    finally:
        shutil.rmtree(base, ignore_errors=True)


def _trouble(file: Path) -> str:
    """Why a submission's file cannot be loaded, in a sentence; "" if it can."""

    def loads(module):
        return True

    student = Student(file, LOADING_SECONDS)
    try:
        student.run(loads, said="the code outside functions")
    except Wrong as error:
        return str(error)
    finally:
        student.close()
    return ""


def code_cells(path: Path) -> list[str]:
    """The texts of a notebook's code cells. Raises BotschoolError."""
    try:
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        code = [cell["source"] for cell in cells if cell["cell_type"] == "code"]
        return ["".join(source) for source in code]
    except (OSError, ValueError, LookupError, TypeError, RecursionError):
        raise BotschoolError(
            f"There is no notebook {path.name} in the folder {path.parent}: save it there under "
            "this name, then run this cell again."
        ) from None


def report(result: TaskResult) -> str:
    """What a test cell prints."""
    lines = [f"Task {result.id}. {result.title}: {result.points} of {result.max_points} points"]
    if result.message:
        lines.append(result.message)
    printed = result.printed.strip()
    if printed:
        cut = " [...]" if len(printed) > LONGEST_PRINTED else ""
        lines += ["Printed by your code:", printed[:LONGEST_PRINTED] + cut]
    return "\n".join(lines)


def grade_cell(task: str) -> float:
    """Grades a task of the notebook in the present folder, as saved; prints why points are missing.

    Returns the points, so that nbgrader gives them as partial credit.
    """
    with contextlib.redirect_stderr(io.StringIO()), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return _grade_here(task)
        except (BotschoolError, Wrong, OSError) as error:
            print(error)
            return 0.0


def _grade_here(task: str) -> float:
    number = task.partition(".")[0]
    if not number.isdigit():
        raise BotschoolError(f"'{task}' names no task: give one as '3.2'.")
    exercise = load_exercise(int(number))
    exercise.find(task)
    path = Path.cwd() / Path(exercise.file).with_suffix(".ipynb")
    sources = code_cells(path)
    if _changed(sources):
        print("What you ran is not what is saved: save the notebook (Ctrl+S), run this cell again.")
    with notebook_submission(exercise, path, sources) as submission:
        result = submission.grade(task)
    print(report(result))
    return float(result.points)


def _changed(sources: list[str]) -> bool:
    """Whether a function was last run in a form that the saved notebook does not hold."""
    with contextlib.suppress(NameError, AttributeError):
        ran = get_ipython().history_manager.input_hist_raw  # noqa: F821
        last = {name: cell.strip() for cell in ran for name in _defined(cell)}
        saved = {source.strip() for source in sources}
        names = {name for source in sources for name in _defined(source)}
        return any(last[name] not in saved for name in names if name in last)
    return False


def _defined(source: str) -> list[str]:
    return re.findall(r"^(?:def|class) (\w+)", source, re.MULTILINE)
