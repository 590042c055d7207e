"""Starts another interpreter by every way there is, with libraries put before its own."""

import ctypes
import os
import subprocess
import sys
from pathlib import Path


def hostile(*arguments, **options):
    Path("own.so").write_bytes(b"\x7fELF" + bytes(60))
    Path("sitecustomize.py").write_text("print('LEAKED another interpreter')\n")
    own = {"LD_PRELOAD": os.path.abspath("own.so"), "PYTHONPATH": os.getcwd()}
    program = [sys.executable, "-c", "print('LEAKED another program')"]
    libc = ctypes.CDLL(None)
    for attempt in (
        lambda: os.posix_spawn(program[0], program, own),
        lambda: subprocess.run(program, env=own),
        lambda: os.spawnve(os.P_WAIT, program[0], program, own),
        lambda: os.system(f"{program[0]} -c 'print(\"LEAKED a shell\")'"),
        lambda: os.popen("echo LEAKED").read(),
        lambda: libc.system(b"echo LEAKED"),
        lambda: os.execve(program[0], program, own),
        lambda: ctypes.CDLL("./own.so"),
    ):
        try:
            attempt()
        except OSError:
            continue
    return 0
