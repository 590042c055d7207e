"""Run a finished exercise as a whole in results/exNN, and show what it has made."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
import time
import webbrowser
from html import escape
from pathlib import Path
from urllib.parse import quote

from botschool.errors import BotschoolError
from botschool.grading.declare.exercise import load_exercise, submission_file
from botschool.grading.run.notebooks import code_cells
from botschool.grading.run.temporary import PREFIX
from botschool.output import save_bytes
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
PAGE = "all.html"
"""The page in results/exNN that shows everything the run has made."""
_TAGS = {
    ".png": '<img src="{0}" alt="{1}">',
    ".mp4": '<video src="{0}" controls loop></video>',
    ".html": '<iframe src="{0}" title="{1}"></iframe>',
}
_STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; max-width: 1100px; margin: 2rem auto; padding: 0 1rem }
img, video { max-width: 100% } iframe { width: 100%; height: 36rem; border: 1px solid #ccc }
figure { margin: 2rem 0 } figcaption { color: #555 }
"""


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
    _require_finished(file, number)
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


def _require_finished(file: Path, number: int) -> None:
    """Raise BotschoolError if an answer in the skeleton is still missing."""
    tasks = list(
        dict.fromkeys(_UNFINISHED.findall(file.read_text(encoding="utf-8", errors="replace")))
    )
    if tasks:
        named = f"task {tasks[0]} is" if len(tasks) == 1 else f"tasks {', '.join(tasks)} are"
        raise BotschoolError(
            f"{named} not done yet in {file.name}. 'botschool show {number}' runs a finished "
            f"file; 'botschool grade {number}' lists the finished tasks."
        )


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


def make_page(number: int, made: list[Path]) -> Path | None:
    """Write PAGE with the pictures, films and replays of `made`; return None if there are none.

    Files in folders of results/exNN, such as the folders of runs, are left out. Raises
    BotschoolError.
    """
    root = course_root().resolve()
    title = f"Exercise {number}. {load_exercise(number, root).title}"
    folder = root / "results" / f"ex{number:02d}"
    shown = [
        f"<figure>{_TAGS[path.suffix].format(quote(path.name), escape(path.name))}"
        f"<figcaption>{escape(path.name)}</figcaption></figure>"
        for path in made
        if path.parent == folder and path.suffix in _TAGS and path.name != PAGE
    ]
    if not shown:
        return None
    head = f'<meta charset="utf-8"><title>{escape(title)}</title><style>{_STYLE}</style>'
    text = "\n".join([f"<!doctype html>{head}", f"<h1>{escape(title)}</h1>", *shown, ""])
    save_bytes(folder / PAGE, text.encode())
    return folder / PAGE


def open_page(page: Path) -> bool:
    """Open a page in the browser ($BROWSER or the system's); return False without a display.

    The function calls xdg-open, open or the like, depending on the system.
    """
    if sys.platform in ("darwin", "win32"):
        there = "SSH_CONNECTION" not in os.environ
    else:
        there = any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))
    return there and webbrowser.open(page.as_uri())
