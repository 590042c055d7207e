"""Takes every signal for itself, also the one of the processor's time, and goes on for ever."""

import faulthandler
import itertools
import signal


def hostile(*arguments, **options):
    for number in range(1, 65):
        try:
            signal.signal(number, lambda *_: None)
        except (OSError, ValueError):
            continue
    signal.setitimer(signal.ITIMER_REAL, 0.001, 0.001)
    signal.pthread_sigmask(signal.SIG_BLOCK, range(1, 32))
    faulthandler.dump_traceback_later(0.2, repeat=True)
    for _ in itertools.count():
        pass
