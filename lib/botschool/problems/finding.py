"""Find robots of one's own: their files, or the tables that a run has kept."""

from __future__ import annotations

import base64
import sys
from functools import cache
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path

from botschool.paths import own_file
from botschool.problems.compiled import read
from botschool.problems.robot import DATA, Robot, load

_places: list[Path] = []
"""Folders in which robots are looked for, too."""


def look_in(*places: Path) -> None:
    """Look for robots in these folders, too: for their files, and for the tables of a run."""
    _places[:] = places


def find(name: str, reach: float) -> Robot:
    """Return the robot of an MJCF or URDF file, or of tables that were saved; see `compiled.read`.

    If the file or MuJoCo is missing, the tables of the run in hand serve. Raises BotschoolError.
    """
    if name.startswith(DATA):
        return load(BytesIO(base64.b64decode(name.removeprefix(DATA))))
    tried = [Path(name), *(place / name for place in _places)]
    path = next(filter(Path.is_file, tried), None) or own_file(name, "robots")
    if path.suffix == ".npz":
        return load(path)
    if not path.is_file() or not find_spec("mujoco"):
        for saved in (file for place in _places for file in sorted(place.glob("robotS*.npz"))):
            return load(saved)
    return read(path, reach)


@cache
def say(sentence: str) -> None:
    """Print a note on stderr, once."""
    print(f"note: {sentence}", file=sys.stderr)
