"""Measure how the workers of a cluster spend their time, and what they wait for."""

from __future__ import annotations

import time


class Bottleneck:
    """Counts worker-seconds by their use, and bytes sent and received."""

    def __init__(self) -> None:
        self.sent = self.received = 0
        """Bytes of messages, without Dask's own."""
        self.candidates = 0
        """Genotypes that workers evaluated."""
        self.here = 0.0
        """Seconds of batches that this machine evaluated because they were too short to send."""
        self.busy = self._last = self._slowest = self._inside = self._outside = 0.0
        self._workers = 0
        self._began = self._ended = time.monotonic()
        self._idle: dict[str, float] = {}

    def begin(self) -> None:
        """Begin a batch."""
        self._began = time.monotonic()
        self._outside += (self._began - self._ended) * self._workers
        self._last = self.busy
        self._idle = {}

    def nobody(self) -> None:
        """Restart the batch's clock, because there are no workers."""
        self._began = time.monotonic()

    def evaluated(self, seconds: float) -> None:
        """Add seconds that a worker has computed."""
        self.busy += seconds

    def idle(self, worker: str, now: float) -> None:
        """Note that no work is left to give to a worker."""
        self._idle[worker] = now

    def end(self, workers: int) -> float:
        """End the batch with this many workers; return the seconds they have computed."""
        self._ended = time.monotonic()
        self._workers = max(1, workers)
        self._inside += (self._ended - self._began) * self._workers
        self._slowest += sum(self._ended - since for since in self._idle.values())
        return self.busy - self._last

    def shares(self) -> dict[str, float]:
        """Return shares of the workers' time, which add up to 1; {} if they have done nothing."""
        total = self._inside + self._outside
        if not total or not self.busy:
            return {}
        wire = max(0.0, self._inside - self.busy - self._slowest)
        parts = {
            "evaluation": self.busy,
            "waiting for the slowest chunk": self._slowest,
            "wire": wire,
            "algorithm and files": self._outside,
        }
        return {name: seconds / sum(parts.values()) for name, seconds in parts.items()}

    def line(self) -> str:
        """Return a sentence about the shares; "" if workers have done nothing."""
        shares = self.shares()
        if not shares:
            return ""
        said = ", ".join(f"{name} {100 * share:.0f} %" for name, share in shares.items())
        if self.candidates:
            said += f"; {(self.sent + self.received) / self.candidates:.0f} bytes a candidate"
        return f"time of the workers: {said}"
