"""The command line; `main` is what `botschool` runs."""

from __future__ import annotations

import os
import signal


def main() -> None:
    """Run the command. Ctrl-C ends it with a sentence from its first moment to its last."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _stop)
    from botschool.cli.app import run

    run()


def _stop(number: int, frame: object) -> None:
    """End the process while its modules are being imported."""
    os.write(2, b"Stopped before anything was done.\n")
    os._exit(130)
