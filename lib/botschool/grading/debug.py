"""A submission in this very process: for breakpoints, never for points."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from botschool.grading.child import load


class DirectStudent:
    """Has the methods of Student that checks use; exceptions come through as they are."""

    seconds_left = float("inf")

    def __init__(self, file: Path) -> None:
        file = file.resolve()
        self._folder = file.parent
        os.chdir(self._folder)  # as in the child
        self._module = load(file)
        self.said = "your file"

    def call(self, name: str, *arguments: Any, **options: Any) -> Any:
        """Calls a function of the submission."""
        self.said = f"{name}(...)"
        return getattr(self._module, name)(*arguments, **options)

    def run(self, driver: Callable[..., Any], *arguments: Any, said: str | None = None) -> Any:
        """Calls a driver with the submission's module."""
        self.said = said or f"{driver.__name__}(...)"
        return driver(self._module, *arguments)

    def scratch(self, name: str) -> Path:
        """A file that the submission has written."""
        return self._folder / name
