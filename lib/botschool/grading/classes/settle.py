"""Store the chosen file under the exercise's name, in UTF-8, with the files that it needs."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from botschool.grading.classes.candidate import Candidate, Sought
from botschool.grading.classes.files import File, Handed, listed
from botschool.grading.classes.kinds import DATA
from botschool.grading.classes.texts import (
    MAX_TEXT,
    decoded,
    today,
    without_cookie,
    without_invisible,
    without_jupyter,
)
from botschool.grading.declare.checks import plain
from botschool.sandbox.errors import CannotRead, Refused
from botschool.sandbox.scratch import MAX_COPIED, MAX_COPIED_FILES, regular_files

MAX_DEPTH = 10
"""Folders within that of the graded file."""


@dataclass
class Choice:
    """The file to grade for an exercise, or the reason why there is none."""

    file: Path | None = None
    """Its path on the disk, under a name that can be graded."""
    problem: str = ""
    unread: bool = False
    """Whether the problem lies outside the submission."""
    notes: list[str] = field(default_factory=list)
    """What the reader of the grade must know."""
    used: set[File] = field(default_factory=set)
    changed: bool = False
    """Whether it differs from the file that students got."""
    origin: File | None = None
    """Its name as handed in."""


def settle(
    choice: Choice,
    best: Candidate,
    handed: Handed,
    wanted: Sought,
    new_folder: Callable[[], Path],
) -> None:
    """Store the best file where it can be graded, and note what is unusual about it.

    A file that has its right name and form stays where it is.
    """
    if best.is_notebook and not best.code:
        choice.problem = f"{plain(best.file.shown)} is not a readable notebook."
        return
    content, notes = _content(best)
    choice.notes += notes
    beside = [
        file
        for file in handed.files
        if file != best.file and file.shown.startswith(best.file.folder)
    ]
    name = Path(wanted.file).with_suffix(".ipynb" if best.is_notebook else ".py").name
    own = best.file.path.name == name and best.file.place.endswith(best.file.shown)
    plain_text = content == best.text and not decoded(best.content)[1] and not best.is_page
    if own and plain_text and _is_small(best.file.path):
        choice.file = best.file.path.absolute()
        choice.used |= _needed(best, [file for file in beside if file.top == best.file.top])
        return
    rivals = choice.used - {best.file}
    needed = _needed(best, beside)
    choice.used |= needed
    wishes = [file for file in beside if file not in rivals]
    folder = new_folder()
    left = _copy(best, sorted(wishes, key=lambda file: file not in needed), name, folder)
    if left:
        choice.notes.append(
            f"Left out, because the folder holds more than {MAX_COPIED // 2**20} MB or "
            f"{MAX_COPIED_FILES} files: {listed(left)}."
        )
    choice.file = folder / name
    choice.file.write_bytes(content.encode("utf-8", "replace"))


def _content(best: Candidate) -> tuple[str, list[str]]:
    """Return the text to grade, and sentences on how it differs from the file."""
    name, encoding, notes = plain(best.file.name), decoded(best.content)[1], []
    if encoding:
        notes.append(f"{name} was stored as {encoding}.")
    if best.is_notebook != (best.suffix == ".ipynb"):
        what = "a notebook" if best.is_notebook else "no notebook"
        notes += [f"{name} is {what}."] * (best.suffix in (".py", ".ipynb"))
    if best.is_page and best.suffix not in (".html", ".htm"):
        notes.append(f"{name} is a web page: only its text counts.")
    if best.is_notebook:
        return today(best.text), notes
    visible = without_invisible(best.text)
    if visible != best.text:
        notes.append("Invisible characters, which Python refuses, were replaced.")
    content = without_jupyter(visible)
    if content != visible:
        notes.append("Left out: lines that only Jupyter understands.")
    return without_cookie(content) if encoding or content != best.text else content, notes


def _is_small(file: Path) -> bool:
    """Return whether the sandbox takes the folder of a file as it is."""
    try:
        regular_files(file)
    except Refused:
        return False
    except CannotRead:  # which the grader reports
        pass
    return True


def _copy(best: Candidate, wishes: list[File], name: str, folder: Path) -> list[str]:
    """Copy files beside the best one, in this order; return the paths of those without room."""
    room, count, left = MAX_COPIED - MAX_TEXT, MAX_COPIED_FILES - 1, []
    for file in wishes:
        inner = file.shown[len(best.file.folder) :]
        if inner == name:
            continue
        try:
            content = file.read(room)
            if len(content) > room or count == 0 or inner.count("/") > MAX_DEPTH:
                left.append(file.shown)
                continue
            place = folder / inner
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(content)
        except OSError:
            continue
        room -= len(content)
        count -= 1
    return left


def _needed(best: Candidate, beside: list[File]) -> set[File]:
    """Return the files beside it that a program can use: data, and modules that it names."""
    used = {file for file in beside if file.name.lower().endswith(DATA)}
    texts, waiting = [best.code], {file for file in beside if file not in used}
    while texts:
        text = texts.pop()
        for file in list(waiting):
            stem = re.sub(r"\.\w+$", "", file.name)
            if file.name in text or re.search(rf"\b{re.escape(stem)}\b", text):
                waiting.discard(file)
                used.add(file)
                with contextlib.suppress(OSError):
                    texts.append(file.read(MAX_TEXT).decode("utf-8", "replace"))
    return used
