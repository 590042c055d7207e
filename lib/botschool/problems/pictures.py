"""Read the pictures that an environment draws, in the forms in which environments give them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from botschool.errors import BotschoolError, Option
from botschool.inifile import shown
from botschool.problems.base import say

USUAL_FPS = 30.0
CHANNELS = (1, 3, 4)
"""Grey; red, green, blue; the same with opacity, which is left out."""


def picture(given: Any, name: str) -> np.ndarray:
    """Return a picture (height, width, 3) of uint8 of what `render` gave: also grey, with opacity,
    as floats from 0 to 1 or to 255, and with channels first. Raises BotschoolError.
    """
    frame = np.asarray(given)
    if frame.ndim == 2:
        frame = frame[:, :, None]
    if frame.ndim == 3 and frame.shape[2] not in CHANNELS and frame.shape[0] in CHANNELS:
        frame = frame.transpose(1, 2, 0)
    if frame.dtype.kind not in "fiub" or frame.ndim != 3 or frame.shape[2] not in CHANNELS:
        what = f"an array of shape {np.shape(given)}" if np.ndim(given) else shown(given)
        raise BotschoolError(
            f"{name} draws no pictures: its render gave {what} ({type(given).__name__}), but a "
            "picture is an array (height, width, 3) of uint8",
            Option(": leave out films, and add --render none", ""),
            ".",
        )
    if frame.dtype != np.uint8:
        frame = np.nan_to_num(frame.astype(np.float64))
        white = frame.size and np.asarray(given).dtype.kind in "fb" and frame.max() <= 1
        frame = np.clip(frame * (255 if white else 1), 0, 255).astype(np.uint8)
    return frame[:, :, :3].repeat(1 if frame.shape[2] >= 3 else 3, axis=2)


def rate(metadata: dict[str, Any], name: str) -> float:
    """Return the pictures of a second; a note says so if `render_fps` is no number above 0."""
    given = metadata.get("render_fps") or USUAL_FPS
    try:
        if not isinstance(given, str) and 0 < float(given) < math.inf:
            return float(given)
    except (TypeError, ValueError):
        pass
    say(
        f"the render_fps of {name} is {shown(repr(given))}, which is no number above 0: its films "
        f"have {USUAL_FPS:g} pictures a second."
    )
    return USUAL_FPS
