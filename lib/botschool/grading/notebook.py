"""Grade a notebook: test cells call `grade_cell`, and the notebook's code is the submission."""

from __future__ import annotations

import contextlib
import io
import os
import re
import warnings
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.exercise import Exercise, Task, course_root, load_exercise
from botschool.grading.declare.state import secret_for_others
from botschool.grading.judge.points import GraderFault
from botschool.grading.judge.submission import Submission, TaskResult
from botschool.grading.run.confined import MachineFault, close_class, fork_server
from botschool.grading.run.notebooks import code_cells

MAX_PRINTED = 1500
"""Characters to show of what a task's code printed."""


def report(result: TaskResult, banner: str = "") -> str:
    """Return what a test cell prints; banner: why the notebook cannot be loaded."""
    lines = [banner] if banner and result.points < result.max_points else []
    lines += [f"Task {result.id}. {result.title}: {result.points} of {result.max_points} points"]
    if result.message:
        lines.append(result.message)
    printed = result.printed.strip()
    if printed:
        cut = " [...]" if len(printed) > MAX_PRINTED else ""
        lines += ["Printed by your code:", printed[:MAX_PRINTED] + cut]
    return "\n".join(lines)


def marks(name: str, points: float | None = None) -> dict[str, Any]:
    """Return nbgrader's metadata (schema 3) of an answer cell, or of a test cell with points."""
    test = points is not None
    marks = {
        "grade": test,
        "grade_id": name,
        "locked": test,
        "schema_version": 3,
        "solution": not test,
        "task": False,
    }
    return {"nbgrader": marks | ({"points": points} if test else {})}


class NotGraded(BotschoolError):
    """This machine cannot grade; a notebook shows the sentence without a traceback."""

    def _render_traceback_(self) -> list[str]:
        return [f"Not graded: {self}"]


def grade_cell(task: str) -> float:
    """Grade a task of the notebook in this folder, as saved; print why points are missing.

    Return the points, which nbgrader takes as partial credit. Raises NotGraded if this machine
    cannot grade, so that nbgrader does not count it as 0.
    """
    with contextlib.redirect_stderr(io.StringIO()), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return _grade_here(task)
        except (MachineFault, GraderFault, OSError) as error:
            raise NotGraded(str(error)) from None
        except NotGraded:
            raise
        except (BotschoolError, Wrong) as error:
            print(error)
            return 0.0


def _grade_here(task: str) -> float:
    number = task.partition(".")[0]
    if not number.isdigit():
        raise BotschoolError(f"'{task}' is not a task: name one, for example '3.2'.")
    try:  # the answer may be right, although this machine lacks something
        exercise = load_exercise(int(number))
        asked = exercise.find(task)
        exercise.require([asked])
    except BotschoolError as error:
        raise NotGraded(str(error)) from None
    _prepare_for_others(exercise)
    path = Path.cwd() / Path(exercise.file).with_suffix(".ipynb")
    sources = code_cells(path)
    if _changed(sources):
        print(
            "You have run code that is not saved: save the notebook (Ctrl+S), then run this cell "
            "again."
        )
    ((result, banner),) = graded(exercise, path, sources, [asked])
    print(report(result, banner))
    return float(result.points)


def graded(
    exercise: Exercise, path: Path, sources: list[str], tasks: list[Task]
) -> list[tuple[TaskResult, str]]:
    """Return the result of each task of a notebook, and why the notebook cannot be loaded."""
    with (
        fork_server(exercise.imports) as server,
        Submission(path, server, sources, exercise.file, exercise=exercise) as submission,
    ):
        results = [submission.grade(task).complete() for task in tasks]
        return [(result, submission.banner) for result in results]


def _prepare_for_others(exercise: Exercise) -> None:
    """Derive the seeds from a secret and close the class folder, if an instructor grades.

    An instructor's course has its solutions, or nbgrader runs the notebook.
    """
    root = course_root()
    if (root / "solutions").is_dir() or os.environ.get("NBGRADER_EXECUTION") == "autograde":
        exercise.secret, _ = secret_for_others(root)
    for folder in Path.cwd().parents:
        if (folder / "nbgrader_config.py").is_file():
            close_class(folder)


def _changed(sources: list[str]) -> bool:
    """Return whether the last run of a function differs from the saved notebook."""
    with contextlib.suppress(NameError, AttributeError):
        ran = get_ipython().history_manager.input_hist_raw  # type: ignore[name-defined]  # noqa: F821
        last = {name: cell.strip() for cell in ran for name in _defined(cell)}
        saved = {source.strip() for source in sources}
        names = {name for source in sources for name in _defined(source)}
        return any(last[name] not in saved for name in names if name in last)
    return False


def _defined(source: str) -> list[str]:
    return re.findall(r"^(?:def|class) (\w+)", source, re.MULTILINE)
