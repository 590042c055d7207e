"""Limit the time that untrusted code may take for its answers."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from botschool.sandbox import usage


class Allowance:
    """Limit the processor time of any number of answers and, more generously, the elapsed time.

    Waiting for a processor that others use costs nothing. Sleeping is limited to 2 * seconds + 2,
    and elapsed time to 10 * seconds + 60. If the system does not report processor time, elapsed
    time counts instead. A pause in which the machine or this process is stopped counts PAUSE
    seconds at most.
    """

    PAUSE = 2.0

    def __init__(self, seconds: float) -> None:
        """Allow `seconds` of processor time."""
        self.seconds = seconds
        self.processor = 0.0
        """Seconds of processor time used."""
        self.active = 0.0
        """Seconds passed, without the time spent waiting for a processor."""
        self.passed = 0.0
        """Seconds passed."""

    @property
    def left(self) -> float:
        """Return the seconds until the first limit; 0 or less when no time is left."""
        return min(
            self.seconds - self.processor,
            2 * self.seconds + 2 - self.active,
            10 * self.seconds + 60 - self.passed,
        )

    @property
    def slept(self) -> bool:
        """Return whether the code spent most of the time without computing."""
        return self.processor < self.active / 2

    @contextmanager
    def charged(self, pid: int) -> Iterator[Callable[[], float]]:
        """Charge a process's use in the block; yield a function that returns the seconds left."""
        before = self.processor, self.active, self.passed
        asked, elapsed = time.monotonic(), 0.0
        processor, delayed = usage.processor_seconds(pid), usage.delayed_seconds(pid)

        def left() -> float:
            nonlocal asked, elapsed
            now = time.monotonic()
            elapsed += min(now - asked, self.PAUSE)
            asked = now
            used = elapsed if processor is None else usage.processor_seconds(pid)
            self.passed = before[2] + elapsed
            if used is not None:  # else the process has ended
                delay = max(0.0, usage.delayed_seconds(pid) - delayed)
                self.processor = before[0] + used - (processor or 0.0)
                self.active = before[1] + max(0.0, elapsed - delay)
            return self.left

        try:
            yield left
        finally:
            left()
