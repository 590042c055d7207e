"""Ctrl-C, SIGTERM and a closed terminal ask a run to stop; a second time ends it at once."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

SHOW_CURSOR = b"\x1b[?25h\n"
"""What a terminal needs after a progress bar that was broken off."""


SIGNALS = [
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
]


@contextmanager
def stoppable() -> Iterator[Callable[[], bool]]:
    """Gives a function that tells whether the user has asked to stop.

    Nothing is tidied up after a second request: like after a kill, files are whole and --resume
    goes on from the last ones, and worker processes end with this one.
    """
    requested = False
    before = {}

    def stop(number: int, frame: object) -> None:
        nonlocal requested
        if requested:
            if sys.stdout.isatty():
                os.write(sys.stdout.fileno(), SHOW_CURSOR)
            os._exit(130)
        requested = True

    for number in SIGNALS:
        before[number] = signal.signal(number, stop)
    try:
        yield lambda: requested
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
