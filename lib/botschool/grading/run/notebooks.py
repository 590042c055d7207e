"""Read the code of a saved notebook."""

from __future__ import annotations

import json
from pathlib import Path

from botschool.errors import BotschoolError


def code_cells(path: Path) -> list[str]:
    """Return the texts of a notebook's code cells. Raises BotschoolError."""
    try:
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        code = [cell["source"] for cell in cells if cell["cell_type"] == "code"]
        return ["".join(source) for source in code]
    except (OSError, ValueError, LookupError, TypeError, RecursionError):
        raise BotschoolError(
            f"There is no {path.name} in the folder {path.parent}: save the notebook there under "
            "this name, then run this cell again."
        ) from None
