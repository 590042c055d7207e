"""Print tables, colours and progress bars by Rich, and let no text in them steer the terminal."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import rich.console
from rich.segment import Segment

from botschool.screen import plain


class Console(rich.console.Console):
    """Rich's console; only its own styles and movements of the cursor steer the terminal."""

    @property
    def file(self) -> Any:
        """Return the stream that lets styles through, also while a bar has replaced stdout."""
        stream = super().file
        return getattr(stream, "rich_proxied_file", stream)

    @file.setter
    def file(self, stream: Any) -> None:
        self._file = stream

    def render(self, renderable: Any, options: Any = None) -> Iterable[Segment]:
        """Yield the segments of something to print, their texts made plain."""
        for segment in super().render(renderable, options):
            text, style, control = segment
            yield segment if control or text.isprintable() else Segment(plain(text), style)
