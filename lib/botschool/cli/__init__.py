"""Define the command line: `botschool` runs `main`."""

from __future__ import annotations

import os
import signal


def main() -> None:
    """Run the command; Ctrl-C ends it with one sentence at any time."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _stop)
    if hasattr(signal, "pthread_sigmask"):  # lib/launcher has held Ctrl-C back
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    from botschool.cli.app import run

    run()


def _stop(number: int, frame: object) -> None:
    """End the process during its imports."""
    os.write(2, b"Stopped before anything was done.\n")
    os._exit(130)
