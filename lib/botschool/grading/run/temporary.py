"""Make temporary folders that are removed later even if their process is killed."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from botschool.sandbox.scratch import remove_tree

PREFIX = "botschool-grading-"
"""Prefix of the folders' names. The lock on a folder shows that its process lives."""


@contextmanager
def temporary_folder() -> Iterator[Path]:
    """Yield a new folder, and remove folders of dead processes; the new one goes at the end."""
    sweep()
    folder, lock = _locked()
    try:
        yield folder
    finally:
        remove_tree(folder)
        os.close(lock)


@contextmanager
def temporary_files_within() -> Iterator[None]:
    """Put all temporary files of this process into such a folder within the block."""
    with temporary_folder() as folder:
        before, tempfile.tempdir = tempfile.tempdir, str(folder)
        try:
            yield
        finally:
            tempfile.tempdir = before


def sweep() -> None:
    """Remove this user's folders whose processes have died."""
    for folder in Path(tempfile.gettempdir()).glob(f"{PREFIX}*"):
        with contextlib.suppress(OSError):
            descriptor = _opened(folder)
            try:
                own = not hasattr(os, "geteuid") or os.fstat(descriptor).st_uid == os.geteuid()
                if own and _lock(descriptor):
                    remove_tree(folder)
            finally:
                os.close(descriptor)


def _locked() -> tuple[Path, int]:
    """Make a folder and return it with the descriptor that holds its lock."""
    import fcntl

    while True:
        folder = Path(tempfile.mkdtemp(prefix=PREFIX))
        descriptor = _opened(folder)
        with contextlib.suppress(OSError):  # a file system without locks
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        if folder.is_dir():
            return folder, descriptor
        os.close(descriptor)  # another process has removed it in between


def _opened(folder: Path) -> int:
    return os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)


def _lock(descriptor: int) -> bool:
    import fcntl

    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True
