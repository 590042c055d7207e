"""Show what is made: by a finished exercise as a whole, by its done tasks, or by one task."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
import time
import webbrowser
from collections import Counter
from pathlib import Path

from botschool.console import Console
from botschool.errors import BotschoolError
from botschool.grading.copies.release import MANIFEST
from botschool.grading.copies.starting import living_page
from botschool.grading.declare.checks import plain
from botschool.grading.declare.exercise import Exercise, Task, load_exercise, submission_file
from botschool.grading.report.album import Shown, captioned, write_album
from botschool.grading.report.checkpoints import WRONG, checkpoints
from botschool.grading.run.notebooks import code_cells
from botschool.grading.run.temporary import PREFIX
from botschool.paths import course_root

_UNFINISHED = re.compile(r"^ *raise NotImplementedError\([\"']task (\d+\.\d+)\b", re.MULTILINE)
"""The line that stands for a missing answer in a skeleton."""
_RUN = """
import sys
del sys.argv[0]
__file__ = sys.argv[0]
sys.path = [*filter(None, sys.path), __file__.rpartition("/")[0]]
exec(compile(open(__file__, "rb").read(), __file__, "exec"))
"""
"""Runs a file as a program. Python's own modules come before files beside it, as in grading."""
_PATIENCE = 30
"""Seconds between two messages that a long run continues."""


def show(number: int, file: Path | None = None, root: Path | None = None) -> list[Path]:
    """Run a script or a notebook (None: the student's own); return the files it has made.

    A line on stderr says every 30 seconds that it still runs. Raises BotschoolError if tasks of the
    file are not done yet, or if it ends with an error.
    """
    root = (root or course_root()).resolve()
    load_exercise(number, root).require()
    file = (file or submission_file(number, None, root)).resolve()
    if file.suffix == ".ipynb":
        file = _script_of(file)
    if tasks := unfinished(file):
        raise BotschoolError(f"{not_done(tasks)} in {file.name}: botschool grade {number}.")
    folder = root / "results" / f"ex{number:02d}"
    folder.mkdir(parents=True, exist_ok=True)
    before = _stamps(folder)
    variables = {"BOTSCHOOL_COURSE": str(root)}
    if not os.environ.get("DISPLAY"):
        variables["MPLBACKEND"] = "Agg"
    # PyTorch's threads fight for busy cores
    if _run(file, folder, {"OMP_NUM_THREADS": "1"} | os.environ | variables) != 0:
        raise BotschoolError(
            f"{file.name} ended with an error (see above): check with 'botschool grade "
            f"{number}' that it is finished."
        )
    return [path for path, stamp in _stamps(folder).items() if before.get(path) != stamp]


def _script_of(notebook: Path) -> Path:
    """Write a notebook's code as a script in a folder of its own; return the script."""
    script = Path(tempfile.mkdtemp(prefix=PREFIX)) / notebook.with_suffix(".py").name
    script.write_text("\n\n\n".join(code_cells(notebook)) + "\n", encoding="utf-8")
    return script


def unfinished(file: Path) -> list[str]:
    """Return the tasks whose answer in the skeleton is still missing."""
    if file.suffix == ".ipynb":
        text = "\n".join(code_cells(file))
    else:
        text = file.read_text(encoding="utf-8", errors="replace")
    return list(dict.fromkeys(_UNFINISHED.findall(text)))


def not_done(tasks: list[str]) -> str:
    """Return the beginning of a sentence on unfinished tasks."""
    named = f"task {tasks[0]} is" if len(tasks) == 1 else f"tasks {', '.join(tasks)} are"
    return f"{named} not done yet"


def _run(file: Path, folder: Path, variables: dict[str, str]) -> int:
    """Run a file in a folder and return its exit code; say regularly that it still runs."""
    start = time.monotonic()
    command = [sys.executable, "-c", _RUN, str(file)]
    with subprocess.Popen(command, cwd=folder, env=variables) as process:
        while True:
            try:
                return process.wait(_PATIENCE)
            except subprocess.TimeoutExpired:
                seconds = time.monotonic() - start
                print(f"({file.name} runs, {seconds:.0f} s; Ctrl-C stops it)", file=sys.stderr)
            except BaseException:
                process.terminate()
                raise


def _stamps(folder: Path) -> dict[Path, int]:
    return {path: path.stat().st_mtime_ns for path in sorted(folder.rglob("*")) if path.is_file()}


def show_whole(exercise: Exercise, file: Path, root: Path) -> Path | None:
    """Run a finished file, name what it has made, and return its page; None if it has none."""
    made, folder = show(exercise.number, file, root), _folder(exercise, root)
    tops = Counter(path.relative_to(folder).parts[0] for path in made)
    for name, files in tops.items():
        size = f"{(folder / name).stat().st_size / 1000:.0f} kB"
        what = f"{files} files" if (folder / name).is_dir() else size
        print(f"made: {os.path.relpath(folder / name)}  ({what})")
    shown = captioned(exercise, [path for path in made if path.parent == folder], root)
    return write_album(exercise, shown, folder, root, "") if shown else None


def _folder(exercise: Exercise, root: Path) -> Path:
    return root / "results" / f"ex{exercise.number:02d}"


def show_done(exercise: Exercise, file: Path, root: Path) -> Path:
    """Draw the done tasks of an unfinished file, say which come next, and return their page.

    Raises BotschoolError if no task is done that has a picture.
    """
    undone, shown = unfinished(file), []
    folder = _folder(exercise, root)
    done = [task for task in exercise.tasks if task.id not in undone]
    for drawn in checkpoints(exercise, done, file):
        id, title, says = drawn.task.id, drawn.task.title, drawn.task.picture.says
        if not drawn.panels:
            continue
        if drawn.state == WRONG:
            says = f"Not right yet, as `botschool grade {id}` explains. It should be: {says}"
        print(f"  {'✗' if drawn.state == WRONG else '✓'} {id} {title}")
        shown.append(Shown(drawn.save(folder), f"**{id} {title}.** {says}"))
    following = exercise.find(undone[0])
    draws = next((e for e in exercise.tasks if e.id in undone and e.picture), None)
    more = f"Task {following.id}, {following.title}, comes next."
    if draws is not None:
        more += f" Task {draws.id} adds: {draws.picture.says}"
    if not shown:
        raise BotschoolError(
            f"{not_done(undone)} in {file.name}, so there is nothing to draw yet. {more}"
        )
    print(more)
    return write_album(
        exercise, shown, folder, root, f"{more} Then: `botschool show {exercise.number}`"
    )


def show_one(exercise: Exercise, task: Task, file: Path, root: Path) -> Path:
    """Draw a task's answers, say what one sees, and return the picture. Raises BotschoolError."""
    exercise.require([task])
    if task.picture is None:
        have = ", ".join(each.id for each in exercise.tasks if each.picture)
        raise BotschoolError(
            f"Task {task.id} has no picture of its own; these have one: {have}. "
            f"'botschool show {exercise.number}' shows what the finished exercise makes."
        )
    drawn = next(checkpoints(exercise, [task], file))
    if not drawn.panels:
        raise BotschoolError(f"Task {task.id} cannot be drawn: {plain(drawn.message)}")
    print(f"Task {task.id}. {task.title}: {drawn.state}. {plain(drawn.message)}".rstrip())
    if drawn.state == WRONG:
        print("Orange is your answer, grey what is expected.")
    print(f"{'Expected' if drawn.state == WRONG else 'You see'}: {task.picture.says}")
    return drawn.save(_folder(exercise, root))


def open_page(page: Path) -> bool:
    """Open a page in the browser ($BROWSER or the system's); return False without a display.

    The function calls xdg-open, open or the like, depending on the system.
    """
    if sys.platform in ("darwin", "win32"):
        there = "SSH_CONNECTION" not in os.environ
    else:
        there = any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))
    return there and webbrowser.open(page.as_uri())


def lead_to_page(number: int, root: Path, console: Console, opens: bool) -> None:
    """Print where the living page of an exercise is, and open it."""
    try:
        page = living_page(number, root)
    except BotschoolError as error:
        copy = "This copy has none; whoever made it can add it."
        why = copy if (root / MANIFEST).is_file() else error
        console.print(f"  {'See':<11}the text as a page with figures: {why}", markup=False)
        return
    if page:
        note = " (opened in your browser)" if opens and open_page(page.resolve()) else ""
        console.print(f"  {'See':<11}{os.path.relpath(page)}{note}", markup=False)
