"""Write output files completely or not at all, with clear errors."""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from botschool.errors import BotschoolError

OTHER_REASONS = {
    os.strerror(number)
    for number in (
        errno.ENOTDIR,
        errno.EEXIST,
        errno.EISDIR,
        errno.EACCES,
        errno.EPERM,
        errno.EROFS,
    )
}
"""Reasons for which space would not help."""


def check_output(path: Path | str, suffixes: Sequence[str]) -> Path:
    """Return the path if a file of one of these kinds (lower-case, such as ".png") can be written.

    Raises BotschoolError otherwise.
    """
    path = Path(path)
    if path.suffix.lower() not in suffixes:
        raise BotschoolError(
            f"{path} cannot be written: its name must end with one of {', '.join(suffixes)}."
        )
    if path.is_dir():
        raise BotschoolError(f"{path} is a folder: name a file instead.")
    if not path.parent.is_dir():
        raise BotschoolError(
            f"{path} cannot be written: there is no folder {path.parent}, so create it first."
        )
    if not os.access(path.parent, os.W_OK):
        raise cannot_write(path, f"no permission to write in {path.parent}")
    return path


def cannot_write(path: Path | str, reason: str) -> BotschoolError:
    """Return the error for a path that cannot be written, for the system's reason."""
    remedy = "free some space or choose another folder"
    if reason in OTHER_REASONS:
        remedy = "choose another folder"
    return BotschoolError(f"{path} cannot be written ({reason}): {remedy}.")


@contextmanager
def written_whole(path: Path | str) -> Iterator[Path]:
    """Yield a temporary path beside `path`; at the end it replaces `path`.

    If the block fails, nothing is left behind, an earlier `path` stays as it was, and the exception
    goes on. Raises BotschoolError if the file cannot be completed.
    """
    path = Path(path)
    temporary = _temporary(path, os.getpid())
    try:
        yield temporary
        try:
            with open(temporary, "rb+") as file:
                os.fsync(file.fileno())
            os.replace(temporary, path)
        except OSError as error:
            raise cannot_write(path, error.strerror or str(error)) from error
    finally:
        with suppress(OSError):
            temporary.unlink()


def remove_leftovers(path: Path) -> None:
    """Remove unfinished versions of `path` that killed processes left behind."""
    for temporary in path.parent.glob(_temporary(path, "*").name):
        with suppress(OSError):
            temporary.unlink()


def _temporary(path: Path, process: object) -> Path:
    return path.with_name(f".{path.stem}.{process}{path.suffix}")


def make_again(folder: Path) -> None:
    """Make a folder that was removed while a command writes into it, and say so on stderr."""
    if not folder.exists():
        print(f"warning: {folder} was removed: it is made again.", file=sys.stderr)
        folder.mkdir(parents=True, exist_ok=True)


def save_npy(path: Path, array: np.ndarray) -> None:
    """Write an .npy file completely or not at all. Raises BotschoolError."""
    buffer = BytesIO()
    np.save(buffer, array, allow_pickle=False)
    save_bytes(path, buffer.getvalue())


def save_npz(path: Path, arrays: dict[str, Any]) -> None:
    """Write an .npz file completely or not at all. Raises BotschoolError."""
    buffer = BytesIO()
    np.savez(buffer, **arrays)
    save_bytes(path, buffer.getvalue())


def save_bytes(path: Path, content: bytes) -> None:
    """Write a file with this content completely or not at all. Raises BotschoolError."""
    try:
        make_again(path.parent)
        with written_whole(path) as temporary:
            temporary.write_bytes(content)
    except OSError as error:
        raise cannot_write(path, error.strerror or str(error)) from error
