"""Takes memory outside its limits: System V segments, anonymous files, queues."""

import ctypes
import os


def hostile(*arguments, **options):
    libc = ctypes.CDLL(None)
    for _ in range(16):
        libc.shmget(0, 32 * 2**20, 0o1777)
        libc.semget(0, 100, 0o1777)
        libc.msgget(0, 0o1777)
        try:
            os.write(os.memfd_create("hidden"), b"1" * 2**20)
        except OSError:
            continue
    return 0
