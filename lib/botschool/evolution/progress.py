"""Show the progress of runs: progress bars, or a line per generation."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from botschool.evolution.run import Run
from botschool.terminal import progress_bar

SECONDS = 0.1
"""Seconds between two messages; a generation may take less than a millisecond."""

SAMPLE, LONG = 3.0, 60.0
"""Seconds of a run that tell its speed, and seconds left that are worth a line."""

Bar = tuple[float, int, int, str]
"""Arguments for a progress bar: see botschool.terminal."""


@contextmanager
def reporting(seed: int, terminal: bool) -> Iterator[Callable[[Run], None]]:
    """Yield a function to call with the run after each generation, and at will during one."""
    if terminal:
        with progress_bar(seed) as show, messages(True, lambda bar: show(*bar)) as report:
            yield report
    else:
        with messages(False, print_lines) as report:
            yield report


def print_lines(lines: list[str]) -> None:
    """Print the lines in one call."""
    print("\n".join(lines), flush=True)


@contextmanager
def messages(terminal: bool, send: Callable[[Any], None]) -> Iterator[Callable[[Run], None]]:
    """Yield a function like `reporting`'s that calls `send` every SECONDS and at the end.

    It sends the state of a progress bar, or the lines since the last call.
    """
    newest: Run | None = None
    lines: list[str] = []
    printed, sent = 0, -SECONDS
    began: tuple[float, float] | None = None
    expected = terminal  # the progress bar says it

    def expect(run: Run) -> None:
        """Say once, after some seconds, how long a long run will take."""
        nonlocal began, expected
        share, now = run.limit.share(run), time.monotonic()
        if began is None or share <= began[1]:  # nothing of the run itself is done yet
            began = now, share
        if now - began[0] < SAMPLE:
            return
        left = (now - began[0]) * (1 - share) / (share - began[1])
        expected = True
        if left >= LONG:
            lines.append(f"seed {run.seed}: about {lasting(left)} left at this speed")

    def report(run: Run) -> None:
        nonlocal newest, printed, sent
        newest = run
        if not expected:
            expect(run)
        if not terminal and run.record.generation > printed:
            lines.append(run.line())
            printed = run.record.generation
        now = time.monotonic()
        if now >= sent + SECONDS:
            flush()
            sent = now

    def flush() -> None:
        nonlocal newest
        if terminal and newest:
            send(bar(newest))
            newest = None
        elif lines:
            send(lines.copy())
            lines.clear()

    try:
        yield report
    finally:
        flush()


def lasting(seconds: float) -> str:
    """Return a duration in words: 40 seconds, 3 minutes, 2.5 hours, 4 days."""
    for unit, size in (("days", 86_400), ("hours", 3600), ("minutes", 60)):
        if seconds >= 2 * size:
            return f"{seconds / size:.2g} {unit}"
    whole = max(1, round(seconds))
    return "1 second" if whole == 1 else f"{whole} seconds"


def bar(run: Run) -> Bar:
    """Return the state of a run's progress bar."""
    share, record = run.limit.share(run), run.record
    numbers = run.numbers() if record.generation else ""
    return share, record.steps, 2, "  ".join(filter(None, (numbers, run.problem.status())))
