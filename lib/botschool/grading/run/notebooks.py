"""Read the code of a saved notebook."""

from __future__ import annotations

import json
import re
from pathlib import Path

from botschool.errors import BotschoolError

_BINDS = re.compile(
    r"^[ \t]*(?:async[ \t]+def|def|class)[ \t]+(\w+)|^([A-Z_][A-Z_0-9]*) *=|^((?:import|from) .*)",
    re.MULTILINE,
)
"""A function, a constant or an import: what a cell may bind if it is code."""


def code_cells(path: Path) -> list[str]:
    """Return the texts of a notebook's code cells. Raises BotschoolError."""
    return [text for kind, text in _cells(path) if kind == "code"]


def names_in_other_cells(path: Path, text: str) -> dict[str, str]:
    """Return the names that cells without code would bind, and why they are not read.

    path: a notebook, or a script with this text. Raises BotschoolError.
    """
    found = {}
    for kind, cell in _cells(path) if path.suffix == ".ipynb" else _commented_cells(text):
        if kind != "code":
            word = "Markdown" if kind == "markdown" else "raw"
            where = f"it stands in a {word} cell: make it a code cell again (in Jupyter: Esc, Y)"
            names = re.findall(r"\w+", " ".join(map(" ".join, _BINDS.findall(cell))))
            found |= dict.fromkeys(names, where)
    return found


def _commented_cells(text: str) -> list[tuple[str, str]]:
    """Return the kinds and texts of a script's cells that were cells of a notebook without code."""
    return [
        (kind, re.sub(r"^# ?", "", body, flags=re.MULTILINE))
        for part in re.split(r"^# %%", text, flags=re.MULTILINE)[1:]
        for kind, body in re.findall(r"\A[^\n]*\[(markdown|raw)\][^\n]*\n(.*)", part, re.DOTALL)
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
