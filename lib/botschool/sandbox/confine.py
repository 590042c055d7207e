"""Confine this process for good, by resource limits, Landlock, seccomp and capabilities.

On Linux, Landlock restricts files, a seccomp filter (seccomp.py) restricts system calls, and the
process drops its capabilities. This needs no privileges. Resource limits hold on every system that
has Python's `resource`. See linux/landlock.h, capabilities(7), setrlimit(2).
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import platform
import signal
import struct
import sys
from pathlib import Path

from botschool.sandbox import seccomp

# see linux/landlock.h
_LANDLOCK_CREATE, _LANDLOCK_ADD, _LANDLOCK_RESTRICT = 444, 445, 446
_READ = 0b1101  # execute, read file, read directory
_LIST = 0b1000  # read directory
_ON_FILES = 0b1100_0000_0000_0111  # rights that apply to a file
_NEVER = 0b1000_1010_0100_0000  # device nodes, sockets, control of devices
_RIGHTS_OF_VERSION = {1: 13, 2: 14, 3: 15, 4: 15, 5: 16}

_PR_SET_PDEATHSIG, _PR_SET_NO_NEW_PRIVS = 1, 38
_CAP_DAC_READ_SEARCH = 2


def limit(seconds: float, memory: int, file_size: int) -> None:
    """Limit processor seconds, additional bytes of address space, and bytes of a file."""
    with contextlib.suppress(OSError):  # if memory runs out, Linux kills this process first
        Path("/proc/self/oom_score_adj").write_text("1000")
    cpu = int(seconds) + 2  # the caller watches the time; this limit holds if the caller has ended
    for name, *values in (
        ("RLIMIT_CPU", cpu, cpu + 2),  # first a signal, then the end
        ("RLIMIT_AS", memory + _in_use()),
        ("RLIMIT_FSIZE", file_size),
        ("RLIMIT_CORE", 1),  # with 0, a core dump still goes to a program that collects core dumps
        ("RLIMIT_NOFILE", 256),
        ("RLIMIT_MEMLOCK", 0),
    ):
        _set(name, *values)


def _in_use() -> int:
    try:
        return int(Path("/proc/self/statm").read_text().split()[0]) * os.sysconf("SC_PAGE_SIZE")
    except OSError:
        return 0


def _set(name: str, value: int, most: int | None = None) -> None:
    """Set a soft and a hard limit, both at most the present hard one."""
    try:
        import resource

        which = getattr(resource, name)
        hard = resource.getrlimit(which)[1]
        pair = value, value if most is None else most
        if hard != resource.RLIM_INFINITY:
            pair = min(pair[0], hard), min(pair[1], hard)
        resource.setrlimit(which, pair)
    except (ImportError, AttributeError, ValueError, OSError):
        pass


def end_with(parent: int) -> None:
    """End this process when its parent ends (Linux); parent: its process id."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
        if os.getppid() != parent:  # the parent ended before the call
            os._exit(1)


def confine(readable: list[Path], listed: list[Path], writable: list[Path]) -> list[str]:
    """Confine files and system calls; return what this system cannot confine.

    listed: folders whose names, but not files, can be read, down to the last folder.
    That is a list of some of "files", "processes", "network".
    """
    everything = ["files", "processes", "network"]
    if sys.platform != "linux":
        _set("RLIMIT_NPROC", 0)
        return everything
    libc = ctypes.CDLL(None, use_errno=True)
    libc.syscall.restype = ctypes.c_long
    if libc.prctl(_PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0:
        return everything
    missing = [] if _landlock(libc, readable, listed, writable) else ["files"]
    _drop_capabilities(libc)
    code = seccomp.program(platform.machine(), os.getpid())
    if code is None or not seccomp.install(libc, code):
        missing += ["processes", "network"]
        _set("RLIMIT_NPROC", 0)  # no more processes or threads, except for root
    return missing


def _drop_capabilities(libc: ctypes.CDLL) -> None:
    """Drop all privileges of root except reading; other users have none to drop."""
    header = struct.pack("Ii", 0x20080522, 0)  # version 3, this thread
    held = ctypes.create_string_buffer(24)
    if libc.capget(header, held) != 0:
        return
    keep = struct.unpack("6I", held.raw)[1] & (1 << _CAP_DAC_READ_SEARCH)
    libc.capset(header, struct.pack("6I", keep, keep, 0, 0, 0, 0))


def _landlock(
    libc: ctypes.CDLL, readable: list[Path], listed: list[Path], writable: list[Path]
) -> bool:
    version = libc.syscall(_LANDLOCK_CREATE, None, 0, 1)
    if version < 1:
        return False
    handled = (1 << _RIGHTS_OF_VERSION.get(version, 16)) - 1
    attributes = struct.pack("Q", handled)
    if version >= 4:
        attributes = struct.pack("QQ", handled, 0b11)  # TCP bind and connect
    if version >= 6:
        attributes = struct.pack("QQQ", handled, 0b11, 0b11)  # abstract sockets, signals
    rules = libc.syscall(_LANDLOCK_CREATE, attributes, len(attributes), 0)
    if rules < 0:
        return False
    given = (readable, _READ), (listed, _LIST), (writable, handled & ~_NEVER)
    for paths, access in given:
        for path in paths:
            try:
                fd = os.open(path, os.O_PATH | os.O_CLOEXEC)
            except OSError:
                continue
            allowed = access & handled & (-1 if path.is_dir() else _ON_FILES)
            rule = struct.pack("=Qi", allowed, fd)
            added = libc.syscall(_LANDLOCK_ADD, rules, 1, rule, 0)
            os.close(fd)
            if added != 0:
                return False
    confined = libc.syscall(_LANDLOCK_RESTRICT, rules, 0) == 0
    os.close(rules)
    return confined
