"""Keep what the texts of a copy link to, and the links to what it has."""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path

_LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)#\s:]+)(#[^)\s]*)?\)")


def leave_out_what_no_text_shows(made: Path) -> None:
    """Remove replays without a link and pictures without a text, and links to missing files.

    A link to a file that the copy lacks becomes plain text.
    """
    texts = {path: path.read_text(encoding="utf-8") for path in made.rglob("*.md")}
    kept = {
        (path.parent / link[3]).resolve()
        for path, text in texts.items()
        for link in _LINK.finditer(text)
        if link[1] or made / "exercises" in path.parents
    }
    for top in ("replays", "images"):
        for path in sorted((made / "docs" / top).rglob("*")):
            if path.is_file() and path.resolve() not in kept:
                path.unlink()
    for path, text in texts.items():
        there = partial(_if_there, folder=path.parent)
        path.write_text(_LINK.sub(there, text), encoding="utf-8", newline="\n")


def _if_there(link: re.Match, folder: Path) -> str:
    """Return a link unchanged, or only its text if the file does not exist."""
    return link[0] if (folder / link[3]).exists() else link[2]
