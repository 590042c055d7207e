"""The time that the answers of untrusted code may take."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from botschool.sandbox import usage


class Allowance:
    """Limits processor time, and generously what passes besides, over any number of answers.

    A child that has to wait for a processor, because others use it, is charged nothing for that.
    A sleeping one is: after 2 * seconds + 2, in which it need not compute, it is enough; after
    10 * seconds + 60 it is in any case. Where processor time cannot be known, the time that
    passes is charged in its place. A pause in which nobody asked what is left, since the whole
    machine or this process was stopped, counts PAUSE seconds at most.
    """

    PAUSE = 2.0

    def __init__(self, seconds: float) -> None:
        """seconds: of processor time."""
        self.seconds = seconds
        self.processor = 0.0
        """Seconds of processor time that were used."""
        self.active = 0.0
        """Seconds that passed, without waiting for a processor."""
        self.passed = 0.0
        """Seconds that passed."""

    @property
    def left(self) -> float:
        """Seconds until the first of the limits, 0 or less when there is no time left."""
        return min(
            self.seconds - self.processor,
            2 * self.seconds + 2 - self.active,
            10 * self.seconds + 60 - self.passed,
        )

    @property
    def slept(self) -> bool:
        """Whether most of the time passed without computing."""
        return self.processor < self.active / 2

    @contextmanager
    def charged(self, pid: int) -> Iterator[Callable[[], float]]:
        """Charges what a process uses in the block; gives a function that tells what is left."""
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
            if used is not None:  # else it has ended
                delay = max(0.0, usage.delayed_seconds(pid) - delayed)
                self.processor = before[0] + used - (processor or 0.0)
                self.active = before[1] + max(0.0, elapsed - delay)
            return self.left

        try:
            yield left
        finally:
            left()
