"""Runs a finished exercise from beginning to end, in results/exNN, and shows what it has made."""

from __future__ import annotations

import os
import subprocess
import sys
import webbrowser
from html import escape
from pathlib import Path
from urllib.parse import quote

from botschool.errors import BotschoolError
from botschool.grading.declare.exercise import load_exercise, submission_file
from botschool.output import save_bytes
from botschool.paths import course_root

PAGE = "all.html"
"""In results/exNN: what was made, on one page."""
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


def show(number: int, submission: str | None = None, root: Path | None = None) -> list[Path]:
    """Runs a submission's file (None: the student's own) and returns what it made or changed.

    Raises BotschoolError when the file ends with an error.
    """
    root = (root or course_root()).resolve()
    load_exercise(number, root).require()
    file = submission_file(number, submission, root).resolve()
    folder = root / "results" / f"ex{number:02d}"
    folder.mkdir(parents=True, exist_ok=True)
    before = _stamps(folder)
    variables = {"BOTSCHOOL_COURSE": str(root)}
    if not os.environ.get("DISPLAY"):
        variables["MPLBACKEND"] = "Agg"
    done = subprocess.run([sys.executable, str(file)], cwd=folder, env=os.environ | variables)
    if done.returncode != 0:
        raise BotschoolError(
            f"{file.name} ended with an error, see above; is it finished? 'botschool grade "
            f"{number}' says so."
        )
    return [path for path, stamp in _stamps(folder).items() if before.get(path) != stamp]


def _stamps(folder: Path) -> dict[Path, int]:
    return {path: path.stat().st_mtime_ns for path in sorted(folder.rglob("*")) if path.is_file()}


def make_page(number: int, made: list[Path], root: Path | None = None) -> Path | None:
    """Writes PAGE with the pictures, films and replays among `made`; None if there are none.

    Files in folders of results/exNN, as those of runs, are left out. Raises BotschoolError.
    """
    root = (root or course_root()).resolve()
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
    """Opens a page in the browser ($BROWSER or the system's own); False where there is no display.

    Uses xdg-open, open or the like, as the system has it.
    """
    if sys.platform in ("darwin", "win32"):
        there = "SSH_CONNECTION" not in os.environ
    else:
        there = any(os.environ.get(name) for name in ("DISPLAY", "WAYLAND_DISPLAY"))
    return there and webbrowser.open(page.as_uri())
