"""Find the files that a person handed in: in folders, beside others, in zip files."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from botschool.grading.classes.unpack import (
    ARCHIVES,
    MAX_LEVELS,
    PACKED,
    Unpackable,
    room_of_submission,
    unpack,
)
from botschool.sandbox.inside import read_inside

MAX_ZIP = 200 * 2**20
"""Bytes of a zip file within a submission."""
MAX_FILES, MAX_DEPTH = 20_000, 30
"""For a person: files to look at, and levels of folders."""
JUNK = {
    "__macosx", "__pycache__", ".git", ".ipynb_checkpoints", ".venv", "venv", ".idea", ".vscode",
    ".ds_store", "thumbs.db", "desktop.ini", ".botschool", ".pytest_cache", ".ruff_cache",
    "node_modules", ".trash", "site-packages",
}  # fmt: skip
"""Names that systems and tools leave behind, in lower case."""


OF_VENV = {"lib", "lib64", "bin", "scripts", "include", "share", "pyvenv.cfg"}
"""Names in every virtual environment, in lower case."""
_MAY_BE_ZIP = (".py", ".txt", ".ipynb")
"""Suffixes that students give to zip files, other than .zip."""


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


@dataclass
class Handed:
    """All files that a person handed in."""

    files: list[File] = field(default_factory=list)
    links: list[str] = field(default_factory=list)
    """Paths of links, which are never followed."""
    notes: list[str] = field(default_factory=list)
    """Sentences on unreadable places."""
    unread: bool = False
    """Whether a folder could not be read."""


class Collector:
    """List the files of a person."""

    def __init__(self, new_folder: Callable[[], Path]) -> None:
        """Start; new_folder: makes an empty temporary folder for a zip file's content."""
        self._new_folder = new_folder
        self._room = room_of_submission()
        self.handed = Handed()

    def add_folder(self, folder: Path, shown: str = "", level: int = 0) -> None:
        """Add the files of a folder; shown: the beginning of the paths to show."""
        if folder.is_symlink():
            self.handed.links.append(shown.rstrip("/") or folder.name)
            return
        waiting = [("", 0)]
        while waiting:
            inner, depth = waiting.pop()
            try:
                with os.scandir(folder / inner) as entries:
                    found = sorted(entries, key=lambda entry: entry.name)
            except OSError:
                self.handed.unread = True
                self.handed.notes.append(
                    f"The folder {shown + inner or folder.name} is unreadable."
                )
                continue
            is_venv = any(entry.name == "pyvenv.cfg" for entry in found)
            for entry in found:
                name = inner + entry.name
                if is_junk(entry.name) or (is_venv and entry.name.lower() in OF_VENV):
                    continue
                if entry.is_symlink():
                    self.handed.links.append(shown + name)
                elif entry.is_dir(follow_symlinks=False):
                    if depth < MAX_DEPTH:
                        waiting.append((name + "/", depth + 1))
                elif not self.add_file(folder, name, shown + name, level):
                    return

    def add_file(self, top: Path, place: str, shown: str, level: int = 0) -> bool:
        """Add a file, or a zip file's content; return False if there are too many files."""
        if len(self.handed.files) >= MAX_FILES:
            self.handed.notes.append(
                f"There are more than {MAX_FILES} files: the others are ignored."
            )
            return False
        file = File(top, place, shown)
        lower = shown.lower()
        if lower.endswith(ARCHIVES) or _is_zip(file):
            self._add_archive(file, level)
        else:
            if lower.endswith(PACKED):
                self.handed.notes.append(f"{shown} is not a zip file, so it stays packed.")
            self.handed.files.append(file)
        return True

    def _add_archive(self, file: File, level: int) -> None:
        if level >= MAX_LEVELS:
            self.handed.notes.append(f"{file.shown} is in too many zip files, so it stays packed.")
            return
        try:
            content = file.read(MAX_ZIP)
            if len(content) > MAX_ZIP:
                raise Unpackable("is too large")
            if content[:2] != b"PK" and content and content.isascii():  # a text by another name
                self.handed.files.append(file)
                return
            target = self._new_folder()
            for name in unpack(content, target, self._room, file.name):
                self.handed.links.append(f"{file.shown}/{name}")
        except OSError:
            self.handed.notes.append(f"{file.shown} cannot be read.")
            self.handed.unread = True
        except Unpackable as error:
            self.handed.notes.append(f"{file.shown} {error}, so it stays packed.")
        else:
            self.add_folder(target, f"{file.shown}/", level + 1)


def _is_zip(file: File) -> bool:
    """Return whether a file of another name is a zip file."""
    if not re.search(r"\.\w+$", file.name) or file.name.lower().endswith(_MAY_BE_ZIP):
        try:
            return file.read(3) == b"PK\x03\x04"
        except OSError:
            return False
    return False
