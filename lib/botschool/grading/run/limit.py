"""Limit the processor time of code of ours in this thread."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

POLL_SECONDS = 0.5
"""Processor seconds of the whole process between two checks."""


class TookTooLong(BaseException):
    """The time limit ends the block; no `except Exception` inside it catches this."""


@contextmanager
def processor_time_limit(seconds: float) -> Iterator[None]:
    """Raise TookTooLong in the block when this thread has used so much processor time.

    The limit works only in the main thread, where Python runs signal handlers. A call into a
    library is interrupted when it returns. A library's threads do not count: many of them may wait
    busily.
    """
    main = threading.current_thread() is threading.main_thread()
    if not main or not hasattr(signal, "setitimer"):
        yield
        return

    start = time.thread_time()

    def end(number: int, frame: object) -> None:
        if time.thread_time() - start >= seconds:
            raise TookTooLong

    before = signal.signal(signal.SIGPROF, end)
    try:
        # repeatedly, because Python drops an exception raised in a destructor
        signal.setitimer(signal.ITIMER_PROF, min(seconds, POLL_SECONDS), POLL_SECONDS)
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
