"""Help commands that take long: requests to stop, progress bars, numbers to read."""

from __future__ import annotations

import math
import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial

SHOW_CURSOR = b"\x1b[?25h\n"
"""Shows the cursor again after an interrupted progress bar."""


SIGNALS = [
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
]


@contextmanager
def stoppable() -> Iterator[Callable[[], bool]]:
    """Yield a function that tells whether the user has asked to stop.

    Ctrl-C, SIGTERM or closing the terminal asks to stop. A second request ends the process at once,
    as a kill does: files are whole, --resume continues from the last ones, and worker processes
    end.
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
    """Raise SystemExit in the block on SIGTERM or a closed terminal, so that it can clean up.

    A second signal ends the process at once.
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
    """Hold back these signals during the block; deliver them to this process at its end.

    Processes that start within the block never get them.
    """
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
    """Yield a function that moves a progress bar.

    Its arguments are the share done, the steps so far, the number of decimals of millions of steps,
    and a text.
    """
    with progress_bars() as bars:
        yield partial(bars.show, seed)


class Bars:
    """Progress bars of several seeds, one for each seed that runs."""

    def __init__(self, progress) -> None:
        """Start without bars; progress: a rich Progress with the columns of `progress_bars`."""
        self._progress = progress
        self._tasks = {}

    def show(self, seed: int, share: float, steps: int, decimals: int, numbers: str) -> None:
        """Move a seed's bar; the other arguments are as in `progress_bar`."""
        if seed not in self._tasks:
            empty = {"steps": "", "numbers": ""}
            self._tasks[seed] = self._progress.add_task("", total=1.0, seed=seed, **empty)
        fields = {"steps": f"{steps / 1e6:.{decimals}f}M", "numbers": numbers}
        self._progress.update(self._tasks[seed], completed=min(share, 1.0), **fields)

    def finish(self, seed: int, text: str) -> None:
        """Replace a seed's bar by a text."""
        if seed in self._tasks:
            self._progress.remove_task(self._tasks.pop(seed))
        self._progress.print(text, markup=False, highlight=False, soft_wrap=True)


@contextmanager
def progress_bars() -> Iterator[Bars]:
    """Yield several progress bars, one below the other."""
    from rich.progress import (
        BarColumn,
        Progress,
        TaskProgressColumn,
        TextColumn,
        TimeRemainingColumn,
    )

    from botschool.console import Console

    columns = (
        TextColumn("seed {task.fields[seed]}"),
        BarColumn(bar_width=8),
        TaskProgressColumn(),
        TextColumn("{task.fields[steps]}"),
        TimeRemainingColumn(compact=True),
        TextColumn("{task.fields[numbers]}"),
    )
    with Progress(*columns, console=Console(), refresh_per_second=5) as progress:
        yield Bars(progress)


def readable(value: float) -> str:
    """Return a fitness with as many digits as its size needs: 2261.4, -66.31, 0.6500, 0.0001234.

    That is at least four significant digits and one decimal; below 10^-6 and from 10^7 on, a power
    of ten.
    """
    size = abs(value)
    if not math.isfinite(value) or size >= 1e7 or 0 < size < 1e-6:
        return f"{value:.3e}" if math.isfinite(value) else str(value)
    if size >= 1 or size == 0:
        return f"{value:.{1 if size >= 100 else 2}f}"
    return f"{value:.{3 - math.floor(math.log10(size))}f}"


def has_display() -> bool:
    """Return whether a window can probably open."""
    if os.environ.get("SDL_VIDEODRIVER") in ("dummy", "offscreen"):
        return False
    if sys.platform in ("win32", "darwin"):
        return True
    return any(map(os.environ.get, ("DISPLAY", "WAYLAND_DISPLAY")))
