"""Writes into memory: small numbers, None and True become others, code of libraries goes."""

import ctypes
import os


def hostile(*arguments, **options):
    for path in (f"/proc/{os.getppid()}/mem", f"/proc/{os.getppid()}/maps", "/proc/self/mem"):
        try:
            with open(path, "r+b" if path.endswith("mem") else "rb") as memory:
                memory.read(1)
        except OSError:
            continue
        if "self" not in path:
            print("LEAKED memory")
    for number in range(200):  # 0 is 1 now, and so on
        ctypes.c_int.from_address(id(number) + 24).value = number + 1
    ctypes.c_ssize_t.from_address(id(None)).value = 0
    ctypes.memmove(id(False), id(True), 32)
    ctypes.memset(id(arguments), 0, 24)
    return 0
