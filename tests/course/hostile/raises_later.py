"""Has exceptions raised outside itself: in the code that called it, when that goes on."""

import ctypes
import os
import signal
import sys
import threading
import time


class Thrown(BaseException):
    pass


def throw(*_):
    raise Thrown


def hostile(*arguments, **options):
    os._exit = sys.exit = lambda *_: None
    main = threading.main_thread().ident

    def pester():
        while True:
            ctypes.pythonapi.PyThreadState_SetAsyncExc(
                ctypes.c_ulong(main), ctypes.py_object(Thrown)
            )
            time.sleep(0.0005)

    signal.signal(signal.SIGALRM, throw)
    signal.setitimer(signal.ITIMER_REAL, 0.001, 0.001)
    threading.Thread(target=pester, daemon=True).start()
    return 0
