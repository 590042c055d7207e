"""Give the fork server a mount namespace, so that scratch folders lie in memory and are limited.

The kernel then enforces the limits, whatever the untrusted code does with files. Root enters a
mount namespace directly; other users also enter a user namespace, if the system allows it. See
mount_namespaces(7), user_namespaces(7), tmpfs(5).
"""

from __future__ import annotations

import ctypes
import os
import sys
from pathlib import Path

_NEW_MOUNTS, _NEW_USER = 0x20000, 0x10000000  # CLONE_NEWNS, CLONE_NEWUSER
_NO_SET_UID, _NO_DEVICES, _RECURSIVE, _PRIVATE = 2, 4, 0x4000, 1 << 18  # MS_...


def enter(folder: str) -> bool:
    """Move this process into a mount namespace of its own; return whether that worked.

    The process must have one thread. folder: an empty one. Another process tries everything there
    first, so a failure changes nothing in this process.
    """
    if sys.platform != "linux":
        return False
    trial = os.fork()
    if trial == 0:
        works = False
        try:
            works = _enter() and mount(folder, 2**20, 10)
        finally:
            os._exit(0 if works else 1)
    return os.waitpid(trial, 0)[1] == 0 and _enter()


def mount(folder: str, size: int, files: int) -> bool:
    """Mount a file system in memory on a folder; return whether that worked.

    size, files: its bytes, and its number of files and folders.
    """
    options = f"size={size},nr_inodes={files},mode=0700".encode()
    place, flags = os.fsencode(folder), _NO_SET_UID | _NO_DEVICES
    return _libc().mount(b"tmpfs", place, b"tmpfs", ctypes.c_ulong(flags), options) == 0


def _enter() -> bool:
    libc = _libc()
    user, group = os.getuid(), os.getgid()
    if libc.unshare(_NEW_MOUNTS) != 0:
        if libc.unshare(_NEW_MOUNTS | _NEW_USER) != 0:
            return False
        try:
            Path("/proc/self/setgroups").write_text("deny")
            Path("/proc/self/uid_map").write_text(f"{user} {user} 1")
            Path("/proc/self/gid_map").write_text(f"{group} {group} 1")
        except OSError:
            return False
    # mounts made here stay in this namespace
    return libc.mount(None, b"/", None, ctypes.c_ulong(_RECURSIVE | _PRIVATE), None) == 0


def _libc() -> ctypes.CDLL:
    return ctypes.CDLL(None, use_errno=True)
