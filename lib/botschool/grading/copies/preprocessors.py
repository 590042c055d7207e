"""Replace parts of nbgrader's pipeline by our own.

`configure` (nbgrader.py) installs them.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import nbformat
from nbconvert.exporters import NotebookExporter
from nbformat import NotebookNode
from nbformat.v4 import (
    new_code_cell,
    new_markdown_cell,
    new_notebook,
    new_output,
    new_raw_cell,
)
from nbgrader.api import Gradebook
from nbgrader.preprocessors import NbGraderPreprocessor

from botschool.errors import BotschoolError
from botschool.grading.copies.skeleton import BEGIN, skeleton
from botschool.grading.declare.exercise import course_root, load_exercise
from botschool.grading.declare.state import secret_for_others
from botschool.grading.judge.submission import TaskResult
from botschool.grading.notebook import graded, marks, report

ANSWER, TEST = "task-", "test-"
"""Prefixes of the grade ids of answer cells and test cells; test-3-2_ranking tests task-3-2."""

MAX_NOTEBOOK = 50 * 2**20
"""Bytes of a notebook with its pictures."""
UNREADABLE = "The submission is not a notebook, or is too large: there is nothing to grade."


def task_of(grade_id: str) -> str:
    """Return the task that a test cell grades: 3.2 for test-3-2_ranking."""
    return grade_id.removeprefix(TEST).partition("_")[0].replace("-", ".")


class ClearToSkeleton(NbGraderPreprocessor):
    """Replace solution regions as in the skeletons, so that notebooks and scripts say the same."""

    def preprocess_cell(self, cell: NotebookNode, resources: dict, index: int) -> tuple:
        if cell.cell_type == "code" and BEGIN in cell.source:
            cell.source = skeleton(cell.source).rstrip("\n")
        return cell, resources


class TolerantExporter(NotebookExporter):
    """Read any file as a notebook; a file that is none becomes a notebook without cells."""

    def from_filename(self, filename: str, resources: dict | None = None, **options: Any) -> tuple:
        return super().from_filename(filename, resources, linked=os.path.islink(filename))

    def from_file(self, stream: Any, resources: dict | None = None, linked: bool = False) -> tuple:
        try:
            if linked or os.fstat(stream.fileno()).st_size > MAX_NOTEBOOK:
                raise ValueError
            nb = nbformat.read(stream, as_version=4)
            metadata, _ = dict(nb.metadata), list(nb.cells)
        except Exception:  # for a file that may hold anything
            nb, metadata = new_notebook(cells=[new_markdown_cell(UNREADABLE)]), {}
        kernel = {name: metadata[name] for name in ("kernelspec",) if name in metadata}
        nb.metadata = NotebookNode(kernel, language_info={"name": "python"})
        return self.from_notebook_node(nb, resources=resources)


class Restore(NbGraderPreprocessor):
    """Rebuild a submitted notebook from the texts of its cells.

    The result has each answer and test cell of the assignment once, with the assignment's points,
    whatever happened to metadata, test cells and outputs.
    """

    def preprocess(self, nb: NotebookNode, resources: dict) -> tuple[NotebookNode, dict]:
        told = resources["nbgrader"]
        with Gradebook(told["db_url"]) as gradebook:
            notebook = gradebook.find_notebook(told["notebook"], told["assignment"])
            points = {cell.name: cell.max_score for cell in notebook.grade_cells}
            known = {
                cell.name: _assignment_cell(cell, points.get(cell.name))
                for cell in notebook.source_cells
            }
        tests = {name: cell for name, cell in known.items() if name in points}
        answers = {name: cell for name, cell in known.items() if name not in points}
        cells = []
        for index, (kind, source, grade_id) in enumerate(map(_read, nb.get("cells", [])), 1):
            if grade_id in tests or source in [test.source for test in tests.values()]:
                continue
            if kind == "code" and grade_id in answers:
                cell = answers.pop(grade_id)
                cell.source = source
            else:
                make = {"code": new_code_cell, "raw": new_raw_cell}.get(kind, new_markdown_cell)
                cell = make(source, id=f"cell-{index}")
            cells.append(cell)
        for name, test in tests.items():
            cells.insert(_place(cells, task_of(name)), test)
        return new_notebook(cells=cells, metadata={"language_info": {"name": "python"}}), resources


def _assignment_cell(source: Any, points: float | None) -> NotebookNode:
    """Return an answer cell (no points) or a test cell, as the gradebook knows it."""
    metadata = marks(source.name, points) | {"deletable": False, "editable": points is None}
    return new_code_cell(source.source, id=source.name, metadata=metadata)


def _read(cell: Any) -> tuple[str, str, str]:
    """Return kind, text and grade id of a cell that may be anything."""
    cell = cell if isinstance(cell, dict) else {}
    source = cell.get("source", "")
    if isinstance(source, list):
        source = "".join(part for part in source if isinstance(part, str))
    grade_id: Any = cell
    for key in ("metadata", "nbgrader", "grade_id"):
        grade_id = grade_id.get(key) if isinstance(grade_id, dict) else None
    source = source if isinstance(source, str) else ""
    source = source.encode("utf-8", "replace").decode()
    return str(cell.get("cell_type")), source, str(grade_id)


def _place(cells: list[NotebookNode], task: str) -> int:
    """Return the index for a task's test: after the last cell that belongs to no later task."""
    later, place = len(cells), 0
    for index, cell in reversed(list(enumerate(cells))):
        if grade_id := _grade_id(cell):
            if _order(task_of(grade_id.removeprefix(ANSWER))) > _order(task):
                later = index
            else:
                place = max(place, index + 1)
    return place or later


def _order(task: str) -> list[int]:
    return [int(part) for part in task.split(".")[:2] if part.isdigit()]


class Grade(NbGraderPreprocessor):
    """Fill in the outputs of test cells instead of running the notebook.

    The isolated grader takes the code from the notebook. nbgrader's kernel runs none of it, so
    nothing that a notebook does to its kernel matters.
    """

    def preprocess(self, nb: NotebookNode, resources: dict) -> tuple[NotebookNode, dict]:
        tests = [cell for cell in nb.cells if _grade_id(cell).startswith(TEST)]
        sources = [
            cell.source for cell in nb.cells if cell.cell_type == "code" and cell not in tests
        ]
        if not tests:
            raise BotschoolError("The assignment has no test cells: generate it again.")
        exercise = load_exercise(int(task_of(_grade_id(tests[0])).partition(".")[0]))
        exercise.require(exercise.tasks)
        exercise.secret, _ = secret_for_others(course_root())
        name = resources["nbgrader"]["notebook"] + ".ipynb"
        path = Path(resources["metadata"]["path"]) / name
        tasks = [exercise.find(task_of(_grade_id(cell))) for cell in tests]
        results = graded(exercise, path, sources, tasks)
        for count, (cell, told) in enumerate(zip(tests, results, strict=True), 1):
            _fill(cell, count, *told)
        return nb, resources


def _grade_id(cell: NotebookNode) -> str:
    return cell.metadata.get("nbgrader", {}).get("grade_id", "")


def _fill(cell: NotebookNode, count: int, result: TaskResult, banner: str) -> None:
    if float(cell.metadata.nbgrader["points"]) != result.max_points:
        raise BotschoolError(
            f"Task {result.id} is now worth {result.max_points} points, but not in the "
            "assignment: run make nbgrader and nbgrader generate_assignment --force."
        )
    cell.execution_count = count
    points = repr(float(result.points))
    cell.outputs = [
        new_output("stream", name="stdout", text=report(result, banner) + "\n"),
        new_output("execute_result", {"text/plain": points}, execution_count=count),
    ]
