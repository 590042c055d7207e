"""Find the files that a person handed in: in folders, beside others, in zip files."""

from __future__ import annotations

import contextlib
import itertools
import os
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from botschool.grading.classes.unpack import (
    ARCHIVES,
    MAX_LEVELS,
    PACKED,
    SIGN,
    SUBMISSION,
    Room,
    Unpackable,
    is_archive,
    kind_of,
    unpack,
)
from botschool.grading.declare.checks import plain
from botschool.sandbox.inside import read_inside

MAX_ZIP = 200 * 2**20
"""Bytes of a zip file within a submission."""
MAX_FILES, MAX_DEPTH, MAX_CHECKPOINTS = 20_000, 30, 20
"""For a person: files to look at, levels of folders, and files of Jupyter in each."""
JUNK = {
    "__macosx", "__pycache__", ".git", ".ipynb_checkpoints", ".venv", "venv", ".idea", ".vscode",
    ".ds_store", "thumbs.db", "desktop.ini", ".botschool", ".pytest_cache", ".ruff_cache",
    "node_modules", ".trash", "site-packages",
}  # fmt: skip
"""Names that systems and tools leave behind, in lower case."""


OF_VENV = {"lib", "lib64", "bin", "scripts", "include", "share", "pyvenv.cfg"}
"""Names in every virtual environment, in lower case."""
CHECKPOINTS = ".ipynb_checkpoints"
"""The folder in which Jupyter keeps the last saved state of notebooks."""
_MAY_BE_ZIP = (".py", ".txt", ".ipynb")
"""Suffixes that students give to zip files, other than .zip."""


MAX_LISTED = 30
"""Names in a list of files."""


def listed(names: list[str]) -> str:
    """Return names with commas; of a long list, only its beginning and the number of the others."""
    shown = ", ".join(plain(name) for name in names[:MAX_LISTED])
    return f"{shown} and {len(names) - MAX_LISTED} more" if len(names) > MAX_LISTED else shown


def is_junk(name: str) -> bool:
    """Return whether a file or folder of this name is no one's work."""
    lower = name.lower()
    return lower in JUNK or lower.startswith("._") or lower.endswith((".pyc", ".pyo"))


TIMESTAMP = "timestamp.txt"
"""The file in which nbgrader writes when a person handed in."""


@dataclass(frozen=True)
class File:
    """A submitted file."""

    top: Path
    """The folder below which it is read, without following links."""
    place: str
    """Its path relative to that folder."""
    shown: str
    """Its path as the person knows it, without a platform's additions."""
    packed: File | None = None
    """The outermost archive that holds it."""

    @property
    def path(self) -> Path:
        return self.top / self.place

    @property
    def name(self) -> str:
        return self.shown.rpartition("/")[2]

    @property
    def folder(self) -> str:
        """Return "" or a path that ends with a slash."""
        return self.shown[: len(self.shown) - len(self.name)]

    def read(self, most: int) -> bytes:
        """Return up to `most` + 1 bytes. Raises OSError for anything but a regular file."""
        return read_inside(self.top, self.place, most)


class Handed:
    """All files that a person handed in."""

    def __init__(self, new_folder: Callable[[], Path] = Path) -> None:
        """Start; new_folder: makes an empty temporary folder for a zip file's content."""
        self._new_folder, self._room = new_folder, Room(*SUBMISSION)
        self.files: list[File] = []
        self.links: list[str] = []
        """Paths of links, which are never followed."""
        self.ignored: list[str] = []
        """Paths of what systems and tools left behind."""
        self.checkpoints: list[File] = []
        """Notebooks that Jupyter keeps beside the saved ones."""
        self.notes: list[str] = []
        """Sentences on unreadable places."""
        self.unread = False
        """Whether a folder could not be read."""

    def add_folder(
        self, folder: Path, shown: str = "", level: int = 0, packed: File | None = None
    ) -> None:
        """Add the files of a folder; shown: the beginning of their paths; packed: as in File."""
        if folder.is_symlink():
            self.links.append(shown.rstrip("/") or folder.name)
            return
        waiting = [("", 0)]
        while waiting:
            inner, depth = waiting.pop()
            try:
                with os.scandir(folder / inner) as entries:
                    found = sorted(entries, key=lambda entry: entry.name)
            except OSError:
                self.unread = True
                self.notes.append(f"The folder {shown + inner or folder.name} is unreadable.")
                continue
            is_venv = any(entry.name == "pyvenv.cfg" for entry in found)
            for entry in found:
                name = inner + entry.name
                if is_junk(entry.name) or (is_venv and entry.name.lower() in OF_VENV):
                    self.ignored.append(shown + name)
                    if entry.name == CHECKPOINTS:
                        self._add_checkpoints(folder, name, shown + name)
                    continue
                if entry.is_symlink():
                    self.links.append(shown + name)
                elif entry.is_dir(follow_symlinks=False):
                    if depth < MAX_DEPTH:
                        waiting.append((name + "/", depth + 1))
                    else:
                        self.notes.append(f"{shown}{name} lies too deep: ignored.")
                elif not self.add_file(folder, name, shown + name, level, packed):
                    return

    def add_file(
        self, top: Path, place: str, shown: str, level: int = 0, packed: File | None = None
    ) -> bool:
        """Add a file, or a zip file's content; return False if there are too many files.

        level: of zip files around it; -1 for one that is a whole submission.
        """
        if len(self.files) >= MAX_FILES:
            self.notes.append(f"There are more than {MAX_FILES} files: the others are ignored.")
            return False
        file = File(top, place, shown, packed)
        lower = shown.lower()
        is_packed = lower.endswith((*ARCHIVES, *PACKED))
        if not (is_packed or lower.endswith(_MAY_BE_ZIP) or not re.search(r"\.\w+$", file.name)):
            self.files.append(file)
            return True
        head = _head(file)
        kind = kind_of(head, file.name)
        is_text = head.isascii() and b"\0" not in head and head[:2] not in (b"", b"PK")
        if is_archive(head, file.name) or (is_packed and not kind and not is_text):
            self._add_archive(file, level)
        elif is_packed and kind:
            self.notes.append(f"{shown} is {kind}, so it stays packed.")
        else:
            self.files.append(file)
        return True

    def _add_checkpoints(self, top: Path, place: str, shown: str) -> None:
        with contextlib.suppress(OSError), os.scandir(top / place) as entries:
            for entry in sorted(entries, key=lambda entry: entry.name)[:MAX_CHECKPOINTS]:
                if entry.is_file(follow_symlinks=False):
                    file = File(top, f"{place}/{entry.name}", f"{shown}/{entry.name}")
                    self.checkpoints.append(file)

    def _add_archive(self, file: File, level: int) -> None:
        if level >= MAX_LEVELS:
            self.notes.append(f"{file.shown} is in too many zip files, so it stays packed.")
            return
        try:
            content = file.read(MAX_ZIP)
            if len(content) > MAX_ZIP:
                raise Unpackable("is too large")
            target = self._new_folder()
            for name in unpack(content, target, self._room, file.name):
                self.links.append(f"{file.shown}/{name}")
        except OSError:
            self.notes.append(f"{file.shown} cannot be read.")
            self.unread = True
        except Unpackable as error:
            self.notes.append(f"{file.shown} {error}, so it stays packed.")
        else:
            self.add_folder(target, f"{file.shown}/", level + 1, file.packed or file)


def _head(file: File) -> bytes:
    """Return the first bytes of a file; b"" if it cannot be read."""
    try:
        return file.read(SIGN)
    except OSError:
        return b""


def numbered_folders(base: Path) -> Callable[[], Path]:
    """Return a function that makes a new folder in `base` each time."""
    numbers = itertools.count(1)

    def new_folder() -> Path:
        folder = base / str(next(numbers))
        folder.mkdir(parents=True)
        return folder

    return new_folder
