"""Read what a running process uses from Linux's /proc; on other systems, return zeros."""

from __future__ import annotations

import contextlib
import os
import stat
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

MIN_FREE, MIN_FREE_FILES = 16 * 2**20, 100
"""Free bytes and files below which a file system counts as full."""


class Unseen(Exception):
    """Linux does not let this process watch another one."""


@dataclass(frozen=True)
class Removed:
    """Files and folders that have lost their name but are still on the disk."""

    size: int = 0
    """Bytes on the disk."""
    count: int = 0


def threads(pid: int) -> int:
    """Return the process's number of threads; 0 when it has ended."""
    with _while_it_runs(pid):
        return os.stat(f"/proc/{pid}/task").st_nlink - 2
    return 0


def has_lost_its_leader(pid: int) -> bool:
    """Return whether the first thread has ended and others run: /proc then hides their files."""
    fields = _stat(pid)
    return bool(fields) and fields[0] == "Z" and int(fields[17]) > 1


def written_bytes(pid: int) -> int:
    """Return the bytes that the process has written to disks so far; 0 if Linux does not tell."""
    with contextlib.suppress(OSError):
        told = dict(line.split(": ") for line in Path(f"/proc/{pid}/io").read_text().splitlines())
        return int(told["write_bytes"]) - int(told["cancelled_write_bytes"])
    return 0


def removed(pid: int, root: Path, unknown: int) -> Removed:
    """Return the open or mapped files and folders of a process that have no name any more.

    root: mapped files count only if they lay below it.
    unknown: bytes to count for a mapped file whose size this process may not see.
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
    """Ignore errors of processes that have ended; raise Unseen for a running one that is hidden."""
    try:
        yield
    except (FileNotFoundError, ProcessLookupError):
        pass
    except PermissionError:  # also raised for a process that has ended
        fields = _stat(pid)
        if fields and fields[0] not in "ZX":
            raise Unseen from None


def _open_files(task: str) -> Iterator[tuple[tuple[int, int], int]]:
    """Yield (device and inode, bytes) of the removed files and folders that a thread holds."""
    for name in ["cwd", *(f"fd/{number}" for number in os.listdir(f"{task}/fd"))]:
        with contextlib.suppress(FileNotFoundError, ProcessLookupError):
            status = os.stat(f"{task}/{name}")
            kept = stat.S_ISREG(status.st_mode) or stat.S_ISDIR(status.st_mode)
            if kept and status.st_nlink == 0:
                yield (status.st_dev, status.st_ino), status.st_blocks * 512


def _mapped_files(pid: int, root: bytes) -> Iterator[tuple[tuple[int, int], int | None]]:
    """Yield (device and inode, bytes or None) of removed files that are mapped."""
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
    """Return the processor seconds of all threads, ended ones too; None if unknown."""
    fields = _stat(pid)
    if not fields:
        return None
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def delayed_seconds(pid: int) -> float:
    """Return the seconds in which the first thread was ready but had to wait for a processor."""
    with contextlib.suppress(OSError, IndexError):
        return int(Path(f"/proc/{pid}/schedstat").read_text().split()[1]) / 1e9
    return 0.0


def memory_kills() -> int:
    """Return how many processes Linux has killed for lack of memory since it started."""
    with contextlib.suppress(OSError):
        for line in Path("/proc/vmstat").read_text().splitlines():
            if line.startswith("oom_kill "):
                return int(line.split()[1])
    return 0


def is_full(folder: Path) -> bool:
    """Return whether a folder's file system is nearly full."""
    try:
        status = os.statvfs(folder)
    except OSError:
        return False
    return status.f_bavail * status.f_frsize < MIN_FREE or 0 < status.f_favail < MIN_FREE_FILES
