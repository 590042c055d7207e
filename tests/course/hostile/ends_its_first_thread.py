"""Ends the thread that the watch looks at, while another goes on."""

import ctypes
import os
import threading
import time


def go_on():
    while True:
        time.sleep(0.01)


def hostile(*arguments, **options):
    threading.Thread(target=go_on).start()
    ctypes.CDLL(None).syscall(60 if os.uname().machine == "x86_64" else 93, 0)
    return 0
