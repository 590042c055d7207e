"""Let a grader import `slips.py` beside it, which computes what slips make of answers."""

from __future__ import annotations

import sys
import threading
import types
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

SLIPS = "slips.py"
_ONE_AT_A_TIME = threading.RLock()
"""Held while a grader is imported: graders share the name `slips`, and threads load several."""


def slips_beside(folder: Path) -> str:
    """Return the text of an exercise's slips.py; "" if there is none."""
    path = folder / SLIPS
    return path.read_text(encoding="utf-8") if path.is_file() else ""


@contextmanager
def importable(folder: Path, text: str) -> Iterator[None]:
    """Let `from slips import ...` find this text, of a file in the folder, until the block ends."""
    with _ONE_AT_A_TIME:
        before = sys.modules.pop("slips", None)
        try:
            if text:
                module = types.ModuleType("slips")
                module.__file__ = str(folder / SLIPS)
                sys.modules["slips"] = module
                exec(compile(text, module.__file__, "exec", dont_inherit=True), vars(module))
            yield
        finally:
            sys.modules.pop("slips", None)
            if before is not None:
                sys.modules["slips"] = before
