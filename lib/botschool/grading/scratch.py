"""The folder that a submission works in: a copy, bounded, and removed whatever is in it.

Nothing here follows a symbolic link or trusts a name, a mode or a depth found in the folder.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import stat
import tempfile
from collections.abc import Iterator
from pathlib import Path

from botschool.grading.checks import Wrong

LARGEST_SUBMISSION = 50 * 2**20
LARGEST_SCRATCH = 256 * 2**20
"""Bytes that a submission may write into its copy, in all."""
MOST_FILES = 2000
MOST_WRITTEN_FILES = 10_000
DEEPEST = 20
"""Levels of folders."""
MOST_PICTURES, LARGEST_PICTURE, WIDEST_PICTURE = 4, 600_000, 4000
_PNG = b"\x89PNG\r\n\x1a\n"


class Scratch:
    """A temporary folder: `folder` is the submission's copy, `root` all that it may write to."""

    def __init__(self, file: Path) -> None:
        """Copies the folder of a submission's file. Raises Wrong if that is too large."""
        self._base = Path(tempfile.mkdtemp(prefix="botschool-"))
        self.root = self._base / "scratch"
        self.folder = self.root / "submission"
        self._safe = self._base / "safe"  # where the submission cannot write
        try:
            self.folder.mkdir(parents=True)
            self._safe.mkdir()
            for path in submission_files(file):
                target = self.folder / path.relative_to(file.parent)
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(_content(path, LARGEST_SUBMISSION))
        except BaseException:
            self.remove()
            raise

    def trouble(self) -> str:
        """What the submission has written too much of, in words; "" if nothing."""
        size = count = 0
        try:
            for _, entry, depth in _entries(self.root):
                count += 1
                # a file that vanishes meanwhile counts nothing
                with contextlib.suppress(FileNotFoundError):
                    size += entry.stat(follow_symlinks=False).st_blocks * 512
                if count > MOST_WRITTEN_FILES:
                    return f"it wrote more than {MOST_WRITTEN_FILES} files"
                if depth > DEEPEST:
                    return f"it made folders more than {DEEPEST} levels deep"
                if size > LARGEST_SCRATCH:
                    return f"it wrote more than {LARGEST_SCRATCH // 2**20} MB of files"
        except FileNotFoundError:
            return ""
        except OSError:
            return "it made a folder that cannot be read"
        return ""

    def copy(self, name: str) -> Path:
        """A copy of a file in the submission's folder, which that can no longer change.

        Raises OSError when there is none, or no regular one of a reasonable size.
        """
        content = _content(self.folder / name, LARGEST_SCRATCH, within=self._base)
        place = self._safe / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(content)
        return place

    def pictures(self) -> list[tuple[str, bytes]]:
        """(name, content) of PNG files in the submission's folder, few and small ones."""
        found = []
        with contextlib.suppress(OSError):
            names = sorted(entry.name for entry in os.scandir(self.folder))
            for name in [name for name in names if name.lower().endswith(".png")][:100]:
                with contextlib.suppress(OSError):
                    content = _content(self.folder / name, LARGEST_PICTURE, within=self._base)
                    if _is_picture(content) and len(found) < MOST_PICTURES:
                        found.append((name, content))
        return found

    def remove(self) -> None:
        """Removes everything; the submission must no longer run."""
        remove_tree(self._base)


def submission_files(file: Path) -> list[Path]:
    """The files that a submission consists of: those beside its file and in sub-folders.

    Links, hidden files, caches and graders are left out. Raises Wrong when it is too much.
    """
    if file.is_symlink() or not file.is_file():
        raise Wrong(f"{file.name} is a link or no file: hand in the file itself.")
    found, total = [], 0
    too_large = Wrong(
        f"The folder of {file.name} holds more than {LARGEST_SUBMISSION // 2**20} MB or "
        f"{MOST_FILES} files: remove what does not belong to the exercise."
    )
    try:
        for path, entry, depth in _entries(file.parent, hidden=False):
            if len(found) > MOST_FILES or depth > DEEPEST:
                raise too_large
            grader = depth == 1 and entry.name.startswith("test_")
            if entry.is_file(follow_symlinks=False) and not grader:
                found.append(Path(path))
                total += entry.stat(follow_symlinks=False).st_size
                if total > LARGEST_SUBMISSION:
                    raise too_large
    except OSError as error:
        raise Wrong(f"The folder of {file.name} cannot be read ({error.strerror}).") from None
    return sorted(found)


def _entries(root: Path, hidden: bool = True) -> Iterator[tuple[str, os.DirEntry, int]]:
    """(path, entry, depth) of everything below a folder; links are not followed."""
    folders = [(str(root), 1)]
    while folders:
        folder, depth = folders.pop()
        with os.scandir(folder) as entries:
            for entry in entries:
                if not hidden and (entry.name.startswith(".") or entry.name == "__pycache__"):
                    continue
                yield entry.path, entry, depth
                if entry.is_dir(follow_symlinks=False):
                    folders.append((entry.path, depth + 1))


def _content(path: Path, most: int, within: Path | None = None) -> bytes:
    """The bytes of a regular file. Raises OSError for a link, a pipe, or too much."""
    if within is not None and not path.parent.resolve().is_relative_to(within.resolve()):
        raise OSError(f"{path.name} lies elsewhere")
    flags = os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)
    with open(os.open(path, flags), "rb") as file:
        if not stat.S_ISREG(os.fstat(file.fileno()).st_mode):
            raise OSError(f"{path.name} is no file")
        content = file.read(most + 1)
    if len(content) > most:
        raise OSError(f"{path.name} is too large")
    return content


def _is_picture(content: bytes) -> bool:
    width, height = (int.from_bytes(content[at : at + 4], "big") for at in (16, 20))
    return content.startswith(_PNG + b"\0\0\0\rIHDR") and 0 < max(width, height) <= WIDEST_PICTURE


def remove_tree(base: Path) -> None:
    """Removes a folder with folders of any depth, number and mode.

    Sub-folders are moved up beside each other first, so that no path grows long.
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
