"""Sends signals to the grader, its group and everybody, directly and by way of files."""

import fcntl
import os
import signal


def hostile(*arguments, **options):
    reading, writing = os.pipe()
    for number in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGSTOP):
        for send in (
            lambda: os.kill(os.getppid(), number),
            lambda: os.killpg(os.getpgid(os.getppid()), number),
            lambda: os.kill(-1, 0),
            lambda: signal.pidfd_send_signal(os.pidfd_open(os.getppid()), number),
            lambda: owned_by_parent(reading, writing, number),
        ):
            try:
                send()
            except OSError:
                continue
    return 0


def owned_by_parent(reading, writing, number):
    fcntl.fcntl(reading, fcntl.F_SETOWN, os.getppid())
    fcntl.fcntl(reading, 10, number)  # F_SETSIG
    fcntl.fcntl(reading, fcntl.F_SETFL, os.O_ASYNC | os.O_NONBLOCK)
    os.write(writing, b"1")
