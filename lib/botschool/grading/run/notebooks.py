"""Read the code of a saved notebook."""

from __future__ import annotations

import json
from pathlib import Path

from botschool.errors import BotschoolError


def code_cells(path: Path) -> list[str]:
    """Return the texts of a notebook's code cells. Raises BotschoolError."""
    return [text for kind, text in _cells(path) if kind == "code"]


def other_cells(path: Path) -> list[tuple[str, str]]:
    """Return (kind, text) of a notebook's cells that are no code. Raises BotschoolError."""
    return [
        ("Markdown" if kind == "markdown" else "raw", text)
        for kind, text in _cells(path)
        if kind != "code"
    ]


def _cells(path: Path) -> list[tuple[str, str]]:
    try:
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        return [(cell["cell_type"], "".join(cell["source"])) for cell in cells]
    except (OSError, ValueError, LookupError, TypeError, RecursionError):
        raise BotschoolError(
            f"There is no {path.name} in the folder {path.parent}: save the notebook there under "
            "this name, then run this cell again."
        ) from None
