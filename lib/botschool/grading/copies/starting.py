"""Restore a student's file, or open it as a notebook (`botschool start` and `reset`)."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterable
from importlib import invalidate_caches
from importlib.util import find_spec
from itertools import count
from pathlib import Path
from urllib.parse import quote

from botschool.errors import BotschoolError
from botschool.grading.copies.release import MANIFEST
from botschool.grading.copies.skeleton import skeleton
from botschool.grading.declare.exercise import folder_of, load_exercise, missing_packages
from botschool.grading.declare.state import make_state
from botschool.output import save_bytes
from botschool.page.exercise import PAGE, has_page, write_exercise_page


def original(number: int, root: Path) -> str:
    """Return the skeleton of an exercise's file, from its solution or from the release.

    Raises BotschoolError if there is neither.
    """
    folder, file = folder_of(number, root).name, load_exercise(number, root).file
    solution = root / "solutions" / folder / file
    if solution.is_file():
        return skeleton(solution.read_text(encoding="utf-8"))
    try:
        released = json.loads((root / MANIFEST).read_text(encoding="utf-8"))
        return released["skeletons"][f"exercises/{folder}/{file}"]
    except (OSError, ValueError, KeyError, TypeError):
        raise BotschoolError(
            f"The original of {file} is not kept here ({MANIFEST} is missing or damaged): get a "
            "new copy."
        ) from None


def start(number: int, root: Path) -> tuple[Path, bool]:
    """Return the student's file, and whether this call has made it. Raises BotschoolError."""
    file = folder_of(number, root) / load_exercise(number, root).file
    if file.exists():
        return file, False
    save_bytes(file, original(number, root).encode())
    return file, True


def living_page(number: int, root: Path) -> Path | None:
    """Return the living page of an exercise, made anew unless it came with the copy.

    Return None if the exercise's text has no figures.
    """
    folder = folder_of(number, root)
    if not has_page(folder):
        return None
    came = (root / MANIFEST).is_file() and (folder / PAGE).is_file()
    return folder / PAGE if came else write_exercise_page(folder)


def reset(number: int, root: Path) -> tuple[Path, Path | None]:
    """Put the student's file back to its beginning.

    Return it and the old version's path, or None if the file was missing or unedited. Raises
    BotschoolError.
    """
    text = original(number, root)
    file, made = start(number, root)
    if made or file.read_bytes() == text.encode():
        return file, None
    names = (file.with_name(f"{file.stem}_old{n}{file.suffix}") for n in count(1))
    kept = next(name for name in names if not name.exists())
    save_bytes(kept, file.read_bytes())
    save_bytes(file, text.encode())
    return file, kept


def install(extras: Iterable[str], root: Path) -> None:
    """Install packages of pyproject.toml's extras where botschool runs in the course's own .venv.

    Elsewhere nothing happens. Raises BotschoolError if the installation fails.
    """
    setup = root / "tools" / "setup.sh"
    if Path(sys.prefix).resolve() != (root / ".venv").resolve() or not setup.is_file():
        return
    for extra in extras:
        if missing_packages((extra,)) and not (root / ".venv" / f".extra-{extra}").exists():
            if subprocess.run(["sh", str(setup), "extra", extra], cwd=root).returncode:
                raise BotschoolError(f"The packages of '{extra}' are not installed (see above).")
            invalidate_caches()


VIEWER = {
    "@jupyterlab/docmanager-extension:plugin": {"defaultViewers": {"python": "Jupytext Notebook"}}
}
"""JupyterLab's setting that opens Python files as notebooks."""


def notebook_command(file: Path, root: Path) -> list[str]:
    """Return the command that opens a file in JupyterLab as a notebook; saving keeps it Python."""
    place = quote(file.resolve().relative_to(root.resolve()).as_posix())
    root_user = hasattr(os, "geteuid") and os.geteuid() == 0  # usual in containers
    return [
        sys.executable,
        "-m",
        "jupyterlab",
        *(["--allow-root"] if root_user else []),
        f"--ServerApp.root_dir={root.resolve()}",
        # a separate workspace, because another one may have the file open as text
        f"--LabApp.default_url=/lab/workspaces/{file.stem}/tree/{place}",
    ]


def notebook_variables(root: Path) -> dict[str, str]:
    """Return environment variables for JupyterLab: VIEWER, for this course, in a folder of ours.

    Raises BotschoolError.
    """
    try:
        folder = make_state(root.resolve()) / "jupyter"
        (folder / "labconfig").mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise BotschoolError(
            f"Cannot write to {root} ({error.strerror}): change its permissions."
        ) from None
    save_bytes(folder / "labconfig" / "default_setting_overrides.json", json.dumps(VIEWER).encode())
    others = filter(None, [os.environ.get("JUPYTER_CONFIG_PATH")])
    return os.environ | {"JUPYTER_CONFIG_PATH": os.pathsep.join([str(folder), *others])}


def open_notebook(number: int, file: Path, root: Path) -> None:
    """Run JupyterLab with the file open, until Ctrl-C. Raises BotschoolError."""
    if not all(map(find_spec, ("jupyterlab", "jupytext"))):
        raise BotschoolError(
            "A notebook needs JupyterLab and jupytext: install them with "
            "'pip install botschool[notebook]'."
        )
    before = signal.signal(signal.SIGINT, lambda *_: None)  # JupyterLab handles Ctrl-C
    try:
        done = subprocess.run(notebook_command(file, root), env=notebook_variables(root))
    finally:
        signal.signal(signal.SIGINT, before)
    if done.returncode != 0:
        raise BotschoolError("JupyterLab ended with an error (see above).")
