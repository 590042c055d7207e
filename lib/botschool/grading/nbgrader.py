"""Generate a course folder for nbgrader from the solutions."""

from __future__ import annotations

import glob
import os
import re
import sys
import textwrap
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.copies.skeleton import BEGIN, write_unedited
from botschool.grading.declare.exercise import (
    PICTURES,
    Exercise,
    course_root,
    exercise_numbers,
    folder_of,
    load_exercise,
)
from botschool.grading.notebook import marks
from botschool.grading.packed import pack
from botschool.grading.run.confined import close_class
from botschool.output import save_bytes

CONFIG = "nbgrader_config.py"
GENERATED = ".generated.json"
"""A file in the course folder: the digest of every generated notebook, to recognise edited ones."""
_CONFIG_TEXT = '''\
"""Configure nbgrader for this course. `make nbgrader` made this file once; you can edit it."""

from pathlib import Path

from botschool.grading.nbgrader import configure

c = get_config()  # noqa: F821
here = Path(__file__).resolve().parent
configure(c, here, course={course})
'''
_HOW_TO = """\
This is the exercise as a notebook. Write your code where `NotImplementedError` is raised; then
save the notebook (Ctrl+S) and run the cell below the task: it prints your points for the task,
and why some are missing. Run `botschool trust .` once in this folder, in a terminal: this lets
botschool run the grader beside this notebook. `botschool hint N.T` gives hints. You can add cells
anywhere; keep slow code out of the cells that define functions."""


def nbgrader_command(folder: Path) -> None:
    """Make the course folder and print how to use it."""
    for path in make_course(course_root(), folder):
        print(f"not changed, because it was edited: {path}")
    command = os.path.relpath(Path(sys.executable).parent / "nbgrader", folder.resolve())
    print(
        f"Course folder: {folder}   In it, for exercise 3:\n"
        f"  {command} generate_assignment ex03   makes release/ex03, what students get\n"
        f"  {command} autograde ex03             grades submitted/STUDENT/ex03\n"
        f"  {command} generate_feedback ex03     writes feedback/STUDENT/ex03\n"
        f"  {command} export                     writes grades.csv"
    )


def make_course(root: Path, folder: Path) -> list[Path]:
    """Write nbgrader's configuration and source notebooks; return the notebooks left alone.

    The function leaves edited notebooks and an existing configuration as they are. Raises
    BotschoolError.
    """
    try:
        import nbformat
    except ImportError:
        raise BotschoolError(
            "nbgrader and jupytext are missing: install them with pip install 'botschool[course]'."
        ) from None
    numbers = [n for n in exercise_numbers(root) if _solution(root, n).is_file()]
    if not numbers:
        raise BotschoolError(
            f"{root} holds no solutions to make notebooks of: run this in the repository."
        )
    texts = {}
    for number in numbers:
        exercise = load_exercise(number, root)
        solution = _solution(root, number)
        made = nbformat.writes(notebook(solution.read_text(encoding="utf-8"), exercise)) + "\n"
        own = {f"{solution.stem}.ipynb": made} | _beside(folder_of(number, root), exercise)
        texts |= {f"source/ex{number:02d}/{inner}": text for inner, text in own.items()}
    edited = write_unedited(folder, texts, folder / GENERATED)
    if not (folder / CONFIG).exists():
        course = os.path.relpath(root.resolve(), folder.resolve())
        text = _CONFIG_TEXT.format(course=f'here / "{course}"')
        save_bytes(folder / CONFIG, text.encode())
    return edited


def _beside(folder: Path, exercise: Exercise) -> dict[str, str]:
    """Return the files that let a student grade away from the repository: a course of its own.

    These are the packed grader, the text and the hints, as path from the notebook -> content.
    """
    found = {}
    for path in sorted([*folder.glob("test_*.py"), *folder.glob(PICTURES), *folder.glob("*.md")]):
        text = path.read_text(encoding="utf-8")
        packed = path.name.startswith("test_") and "unpack(" not in text
        place = f"exercises/{folder.name}/{path.name}"
        found[place] = pack(text, exercise.references) if packed else text
    return found


def configure(c: Any, folder: Path, course: Path) -> None:
    """Set nbgrader's options for a course folder made from the repository `course`."""
    from nbconvert.preprocessors.sanitize import SanitizeHTML
    from nbgrader.converters import Autograde, GenerateAssignment, GenerateFeedback
    from nbgrader.coursedir import CourseDirectory
    from nbgrader.preprocessors import ClearSolutions, Execute

    from botschool.grading.copies.preprocessors import (
        ClearToSkeleton,
        Grade,
        Restore,
        TolerantExporter,
    )

    os.environ["BOTSCHOOL_COURSE"] = str(Path(course).resolve())
    close_class(folder)
    # nbgrader calls `alembic` by its name alone, which lies beside it
    os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    c.CourseDirectory.course_id = "botschool"
    c.CourseDirectory.root = str(folder)
    c.CourseDirectory.ignore = [
        *_default(CourseDirectory, "ignore"),
        *map(glob.escape, _links(folder / "submitted")),  # links may lead to solutions
    ]
    c.GenerateAssignment.preprocessors = [
        ClearToSkeleton if step is ClearSolutions else step
        for step in _default(GenerateAssignment, "preprocessors")
    ]
    c.Autograde.exporter_class = TolerantExporter
    c.Autograde.sanitize_preprocessors = [Restore, *_default(Autograde, "sanitize_preprocessors")]
    c.Autograde.autograde_preprocessors = [
        Grade if step is Execute else step
        for step in _default(Autograde, "autograde_preprocessors")
    ]
    c.Autograde.exclude_overwriting = {
        path.name: [file.name for file in path.glob("*.py")]
        for path in (folder / "source").glob("ex[0-9][0-9]")
    }
    c.Execute.timeout = 120
    c.GenerateFeedback.preprocessors = [
        SanitizeHTML,  # of students' text cells
        *_default(GenerateFeedback, "preprocessors"),
    ]
    c.SanitizeHTML.enabled = True


def notebook(solution: str, exercise: Exercise) -> Any:
    """Return an exercise's source notebook: the solution, each task followed by its test cell."""
    import jupytext
    from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

    taken: set[str] = set()
    last: dict[str, int] = {}
    cells = []
    for given in jupytext.reads(solution, fmt="py:percent").cells:
        tasks = list(dict.fromkeys(re.findall(rf"{BEGIN} task (\d+\.\d+):", given.source)))
        if given.cell_type != "code":
            cell = new_markdown_cell(given.source, id=_slug(given.source, taken))
        elif not tasks:
            cell = new_code_cell(given.source, id=_slug(given.source, taken))
        else:
            name = _unused("task-" + "-".join(task.replace(".", "-") for task in tasks), taken)
            cell = new_code_cell(given.source, id=name, metadata=marks(name))
        cells.append(cell)
        if len(cells) == 1:
            cells.append(new_markdown_cell(_HOW_TO, id=_unused("how-to", taken)))
        last.update({task: len(cells) for task in tasks})
    if set(last) - {task.id for task in exercise.tasks}:
        raise BotschoolError(
            f"Exercise {exercise.number}: the solution's tasks differ from the grader's."
        )
    place = 0
    after: dict[int, list[Any]] = {}
    for task in exercise.tasks:
        place = max(place, last.get(task.id, 0))
        title = "-".join(re.findall(r"[a-z0-9]+", task.title.lower()))[:40]
        name = _unused(f"test-{task.id.replace('.', '-')}_{title}", taken)  # nbgrader shows it
        text = textwrap.dedent(f"""\
            # Task {task.id}, {task.max_points} points: save the notebook, then run this cell.
            from botschool.grading.notebook import grade_cell

            grade_cell("{task.id}")""")
        test = new_code_cell(text, id=name, metadata=marks(name, task.max_points))
        after.setdefault(place, []).append(test)
    ordered = [each for at, cell in enumerate(cells, 1) for each in (cell, *after.get(at, []))]
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    metadata = {"kernelspec": kernel, "language_info": {"name": "python"}}
    return new_notebook(cells=ordered, metadata=metadata)


def _slug(text: str, taken: set[str]) -> str:
    """Return a cell id from the cell's first line, the same in every generation."""
    words = re.findall(r"[a-z0-9]+", next(iter(text.strip().splitlines()), "").lower())
    return _unused("-".join(["cell", *words])[:50].rstrip("-"), taken)


def _unused(name: str, taken: set[str]) -> str:
    candidate, count = name, 1
    while candidate in taken:
        count += 1
        candidate = f"{name}-part-{count}"
    taken.add(candidate)
    return candidate


def _default(application: Any, option: str) -> list[Any]:
    return list(application.class_traits()[option].default())


def _links(folder: Path) -> list[str]:
    """Return the symbolic links among the files of submissions."""
    found = (os.path.join(top, name) for top, _, names in os.walk(folder) for name in names)
    return [path for path in found if os.path.islink(path)]


def _solution(root: Path, number: int) -> Path:
    folder = root / "solutions" / folder_of(number, root).name
    return folder / load_exercise(number, root).file
