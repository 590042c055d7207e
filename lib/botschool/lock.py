"""Lock output folders and stored data, so that no two commands write the same run or file."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from botschool.errors import FOLDER, BotschoolError
from botschool.output import cannot_write

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None

NAME = ".botschool.lock"
TAKEN = (errno.EACCES, errno.EAGAIN)


@contextmanager
def alone(folder: Path) -> Iterator[None]:
    """Read, change and write a file of a folder in the block while no other command does so.

    Wait for the others. Without a lock (a missing folder, Windows, some file systems) go on.
    """
    with ExitStack() as stack:
        with suppress(OSError):
            opened = os.open(folder, os.O_RDONLY)
            stack.callback(os.close, opened)
            if fcntl is not None:
                fcntl.flock(opened, fcntl.LOCK_EX)
        yield


@contextmanager
def locked(folder: Path, what: str, first: int = 0, count: int = 1) -> Iterator[None]:
    """Lock the runs with numbers first, first + 1, ... of an existing folder during the block.

    what: the subject of the error, such as "the run with seed 1". The system ends a lock with its
    process, so a killed process leaves none. If the folder's file system has no locks, a line on
    stderr says so. Raises BotschoolError if another process holds one of the runs.
    """
    if fcntl is None:
        yield
        return
    path = folder / NAME
    file = _locked_file(path, what, first, count)
    try:
        yield
    finally:
        with suppress(OSError):
            fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB)  # the whole: nobody else needs it
            path.unlink()
        os.close(file)


def _locked_file(path: Path, what: str, first: int, count: int) -> int:
    while True:
        try:
            file = os.open(path, os.O_RDWR | os.O_CREAT, 0o666)
        except OSError as error:
            raise cannot_write(path, error.strerror or str(error)) from error
        try:
            fcntl.lockf(file, fcntl.LOCK_EX | fcntl.LOCK_NB, count, first)
        except OSError as error:
            if error.errno not in TAKEN:
                print(
                    f"warning: {path.parent} is on a file system without locks, so take care that "
                    "no other command writes the same run.",
                    file=sys.stderr,
                )
                return file
            os.close(file)
            raise BotschoolError(
                f"Another command is writing {what} in {path.parent}: wait until it ends or stop "
                "it, or choose another folder",
                FOLDER,
                ".",
            ) from None
        with suppress(OSError):
            if os.path.samestat(os.fstat(file), path.stat()):
                return file
        os.close(file)  # its last user has just removed it
