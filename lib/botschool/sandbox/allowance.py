"""Limit the time that untrusted code may take for its answers."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager

from botschool.sandbox import usage

LOOK_SECONDS = 0.02
"""Seconds between two looks at what a process has used."""


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
        self.helped = False
        """Whether the caller has worked for the code."""

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
        """Return whether the code spent most of the time without computing or asking."""
        return not self.helped and self.processor < self.active / 2

    @contextmanager
    def charged(self, pid: int) -> Iterator[Charge]:
        """Charge a process's use in the block; yield what returns the seconds left."""
        charge = Charge(self, pid)
        try:
            yield charge
        finally:
            charge.look()


class Charge:
    """Charges a process's use; called, it returns the seconds left."""

    def __init__(self, allowance: Allowance, pid: int) -> None:
        self._allowance, self._pid = allowance, pid
        self._before = allowance.processor, allowance.active, allowance.passed
        self._helped = 0.0
        self._elapsed, self._asked, self._looked = 0.0, time.monotonic(), time.monotonic()
        self._processor = usage.processor_seconds(pid)
        self._delayed = usage.delayed_seconds(pid)

    def __call__(self) -> float:
        if time.monotonic() - self._looked > LOOK_SECONDS:
            self.look()
        return self._allowance.left

    def look(self) -> None:
        """See what the process has used."""
        allowance, before = self._allowance, self._before
        self._looked = now = time.monotonic()
        self._elapsed += min(now - self._asked, allowance.PAUSE)
        self._asked = now
        used = usage.processor_seconds(self._pid)
        if self._processor is None:
            used = self._elapsed
        allowance.passed = before[2] + self._elapsed
        if used is not None:  # else the process has ended
            delay = max(0.0, usage.delayed_seconds(self._pid) - self._delayed)
            allowance.processor = before[0] + used - (self._processor or 0.0) + self._helped
            allowance.active = before[1] + max(0.0, self._elapsed - delay)

    @contextmanager
    def helping(self) -> Iterator[None]:
        """Charge the processor time of this thread in the block, and not the time that passes."""
        self._allowance.helped = True
        self._elapsed += min(time.monotonic() - self._asked, self._allowance.PAUSE)
        start = time.thread_time()
        try:
            yield
        finally:
            spent = time.thread_time() - start
            self._helped += spent
            self._elapsed += spent
            self._asked = time.monotonic()
