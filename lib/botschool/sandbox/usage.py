"""What a running process uses, as Linux tells in /proc; elsewhere nothing is known (zeros)."""

from __future__ import annotations

import contextlib
import os
import stat
from collections.abc import Iterator
from pathlib import Path

MIN_FREE, MIN_FREE_FILES = 16 * 2**20, 100
"""Bytes and files below which a file system counts as full."""


def threads(pid: int) -> int:
    """The number of its threads."""
    try:
        return os.stat(f"/proc/{pid}/task").st_nlink - 2
    except OSError:
        return 0


def removed_bytes(pid: int, root: Path, unknown: int) -> int:
    """Bytes on the disk of files that have no name any more, but are open or mapped.

    root: only mapped files that lay below it count.
    unknown: what a mapped file counts for whose size this process may not see.
    """
    found = dict(_open_files(pid))
    for key, size in _mapped_files(pid, os.path.realpath(root)):
        if size is not None or key not in found:
            found[key] = unknown if size is None else size
    return sum(found.values())


def _open_files(pid: int) -> Iterator[tuple[tuple[int, int], int]]:
    """(device and inode, bytes) of removed files that are open."""
    with contextlib.suppress(OSError):
        for name in os.listdir(f"/proc/{pid}/fd"):
            with contextlib.suppress(OSError):
                status = os.stat(f"/proc/{pid}/fd/{name}")
                if stat.S_ISREG(status.st_mode) and status.st_nlink == 0:
                    yield (status.st_dev, status.st_ino), status.st_blocks * 512


def _mapped_files(pid: int, root: str) -> Iterator[tuple[tuple[int, int], int | None]]:
    """(device and inode, bytes or None) of removed files that are mapped."""
    with contextlib.suppress(OSError), open(f"/proc/{pid}/maps", errors="replace") as lines:
        for line in lines:
            if not line.endswith(" (deleted)\n"):
                continue
            addresses, _, _, device, inode, path = line.split(None, 5)
            if path.startswith(root + os.sep):
                major, minor = (int(part, 16) for part in device.split(":"))
                size = None
                with contextlib.suppress(OSError):  # root only
                    status = os.stat(f"/proc/{pid}/map_files/{addresses}")
                    size = status.st_blocks * 512
                yield (os.makedev(major, minor), int(inode)), size


def processor_seconds(pid: int) -> float | None:
    """Processor time of all its threads, ended ones too; None if it cannot be known."""
    try:
        text = Path(f"/proc/{pid}/stat").read_text(errors="replace")
    except OSError:
        return None
    fields = text[text.rindex(")") + 2 :].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def delayed_seconds(pid: int) -> float:
    """How long its first thread was ready to run and had to wait for a processor."""
    with contextlib.suppress(OSError, IndexError):
        return int(Path(f"/proc/{pid}/schedstat").read_text().split()[1]) / 1e9
    return 0.0


def memory_kills() -> int:
    """How many processes Linux has killed for lack of memory since it was started."""
    with contextlib.suppress(OSError):
        for line in Path("/proc/vmstat").read_text().splitlines():
            if line.startswith("oom_kill "):
                return int(line.split()[1])
    return 0


def is_full(folder: Path) -> bool:
    """Whether hardly anything can be written to a folder's file system any more."""
    try:
        status = os.statvfs(folder)
    except OSError:
        return False
    return status.f_bavail * status.f_frsize < MIN_FREE or 0 < status.f_favail < MIN_FREE_FILES
