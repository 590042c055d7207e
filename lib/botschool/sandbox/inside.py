"""Read files below a folder without following a link."""

from __future__ import annotations

import os
import stat
from pathlib import Path

_FOLDER = os.O_RDONLY | getattr(os, "O_DIRECTORY", 0)
_NO_LINK = getattr(os, "O_NOFOLLOW", 0)
_FILE = os.O_RDONLY | _NO_LINK | getattr(os, "O_NONBLOCK", 0)


def read_inside(top: Path | int, name: str | Path, most: int) -> bytes:
    """Return up to `most` + 1 bytes of a regular file below a folder.

    top: the folder's path, or a descriptor of it.

    The function opens each part of `name` from the folder before it, so a folder that suddenly
    becomes a link leads nowhere. Raises OSError for a name that leaves `top`, a link, anything but
    a regular file, and another user's file (`is_foreign`).
    """
    parts = Path(name).parts
    if not parts or Path(name).is_absolute() or ".." in parts:
        raise OSError(f"{name} is not below the folder")
    try:
        descriptor = _opened(top, parts)
    except ValueError:  # a null character, or one that file names cannot have
        raise OSError("no file can have this name") from None
    try:
        status = os.fstat(descriptor)
        if not stat.S_ISREG(status.st_mode) or is_foreign(status, os.stat(top)):
            raise OSError(f"{parts[-1]} is not a regular file of the folder's owner")
        with open(descriptor, "rb", closefd=False) as file:
            return file.read(most + 1)
    finally:
        os.close(descriptor)


def is_foreign(status: os.stat_result, top: os.stat_result) -> bool:
    """Return whether a file is a hard link to a file of another user than the folder's owner."""
    return status.st_nlink > 1 and status.st_uid != top.st_uid


def _opened(top: Path | int, parts: tuple[str, ...]) -> int:
    # Windows; the sandbox does not work there anyway
    if isinstance(top, Path) and os.open not in os.supports_dir_fd:
        path = top.joinpath(*parts)
        if path.resolve() != top.resolve().joinpath(*parts):
            raise OSError(f"{path.name} is behind a link")
        return os.open(path, _FILE)
    folder = os.dup(top) if isinstance(top, int) else os.open(top, _FOLDER)
    try:
        for part in parts[:-1]:
            inner = os.open(part, _FOLDER | _NO_LINK, dir_fd=folder)
            os.close(folder)
            folder = inner
        return os.open(parts[-1], _FILE, dir_fd=folder)
    finally:
        os.close(folder)
