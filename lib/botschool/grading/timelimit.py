"""Limits the processor time of a block in this very process."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager


class TookTooLong(BaseException):
    """The block was ended; no `except Exception` inside it catches this."""


@contextmanager
def processor_time_limit(seconds: float) -> Iterator[None]:
    """Raises TookTooLong in the block when this process has used so much processor time.

    Only in the main thread, where Python runs signal handlers; elsewhere there is no limit. A call
    into a library is interrupted when it returns.
    """
    main = threading.current_thread() is threading.main_thread()
    if not main or not hasattr(signal, "setitimer"):
        yield
        return

    def end(number: int, frame: object) -> None:
        raise TookTooLong

    before = signal.signal(signal.SIGPROF, end)
    try:
        # again and again, since Python drops an exception that meets a destructor
        signal.setitimer(signal.ITIMER_PROF, seconds, 1)
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)
