"""Where the course lies."""

from __future__ import annotations

import os
from pathlib import Path

from botschool.errors import BotschoolError


def course_root() -> Path:
    """The folder that holds exercises/; looked for from the present folder upwards."""
    given = os.environ.get("BOTSCHOOL_COURSE")
    here = Path(given) if given else Path.cwd()
    for folder in (here, *here.resolve().parents):
        if (folder / "exercises").is_dir():
            return folder
    raise BotschoolError(
        "There is no course here: go to the folder that holds exercises/, or name it in "
        "BOTSCHOOL_COURSE."
    )
