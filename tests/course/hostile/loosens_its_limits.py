"""Raises its own limits, and looks for rights that it might still have."""

import ctypes
import os
import resource


def hostile(*arguments, **options):
    libc = ctypes.CDLL(None)
    for which in (resource.RLIMIT_AS, resource.RLIMIT_FSIZE, resource.RLIMIT_CPU):
        try:
            resource.setrlimit(which, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        except (ValueError, OSError):
            continue
        print("LEAKED a limit")
    for attempt in (
        lambda: os.mknod("disk", 0o60600, os.makedev(8, 0)),
        lambda: os.setuid(0) if os.getuid() else os.chroot("."),
        lambda: os.open("/dev/mem", os.O_RDWR),
        lambda: os.open("/etc/shadow", os.O_RDONLY),
    ):
        try:
            attempt()
        except OSError:
            continue
        print("LEAKED a right")
    libc.unshare(0x10000000)
    libc.mount(b"none", b"/", b"tmpfs", 0, None)
    return libc.prctl(1, 0, 0, 0, 0)
