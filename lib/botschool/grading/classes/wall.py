"""Read what a student handed in behind a wall: in a child process with bounds on time and memory.

Whatever happens there (an exception, a crash, an endless loop) becomes a sentence about its owner.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import select
import signal
import time
from collections.abc import Callable
from typing import Any, TypeVar

from botschool.grading.run.confined import SHORTAGES
from botschool.sandbox.confine import end_with, limit

SECONDS, MEMORY, FILE_SIZE = 60, 2**30, 2**28
"""Processor seconds, bytes beyond those of this process, and bytes of a file for one student."""
SLOWER = 10
"""In the time that passes, with other programs running, the child may take this many times more."""
T = TypeVar("T")


class Broken(Exception):
    """A student's files cannot be read; the message is the reason."""

    def __init__(self, reason: str, ours: bool = False) -> None:
        """Store the reason; ours: whether the machine is to blame, not the student."""
        super().__init__(reason)
        self.ours = ours


def broken(error: BaseException) -> Broken:
    """Return what an exception says about a student's files."""
    if isinstance(error, MemoryError):
        return Broken(f"this takes more than {MEMORY >> 20} MB of memory")
    reason = f"{type(error).__name__}: {error}"[:200]
    return Broken(reason, isinstance(error, OSError) and error.errno in SHORTAGES)


def walled(read: Callable[..., T], *arguments: Any) -> T:
    """Return read(*arguments), computed in a child process. Raises Broken if that fails."""
    if not hasattr(os, "fork"):
        try:
            return read(*arguments)
        except Exception as error:
            raise broken(error) from None
    ours, theirs = os.pipe()
    parent, child = os.getpid(), os.fork()
    if not child:
        _answer(theirs, parent, read, arguments)
    os.close(theirs)
    content, status = b"", 0
    try:
        content = _received(ours)
    finally:
        os.close(ours)
        os.kill(child, signal.SIGKILL)
        _, status = os.waitpid(child, 0)
    try:
        outcome, failed = pickle.loads(content)
    except (EOFError, pickle.UnpicklingError):  # it ended before all was written
        raise _ended(status) from None
    if failed:
        raise failed
    return outcome


def _answer(pipe: int, parent: int, read: Callable, arguments: tuple) -> None:
    """Write the outcome into the pipe and end this process."""
    with contextlib.suppress(BaseException):
        for each in (signal.SIGINT, signal.SIGTERM):
            signal.signal(each, signal.SIG_DFL)
        end_with(parent)
        limit(SECONDS, MEMORY, FILE_SIZE)
        try:
            content = pickle.dumps((read(*arguments), None))
        except BaseException as error:
            content = pickle.dumps((None, broken(error)))
        with open(pipe, "wb") as stream:
            stream.write(content)
    os._exit(0)


def _received(pipe: int) -> bytes:
    parts, end = [], time.monotonic() + SLOWER * SECONDS
    while select.select([pipe], [], [], max(0.0, end - time.monotonic()))[0]:
        part = os.read(pipe, 2**20)
        if not part:
            return b"".join(parts)
        parts.append(part)
    return b""


def _ended(status: int) -> Broken:
    """Return why a child ended without an outcome."""
    number = os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0
    if number == signal.SIGXCPU:
        return Broken(f"this takes more than {SECONDS} seconds")
    if number == signal.SIGKILL:  # by `walled` after a long time, or by a system without memory
        return Broken("this machine had too little time or memory", ours=True)
    return broken(MemoryError()) if not number else Broken(f"this ends Python by signal {number}")
