"""The command line; `main` is what `botschool` runs."""

from botschool.cli.app import main

__all__ = ["main"]
