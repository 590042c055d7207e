"""Stops its own process, so that it neither ends nor answers."""

import os
import signal


def hostile(*arguments, **options):
    os.kill(os.getpid(), signal.SIGSTOP)
    os.kill(0, signal.SIGSTOP)
