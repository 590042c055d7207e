"""What a running process uses, as Linux tells in /proc; elsewhere nothing is known (zeros)."""

from __future__ import annotations

import contextlib
import os
import stat
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

MIN_FREE, MIN_FREE_FILES = 16 * 2**20, 100
"""Bytes and files below which a file system counts as full."""


class Unseen(Exception):
    """A running process cannot be watched."""


@dataclass(frozen=True)
class Removed:
    """Files and folders that have no name any more, and are still on the disk."""

    size: int = 0
    """Bytes on the disk."""
    count: int = 0


def threads(pid: int) -> int:
    """Return the number of its threads; 0 when it has ended."""
    with _while_it_runs(pid):
        return os.stat(f"/proc/{pid}/task").st_nlink - 2
    return 0


def has_lost_its_leader(pid: int) -> bool:
    """Return whether the first thread has ended and others run: /proc then hides what they hold."""
    fields = _stat(pid)
    return bool(fields) and fields[0] == "Z" and int(fields[17]) > 1


def written_bytes(pid: int) -> int:
    """Return the bytes that it has written to disks so far; 0 where Linux does not tell."""
    with contextlib.suppress(OSError):
        told = dict(line.split(": ") for line in Path(f"/proc/{pid}/io").read_text().splitlines())
        return int(told["write_bytes"]) - int(told["cancelled_write_bytes"])
    return 0


def removed(pid: int, root: Path, unknown: int) -> Removed:
    """Return what it holds of files and folders that have no name any more: open or mapped ones.

    root: only mapped files that lay below it count.
    unknown: what a mapped file counts for whose size this process may not see.
    Raises Unseen.
    """
    found = {}
    with _while_it_runs(pid):
        for thread in os.listdir(f"/proc/{pid}/task"):
            with _while_it_runs(pid):
                found |= dict(_open_files(f"/proc/{pid}/task/{thread}"))
        for key, size in _mapped_files(pid, os.fsencode(os.path.realpath(root))):
            if size is not None or key not in found:
                found[key] = unknown if size is None else size
    return Removed(sum(found.values()), len(found))


@contextlib.contextmanager
def _while_it_runs(pid: int) -> Iterator[None]:
    """Ignore what has ended; raises Unseen for what runs and may not be seen."""
    try:
        yield
    except (FileNotFoundError, ProcessLookupError):
        pass
    except PermissionError:  # of a process that has ended, too
        fields = _stat(pid)
        if fields and fields[0] not in "ZX":
            raise Unseen from None


def _open_files(task: str) -> Iterator[tuple[tuple[int, int], int]]:
    """Give (device and inode, bytes) of removed files and folders that a thread holds."""
    for name in ["cwd", *(f"fd/{number}" for number in os.listdir(f"{task}/fd"))]:
        with contextlib.suppress(FileNotFoundError, ProcessLookupError):
            status = os.stat(f"{task}/{name}")
            kept = stat.S_ISREG(status.st_mode) or stat.S_ISDIR(status.st_mode)
            if kept and status.st_nlink == 0:
                yield (status.st_dev, status.st_ino), status.st_blocks * 512


def _mapped_files(pid: int, root: bytes) -> Iterator[tuple[tuple[int, int], int | None]]:
    """Give (device and inode, bytes or None) of removed files that are mapped."""
    with open(f"/proc/{pid}/maps", "rb") as lines:  # a name may hold any byte; newlines are escaped
        for line in lines:
            if not line.endswith(b" (deleted)\n"):
                continue
            addresses, _, _, device, inode, path = line.split(None, 5)
            if path.startswith(root + b"/"):
                major, minor = (int(part, 16) for part in device.split(b":"))
                size = None
                with contextlib.suppress(OSError):  # root only
                    status = os.stat(f"/proc/{pid}/map_files/{addresses.decode()}")
                    size = status.st_blocks * 512
                yield (os.makedev(major, minor), int(inode)), size


def _stat(pid: int) -> list[str]:
    """Return the fields of /proc/PID/stat from the state on; [] when there is no such process."""
    try:
        text = Path(f"/proc/{pid}/stat").read_text(errors="replace")
    except OSError:
        return []
    return text[text.rindex(")") + 2 :].split()


def processor_seconds(pid: int) -> float | None:
    """Processor time of all its threads, ended ones too; None if it cannot be known."""
    fields = _stat(pid)
    if not fields:
        return None
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
