"""What long-running commands share: requests to stop, a progress bar, display or none."""

from __future__ import annotations

import math
import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial

SHOW_CURSOR = b"\x1b[?25h\n"
"""What a terminal needs after a progress bar that was broken off."""


SIGNALS = [
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
]


@contextmanager
def stoppable() -> Iterator[Callable[[], bool]]:
    """Return a function that tells whether the user has asked to stop.

    Ctrl-C, SIGTERM and a closed terminal ask; a second time ends the process at once.

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


@contextmanager
def exits_on_signals() -> Iterator[None]:
    """SIGTERM and a closed terminal raise SystemExit in the block, so that it can tidy up.

    A second one ends the process at once.
    """
    asked = False

    def end(number: int, frame: object) -> None:
        nonlocal asked
        if asked:
            os._exit(128 + number)
        asked = True
        raise SystemExit(128 + number)

    signals = [number for number in SIGNALS if number != signal.SIGINT]
    # nohup has a closed terminal ignored
    before = {n: signal.getsignal(n) for n in signals if signal.getsignal(n) != signal.SIG_IGN}
    for number in before:
        signal.signal(number, end)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def unheard(signals: list[int] = SIGNALS) -> Iterator[None]:
    """Processes that start meanwhile never get these signals; here they come at the end."""
    if not hasattr(signal, "pthread_sigmask"):  # Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, signals)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def progress_bar(seed: int) -> Iterator[Callable[[float, int, int, str], None]]:
    """Return a function to call with the share done, the steps so far, decimals of their millions,
    and a text."""
    with progress_bars() as bars:
        yield partial(bars.show, seed)


class Bars:
    """A progress bar for each seed that has been shown and is not finished."""

    def __init__(self, progress) -> None:
        """progress: rich.progress.Progress with the columns of `progress_bars`."""
        self._progress = progress
        self._tasks = {}

    def show(self, seed: int, share: float, steps: int, decimals: int, numbers: str) -> None:
        """What `progress_bar` says, for a seed."""
        if seed not in self._tasks:
            empty = {"steps": "", "numbers": ""}
            self._tasks[seed] = self._progress.add_task("", total=1.0, seed=seed, **empty)
        fields = {"steps": f"{steps / 1e6:.{decimals}f}M", "numbers": numbers}
        self._progress.update(self._tasks[seed], completed=min(share, 1.0), **fields)

    def finish(self, seed: int, text: str) -> None:
        """Put a text in the place of a seed's bar."""
        if seed in self._tasks:
            self._progress.remove_task(self._tasks.pop(seed))
        self._progress.print(text, markup=False, highlight=False, soft_wrap=True)


@contextmanager
def progress_bars() -> Iterator[Bars]:
    """Return several progress bars, one below the other."""
    from rich.progress import (
        BarColumn,
        Progress,
        TaskProgressColumn,
        TextColumn,
        TimeRemainingColumn,
    )

    columns = (
        TextColumn("seed {task.fields[seed]}"),
        BarColumn(bar_width=8),
        TaskProgressColumn(),
        TextColumn("{task.fields[steps]}"),
        TimeRemainingColumn(compact=True),
        TextColumn("{task.fields[numbers]}"),
    )
    with Progress(*columns, refresh_per_second=5) as progress:
        yield Bars(progress)


def readable(value: float) -> str:
    """Return a fitness, with the digits that its size asks for: 2261.4, -66.31, 0.6500, 0.0001234.

    Four digits that count and at least one decimal; powers of ten past 10^7 and below 10^-6.
    """
    size = abs(value)
    if not math.isfinite(value) or size >= 1e7 or 0 < size < 1e-6:
        return f"{value:.3e}" if math.isfinite(value) else str(value)
    if size >= 1 or size == 0:
        return f"{value:.{1 if size >= 100 else 2}f}"
    return f"{value:.{3 - math.floor(math.log10(size))}f}"


def has_display() -> bool:
    """Return whether a window can be expected to open."""
    if os.environ.get("SDL_VIDEODRIVER") in ("dummy", "offscreen"):
        return False
    if sys.platform in ("win32", "darwin"):
        return True
    return any(map(os.environ.get, ("DISPLAY", "WAYLAND_DISPLAY")))
