"""Make plain what others wrote: no text that is printed steers the terminal."""

from __future__ import annotations

import re
import sys
import unicodedata
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

KEPT = "\n\t\u200c\u200d"
"""Characters that Python does not call printable and that texts need; the last two join letters."""
_COLOUR = re.compile("\x1b\\[[0-9;]*m")
_RICH = re.compile("(\x1b\\[[0-9;?]*[A-HJKhlm]|\x1b]8;[^\x1b\x07]*\x1b\\\\|\r)")
"""What Rich writes for colours, links and movements of the cursor."""


def plain(text: str) -> str:
    """Return a text with U+FFFD for what steers a terminal or turns the direction of reading."""
    return text if text.isprintable() else "".join(map(_shown, text))


def _shown(c: str) -> str:
    shows = c.isprintable() or c in KEPT or unicodedata.category(c) in ("Zs", "Cs", "Co", "Cn")
    return c if shows else "\ufffd"


class Guarded:
    """A text stream of the terminal that makes plain whatever is printed.

    So no command has to think of it. Only Rich writes to the terminal what steers it; the texts in
    it are made plain by `botschool.console`.
    """

    def __init__(self, stream: Any, rich: bool = False) -> None:
        """rich: let through what Rich writes."""
        self._stream, self._rich = stream, rich

    def write(self, text: str) -> int:
        """Write a text, made plain; leave out colours."""
        if self._rich:
            pieces = _RICH.split(text)
            pieces[::2] = map(plain, pieces[::2])
            self._stream.write("".join(pieces))
        else:
            self._stream.write(plain(_COLOUR.sub("", text)))
        return len(text)

    def writelines(self, lines: Any) -> None:
        """Write several texts."""
        for line in lines:
            self.write(line)

    @property
    def rich_proxied_file(self) -> Guarded:
        """Return the stream that a console of Rich uses in place of this one."""
        return Guarded(self._stream, rich=True)

    def __getattr__(self, name: str) -> Any:
        """Return whatever else the stream has."""
        return getattr(self._stream, name)


@contextmanager
def guarded_terminal() -> Iterator[None]:
    """Let nothing that is printed in the block steer the terminal."""
    before = sys.stdout, sys.stderr
    sys.stdout, sys.stderr = map(Guarded, before)
    try:
        yield
    finally:
        sys.stdout, sys.stderr = before
