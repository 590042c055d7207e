"""Build a seccomp filter in classic BPF that allows untrusted code a list of system calls.

The filter refuses all other calls. It covers what Landlock does not: processes, sockets, signals,
scheduling of other processes; modes, owners, times and locks of files; memory that outlives or
evades the limits. syscalls.py holds the list. See linux/seccomp.h.
"""

from __future__ import annotations

import ctypes
import errno
import platform
import struct
import sys

from botschool.sandbox.syscalls import ABSENT, ALLOWED, CONDITIONAL, NEWEST, PRETENDED

_THREAD = 0x3D0F00
"""The flags of clone with which C libraries start a thread. Such a thread shares files and
folder with the others, so the watch sees them.
"""
_DETACHED = 0x400000  # musl adds this flag, which has no effect
_IOCTLS = (0x5401, 0x5413, 0x541B, 0x5421, 0x5450, 0x5451)
"""isatty, window size, bytes to read, non-blocking, close-on-exec."""
_FCNTLS = (0, 1, 2, 3, 4, 5, 36, 1030, 1032)
"""Duplicate, flags, ask for a lock, size of a pipe."""
_LOCKS = (6, 7, 37, 38)
"""F_SETLK, F_SETLKW, F_OFD_SETLK, F_OFD_SETLKW."""
_PRCTLS = (3, 15, 16, 0x53564D41)
"""Whether other processes may watch it, name of a thread, names of memory."""
_CLOSE_RANGES = (0, 4)
"""No flag, CLOSE_RANGE_CLOEXEC; CLOSE_RANGE_UNSHARE would hide descriptors."""

_LOAD, _EQUAL, _AT_LEAST, _AND, _RETURN = 0x20, 0x15, 0x35, 0x54, 0x06
_NUMBER, _ARCHITECTURE, _FIRST, _SECOND, _THIRD = 0, 4, 16, 24, 32  # offsets in seccomp_data
_MACHINES = {"x86_64": (0, 0xC000003E), "aarch64": (1, 0xC00000B7)}

Instruction = tuple[int, int, int, int]
_ALLOW: Instruction = (_RETURN, 0, 0, 0x7FFF0000)
_KILL: Instruction = (_RETURN, 0, 0, 0x80000000)


def _fail(number: int) -> Instruction:
    return (_RETURN, 0, 0, 0x00050000 | number)


_REFUSE, _PRETEND, _UNKNOWN = _fail(errno.EPERM), _fail(0), _fail(errno.ENOSYS)
_UNSUPPORTED = _fail(errno.EOPNOTSUPP)


def program(machine: str, pid: int) -> list[Instruction] | None:
    """Return the filter for a process; None for an unknown type of machine."""
    if machine not in _MACHINES or sys.maxsize < 2**32:
        return None
    column, architecture = _MACHINES[machine]
    code = [
        (_LOAD, 0, 0, _ARCHITECTURE),
        (_EQUAL, 1, 0, architecture),
        _KILL,  # 32-bit calls
        (_LOAD, 0, 0, _NUMBER),
        (_AT_LEAST, 0, 1, 0x40000000),
        _REFUSE,  # the x32 calls
    ]
    for calls, answer in ((ALLOWED, _ALLOW), (PRETENDED, _PRETEND), (ABSENT, _UNSUPPORTED)):
        for numbers in calls.values():
            if numbers[column] is not None:
                code += _when(numbers[column], [answer])
    for name, then in _conditions(pid).items():
        code += _when(CONDITIONAL[name][column], then)
    # makes the C library try an older call
    return [*code, (_AT_LEAST, 0, 1, NEWEST + 1), _UNKNOWN, _REFUSE]


def _conditions(pid: int) -> dict[str, list[Instruction]]:
    """Return the answers to the calls of CONDITIONAL, by their arguments."""
    own = _arguments(_FIRST, dict.fromkeys((pid,), _ALLOW))
    controls = dict.fromkeys(_FCNTLS, _ALLOW) | dict.fromkeys(_LOCKS, _PRETEND)
    return {
        "clone": [
            (_LOAD, 0, 0, _FIRST),
            (_AND, 0, 0, 0xFFFFFFFF & ~_DETACHED),
            (_EQUAL, 0, 1, _THREAD), _ALLOW, _REFUSE,
        ],
        "clone3": [_UNKNOWN],  # its flags lie in memory, unseen: the C library falls back to clone
        "kill": own,
        "tgkill": own,
        "ioctl": _arguments(_SECOND, dict.fromkeys(_IOCTLS, _ALLOW), _fail(errno.ENOTTY)),
        "fcntl": _arguments(_SECOND, controls),
        "prctl": _arguments(_FIRST, dict.fromkeys(_PRCTLS, _ALLOW)),
        "prlimit64": [  # only to read its own limits, not to set them
            (_LOAD, 0, 0, _FIRST), (_EQUAL, 1, 0, 0), _REFUSE,
            (_LOAD, 0, 0, _THIRD), (_EQUAL, 1, 0, 0), _REFUSE,
            (_LOAD, 0, 0, _THIRD + 4), (_EQUAL, 1, 0, 0), _REFUSE, _ALLOW,
        ],
        "close_range": _arguments(_THIRD, dict.fromkeys(_CLOSE_RANGES, _ALLOW)),
    }  # fmt: skip


def _when(number: int, then: list[Instruction]) -> list[Instruction]:
    """Return the code for one call; `then` must end with an answer."""
    return [(_EQUAL, 0, len(then), number), *then]


def _arguments(
    offset: int, answers: dict[int, Instruction], other: Instruction = _REFUSE
) -> list[Instruction]:
    """Return the code that answers according to an argument's value."""
    code = [(_LOAD, 0, 0, offset)]
    for value, answer in answers.items():
        code += [(_EQUAL, 0, 1, value), answer]
    return [*code, other]


def install(libc: ctypes.CDLL, code: list[Instruction]) -> bool:
    """Apply the filter to all threads of this process; it must not be able to gain privileges."""
    buffer = ctypes.create_string_buffer(b"".join(struct.pack("HBBI", *line) for line in code))
    filter_ = ctypes.create_string_buffer(
        struct.pack("HxxxxxxQ", len(code), ctypes.addressof(buffer))
    )
    call = {"x86_64": 317, "aarch64": 277}[platform.machine()]
    if libc.syscall(call, 1, 1, filter_) == 0:  # filter, all threads
        return True
    return libc.prctl(22, 2, filter_, 0, 0) == 0  # kernels before 3.17: only this thread
