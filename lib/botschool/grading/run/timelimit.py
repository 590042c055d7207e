"""Limits the processor time of a block in this very thread."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

POLL_SECONDS = 0.5
"""Of processor time of the whole process, between two looks."""


class TookTooLong(BaseException):
    """The block was ended; no `except Exception` inside it catches this."""


@contextmanager
def processor_time_limit(seconds: float) -> Iterator[None]:
    """Raises TookTooLong in the block when this thread has used so much processor time.

    Only in the main thread, where Python runs signal handlers; elsewhere there is no limit. A call
    into a library is interrupted when it returns. The threads of a library do not count: there
    may be many that wait busily.
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
        # again and again, since Python drops an exception that meets a destructor
        signal.setitimer(signal.ITIMER_PROF, min(seconds, POLL_SECONDS), POLL_SECONDS)
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
