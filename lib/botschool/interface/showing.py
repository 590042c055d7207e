"""Progress bars in terminals and notebooks, and Ctrl-C, for programs."""

from __future__ import annotations

import signal
import sys
import tempfile
import threading
import weakref
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from html import escape
from os import PathLike
from pathlib import Path
from shutil import rmtree
from typing import Any

from botschool.terminal import progress_bars


class Folder:
    """The folder of results; without a name it is a temporary one, removed with its last user."""

    def __init__(self, folder: str | PathLike[str] | None) -> None:
        self.path = (
            Path(folder) if folder is not None else Path(tempfile.mkdtemp(prefix="botschool-"))
        )
        self.owner = None if folder is not None else self
        if folder is None:
            weakref.finalize(self, rmtree, self.path, ignore_errors=True)


@contextmanager
def interruptible() -> Iterator[Callable[[], bool]]:
    """Yield a function that tells whether the user pressed Ctrl-C; a second one interrupts at once.

    In other threads than the main one, which get no signals, it tells nothing.
    """
    if threading.current_thread() is not threading.main_thread():
        yield lambda: False
        return
    asked = False

    def stop(number: int, frame: object) -> None:
        nonlocal asked
        if asked:
            raise KeyboardInterrupt
        asked = True

    before = signal.signal(signal.SIGINT, stop)
    try:
        yield lambda: asked
    finally:
        signal.signal(signal.SIGINT, before or signal.SIG_DFL)


@contextmanager
def bars(progress: bool | None) -> Iterator[Any]:
    """Yield progress bars with a method `show`, or None; None: bars if somebody can see them."""
    notebook = _in_notebook()
    if progress is None:
        progress = notebook or sys.stdout.isatty()
    if not progress:
        yield None
    elif notebook:
        yield NotebookBars()
    else:
        with progress_bars() as shown:
            yield shown


def _in_notebook() -> bool:
    if "IPython" not in sys.modules:
        return False
    shell = sys.modules["IPython"].get_ipython()
    return shell is not None and hasattr(shell, "kernel")


class NotebookBars:
    """A bar for each seed below a notebook's cell."""

    def __init__(self) -> None:
        from IPython.display import HTML, display

        self._html, self._rows = HTML, {}
        self._place = display(HTML(""), display_id=True)

    def show(self, seed: int, share: float, steps: int, decimals: int, numbers: str) -> None:
        """Move a seed's bar; the arguments are as in botschool.terminal."""
        text = f"seed {seed}  {100 * min(share, 1):.0f} %  {steps / 1e6:.{decimals}f}M  {numbers}"
        bar = f"<progress value='{share:.3f}'></progress>"
        self._rows[seed] = f"<div style='font-family: monospace'>{bar} {escape(text)}</div>"
        self._place.update(self._html("".join(self._rows.copy().values())))
