"""Run a submission in this process, for breakpoints, never for points."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path
from typing import Any

from botschool.grading.declare.checks import Wrong
from botschool.grading.run.confined import scratch_copy
from botschool.grading.run.rewiring import Rewired


class DirectStudent:
    """Offer the methods of Student that checks use, and let exceptions through unchanged.

    The code comes from the student's own file, so that breakpoints work. The working folder and
    `__file__` are in a copy, so that nothing is left beside the student's file.
    """

    seconds_left = float("inf")
    said = "your file"
    pasted = ""

    def __init__(self, file: Path) -> None:
        """Load the file. Raises what loading raises, and Wrong if the file is too large."""
        file = file.resolve()
        self._scratch = scratch_copy(file)
        self._before = Path.cwd()
        os.chdir(self._scratch.folder)
        try:
            self._module = self._load(file)
        except BaseException:
            self.close()
            raise

    def _load(self, file: Path) -> Any:
        sys.dont_write_bytecode = True
        sys.path.append(str(file.parent))  # for the student's files beside it
        loader = SourceFileLoader("student", str(file))
        module = module_from_spec(spec_from_loader("student", loader))
        sys.modules["student"] = module
        module.__file__ = str(self._scratch.folder / file.name)
        exec(loader.get_code("student"), vars(module))
        return module

    def close(self) -> None:
        """Return to the former folder and remove the copy."""
        os.chdir(self._before)
        self._scratch.remove()

    def call(self, name: str, *arguments: Any, **options: Any) -> Any:
        """Call a function of the submission."""
        self.said = f"{name}(...)"
        return getattr(self._module, name)(*arguments, **options)

    def run(
        self,
        driver: Callable[..., Any],
        *arguments: Any,
        said: str | None = None,
        call: tuple[Any, ...] | None = None,
        robot: dict[str, Any] | None = None,
    ) -> Any:
        """Call a driver with the submission's module."""
        self.said = said or f"{driver.__name__}(...)"
        if robot is None:
            return driver(self._module, *arguments)
        self.rewired = Rewired(**robot)
        return driver(self._module, self.rewired.answer, *arguments)

    hung: frozenset[str] = frozenset()
    """As of Student; nothing ends a call here."""

    def within(self, seconds: float, what: object) -> AbstractContextManager[None]:
        """Limit nothing, unlike Student."""
        return nullcontext()

    def stop(self) -> None:
        """Go on in this process, unlike Student."""

    def scratch(self, name: str) -> Path:
        """Return a file that the submission has written."""
        try:
            return self._scratch.copy(name)
        except OSError:
            raise Wrong(f"{self.said} should have written the file {name}, but has not.") from None
