"""Ignores every signal and exception, for ever."""

import signal
import time


def hostile(*arguments, **options):
    for number in signal.valid_signals() - {signal.SIGKILL, signal.SIGSTOP}:
        try:
            signal.signal(number, signal.SIG_IGN)
        except OSError:
            continue
    while True:
        try:
            time.sleep(60)
        except BaseException:
            continue
