"""Copy untrusted files into a bounded working folder, and remove it at the end.

No function here follows a symbolic link, or trusts a name, a mode or a depth found in the folder.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from botschool.sandbox.errors import CannotRead, Refused
from botschool.sandbox.inside import is_foreign, read_inside

if TYPE_CHECKING:
    from botschool.sandbox.server import ForkServer

MAX_COPIED, MAX_COPIED_FILES = 50 * 2**20, 2000
"""Bytes and files that may be copied."""
MAX_WRITTEN, MAX_WRITTEN_FILES = 256 * 2**20, 10_000
"""Bytes and files that the writable folder may hold."""
MAX_DEPTH = 20
"""Levels of folders."""
MAX_PICTURES, MAX_PICTURE, MAX_PICTURE_SIDE = 4, 600_000, 4000
"""Number of pictures; bytes and pixels of each."""
_FILE = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
_FOLDER = _FILE | getattr(os, "O_DIRECTORY", 0)
_PNG = b"\x89PNG\r\n\x1a\n"


def _keep_all(name: str, depth: int) -> bool:
    return False


class Scratch:
    """A temporary folder: `folder` holds the copy, and the code may write only below `root`."""

    def __init__(self, file: Path, skip: Callable[[str, int], bool] = _keep_all) -> None:
        """Copy a file with its `regular_files`. Raises Refused."""
        self._base = Path(tempfile.mkdtemp(prefix="botschool-"))
        self.root = self._base / "scratch"
        self.folder = self.root / "submission"
        self._own = Path(self.folder.name)  # below `root`
        self._safe = self._base / "safe"  # the untrusted code cannot write here
        self.in_memory = False
        """Whether `root` is a file system in memory; then only the children see it by this name."""
        self._server: ForkServer | None = None
        self._top: int | None = None  # a descriptor of `root`
        try:
            self.folder.mkdir(parents=True)
            self._safe.mkdir()
            self._top = os.open(self.root, _FOLDER)
            for path in regular_files(file, skip):
                name = path.relative_to(file.parent)
                target = self.folder / name
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(_content(file.parent, name, MAX_COPIED))
        except BaseException:
            self.remove()
            raise

    def enter(self, server: ForkServer) -> None:
        """Move the copy into memory for this server's children, if the system allows that."""
        if self._server is server:
            return
        self._server = server
        top = server.mount(self.root, MAX_WRITTEN + 2**20, MAX_WRITTEN_FILES + 10)
        if top is None:
            return
        os.close(self._top)
        self._top, self.in_memory = top, True
        shutil.copytree(self.root, f"/proc/self/fd/{top}", dirs_exist_ok=True)

    def is_full(self) -> str:
        """Return the memory limit that is reached, in words; "" if none."""
        if not self.in_memory:
            return ""
        status = os.statvfs(self._top)
        if (status.f_blocks - status.f_bfree) * status.f_frsize > MAX_WRITTEN:
            return _too_much()
        return _too_many() if status.f_files - status.f_ffree > MAX_WRITTEN_FILES else ""

    def trouble(self, size: int = 0, count: int = 0) -> str:
        """Return the limit that the written files exceed, in words; "" if none.

        size, count: bytes and number of removed files that are still on the disk.
        """
        try:
            for _, entry, depth in _entries(self.root, vanishing=True):
                count += 1
                # a file that has just vanished does not count
                with contextlib.suppress(FileNotFoundError):
                    size += entry.stat(follow_symlinks=False).st_blocks * 512
                if count > MAX_WRITTEN_FILES:
                    return _too_many()
                if depth > MAX_DEPTH:
                    return f"it made folders more than {MAX_DEPTH} levels deep"
                if size > MAX_WRITTEN:
                    break
        except OSError:
            return "it made a folder that cannot be read"
        return _too_much() if size > MAX_WRITTEN else ""

    def copy(self, name: str) -> Path:
        """Copy a file in `folder` to where the untrusted code cannot write; return the copy's path.

        Raises OSError if there is no regular file of that name and of a reasonable size.
        """
        content = _content(self._top, self._own / name, MAX_WRITTEN)
        place = self._safe / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(content)
        return place

    def pictures(self) -> list[tuple[str, bytes]]:
        """Return (name, content) of the PNG files in `folder`, at most MAX_PICTURES."""
        found = []
        with contextlib.suppress(OSError):
            names = sorted(self._names())
            for name in [name for name in names if name.lower().endswith(".png")][:100]:
                with contextlib.suppress(OSError):
                    content = _content(self._top, self._own / name, MAX_PICTURE)
                    if _is_picture(content) and len(found) < MAX_PICTURES:
                        found.append((name, content))
        return found

    def remove(self) -> None:
        """Remove everything; the untrusted code must have ended."""
        if self._top is not None:
            os.close(self._top)
            self._top = None
        remove_tree(self._base)

    def _names(self) -> list[str]:
        """Return the names in `folder`. Raises OSError."""
        folder = os.open(self.folder.name, _FOLDER, dir_fd=self._top)
        try:
            return os.listdir(folder)
        finally:
            os.close(folder)


def _too_much() -> str:
    return f"it wrote more than {MAX_WRITTEN // 2**20} MB of files"


def _too_many() -> str:
    return f"it wrote more than {MAX_WRITTEN_FILES} files"


def regular_files(file: Path, skip: Callable[[str, int], bool] = _keep_all) -> list[Path]:
    """Return a file and those beside it and in sub-folders.

    Links, hidden files, caches and hard links to other users' files are left out.
    skip(name, depth): whether to leave out a file, too; depth is 1 beside `file`.
    Raises Refused for more than MAX_COPIED bytes or MAX_COPIED_FILES, and CannotRead.
    """
    if file.is_symlink() or not file.is_file():
        raise Refused(f"{file.name} is a link or not a file: hand in the file itself.")
    found, total, top = [], 0, file.parent.stat()
    if is_foreign(file.stat(), top):
        raise Refused(f"{file.name} is a link to another user's file: hand in the file itself.")
    too_large = Refused(
        f"The folder of {file.name} holds more than {MAX_COPIED // 2**20} MB or "
        f"{MAX_COPIED_FILES} files: remove files that do not belong to the exercise."
    )
    try:
        for path, entry, depth in _entries(file.parent, hidden=False):
            if len(found) > MAX_COPIED_FILES or depth > MAX_DEPTH:
                raise too_large
            if entry.is_file(follow_symlinks=False) and not skip(entry.name, depth):
                status = entry.stat(follow_symlinks=False)
                if is_foreign(status, top):
                    continue
                found.append(Path(path))
                total += status.st_size
                if total > MAX_COPIED:
                    raise too_large
    except OSError as error:
        raise CannotRead(
            f"Cannot read the folder of {file.name} ({error.strerror}): change its permissions."
        ) from None
    return sorted(found)


def _entries(
    root: Path, hidden: bool = True, vanishing: bool = False
) -> Iterator[tuple[str, os.DirEntry, int]]:
    """Yield (path, entry, depth) of everything below a folder; links are not followed.

    vanishing: whether to pass over folders that vanish before they are read.
    """
    folders = [(str(root), 1)]
    while folders:
        folder, depth = folders.pop()
        try:
            opened = os.scandir(folder)
        except FileNotFoundError:
            if vanishing:
                continue
            raise
        with opened as entries:
            for entry in entries:
                if not hidden and (entry.name.startswith(".") or entry.name == "__pycache__"):
                    continue
                yield entry.path, entry, depth
                if entry.is_dir(follow_symlinks=False):
                    folders.append((entry.path, depth + 1))


def _content(top: Path | int, name: str | Path, most: int) -> bytes:
    """Return a regular file's bytes below a folder. Raises OSError for links, large files."""
    content = read_inside(top, name, most)
    if len(content) > most:
        raise OSError(f"{name} is too large")
    return content


def _is_picture(content: bytes) -> bool:
    width, height = (int.from_bytes(content[at : at + 4], "big") for at in (16, 20))
    return content.startswith(_PNG + b"\0\0\0\rIHDR") and 0 < max(width, height) <= MAX_PICTURE_SIDE


def remove_tree(base: Path) -> None:
    """Remove a folder with sub-folders of any depth, number and mode.

    Sub-folders first move up beside each other, so that no path becomes long.
    """
    with contextlib.suppress(OSError, RecursionError):
        shutil.rmtree(base)
        return
    moved = 0
    folders = [base]
    with contextlib.suppress(OSError):
        base.chmod(0o700)
    while folders:
        folder = folders.pop()
        with contextlib.suppress(OSError), os.scandir(folder) as entries:
            for entry in list(entries):
                with contextlib.suppress(OSError):
                    if not entry.is_dir(follow_symlinks=False):
                        os.unlink(entry.path)
                        continue
                    moved += 1
                    place = base / f"removed-{moved}"
                    os.chmod(entry.path, 0o700)
                    os.rename(entry.path, place)
                    folders.append(place)
    for number in range(1, moved + 1):
        with contextlib.suppress(OSError):
            os.rmdir(base / f"removed-{number}")
    with contextlib.suppress(OSError):
        os.rmdir(base)
