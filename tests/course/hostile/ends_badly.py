"""Leaves work for the end: objects that fight back, hooks, finalizers; then it exits."""

import atexit
import gc
import os
import sys
import threading
import time
import weakref


class Phoenix:
    def __del__(self):
        globals()["risen"] = Phoenix()
        os.write(2, b"still here\n")
        time.sleep(0.2)


def stay(*arguments):
    while True:
        time.sleep(0.1)


def hostile(*arguments, **options):
    atexit.register(stay)
    threading._register_atexit(stay)
    weakref.finalize(Phoenix, stay)
    sys.excepthook = sys.unraisablehook = threading.excepthook = stay
    gc.callbacks.append(lambda *_: Phoenix())
    cycle = [Phoenix()]
    cycle.append(cycle)
    sys.exitfunc = stay
    os._exit = lambda code: None
    raise SystemExit(0)
