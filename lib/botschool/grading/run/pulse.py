"""End a training that stands still, in the confined child: an endless loop takes no steps.

The watchers of trainings call `beat` at each evaluation, step of an environment and gradient.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count

STILL = 8.0
"""Processor seconds without a beat. Code between two of them takes milliseconds."""
LOOK = STILL / 2
_beats = count(1)
_last = [0]


class StandsStill(BaseException):
    """A training does not go on."""


def beat() -> None:
    """Note that a training goes on."""
    _last[0] = next(_beats)


@contextmanager
def alive() -> Iterator[None]:
    """Raise StandsStill within the block if there is no beat for so long."""
    seen, looks = _last[0], 0

    def look(*_: object) -> None:
        nonlocal seen, looks
        looks = looks + 1 if seen == _last[0] else 0
        seen = _last[0]
        if looks >= STILL / LOOK:
            raise StandsStill

    if threading.current_thread() is not threading.main_thread():  # no signal reaches it
        yield
        return
    before = signal.signal(signal.SIGPROF, look)
    signal.setitimer(signal.ITIMER_PROF, LOOK, LOOK)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
