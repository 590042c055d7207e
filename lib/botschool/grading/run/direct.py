"""Run a submission in this process: for breakpoints, and for texts of our own; never for points.

Nothing is confined, limited or refused here, and no process starts: it takes a tenth of the time.
"""

from __future__ import annotations

import importlib.util
import os
import sys
import types
from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from pathlib import Path
from typing import Any

from botschool.grading.declare.checks import NotDone, Wrong
from botschool.grading.run.confined import scratch_copy
from botschool.grading.run.rewiring import Rewired
from botschool.sandbox.child import substitute
from botschool.sandbox.protocol import NotPlain, pack, unpack


class Direct:
    """Offer the methods of Student that checks use.

    The code has the name of the student's own file, so that breakpoints work. The working folder
    and `__file__` are in a copy, so that nothing is left beside it.
    """

    seconds_left = 3600.0
    said = "your file"
    pasted = ""
    changed = ""
    """A sentence on the first call that changed an argument."""
    hung: frozenset[str] = frozenset()
    """As of Student; nothing ends a call here."""

    def __init__(
        self, file: Path, references: dict[str, Any] | None = None, through: bool = False
    ) -> None:
        """Load the file. Raises what loading raises, and Wrong if the file is too large.

        references: as of Student. through: whether exceptions pass unchanged, for a debugger.
        """
        file = file.resolve()
        self._scratch = scratch_copy(file)
        self._before, self._file = Path.cwd(), file
        self._references, self._through = references, through
        os.chdir(self._scratch.folder)
        try:
            text = importlib.util.decode_source(file.read_bytes())
            self._code = compile(text, str(file), "exec")
            sys.dont_write_bytecode = True
            sys.path.append(str(file.parent))  # for the student's files beside it
            self.stop()
        except BaseException:
            self.close()
            raise

    def stop(self) -> None:
        """Load the file anew, as a new process would."""
        self._module = types.ModuleType("student")
        sys.modules["student"] = self._module
        self._module.__file__ = str(self._scratch.folder / self._file.name)
        exec(self._code, vars(self._module))
        if self._references:
            substitute(self._module, self._references)

    def close(self) -> None:
        """Return to the former folder and remove the copy."""
        os.chdir(self._before)
        if str(self._file.parent) in sys.path:
            sys.path.remove(str(self._file.parent))
        self._scratch.remove()

    def call(self, name: str, *arguments: Any, **options: Any) -> Any:
        """Call a function of the submission. Raises Wrong, or what it raises."""
        self.said, before = f"{name}(...)", pack([[*arguments], options])
        given, named = unpack(before)
        answer = self._answered(lambda: getattr(self._module, name)(*given, **named))
        if not self.changed and pack([given, named]) != before:
            self.changed = f"{self.said} changed an argument in place."
        return answer

    def run(
        self,
        driver: Callable[..., Any],
        *arguments: Any,
        said: str | None = None,
        call: tuple[Any, ...] | None = None,
        robot: dict[str, Any] | None = None,
    ) -> Any:
        """Call a driver with the submission's module. Raises Wrong, or what it raises."""
        self.said = said or f"{driver.__name__}(...)"
        given = unpack(pack([*arguments]))
        if robot is not None:
            self.rewired = Rewired(**robot)
            given = [self.rewired.answer, *given]
        return self._answered(lambda: driver(self._module, *given))

    def _answered(self, call: Callable[[], Any]) -> Any:
        """Return an answer as plain data."""
        if self._through:
            return unpack(pack(call()))
        try:
            return unpack(pack(call()))
        except NotImplementedError as error:
            raise NotDone(str(error)) from None
        except (Exception, NotPlain) as error:
            raise Wrong(f"{self.said} raised {type(error).__name__}: {error}") from None

    def within(self, seconds: float, what: object) -> AbstractContextManager[None]:
        """Limit nothing, unlike Student."""
        return nullcontext()

    def scratch(self, name: str) -> Path:
        """Return a file that the submission has written."""
        try:
            return self._scratch.copy(name)
        except OSError:
            raise Wrong(f"{self.said} should have written the file {name}, but has not.") from None
