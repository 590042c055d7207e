"""What measure.py of this laboratory should give; a released copy has it packed."""

from __future__ import annotations

from typing import Any

import numpy as np

from botschool.labs.declare import Answers
from botschool.labs.measuring import CYLINDER, forage


def described(episode: dict[str, np.ndarray]) -> tuple[float, float, float, float]:
    """Steps of the search, speed and turning in it, and the side of the cylinder afterwards."""
    poses, near = episode["poses"], episode["rewards"] > 0
    search = int(near.argmax()) if near.any() else len(near)
    before, after = poses[:-1], poses[1:]
    moved = after[:, :2] - before[:, :2]
    forward = moved[:, 0] * np.cos(before[:, 2]) + moved[:, 1] * np.sin(before[:, 2])
    turned = (after[:, 2] - before[:, 2] + np.pi) % (2 * np.pi) - np.pi
    away = np.asarray(CYLINDER) - after[:, :2]
    sides = np.sin(np.arctan2(away[:, 1], away[:, 0]) - after[:, 2])[near]
    told = [values.mean() if len(values) else 0.0 for values in (forward[:search], turned[:search])]
    return search, float(told[0]), float(told[1]), float(sides.mean()) if len(sides) else 0.0


def reference(run: dict[str, Any], answers: Answers) -> dict[str, float]:
    """Return, the share of it that is lost without memory, and four descriptors."""
    ordinary, forgetful = forage(run), forage(run, forget=True)
    earned = float(np.mean([each["rewards"].sum() for each in ordinary]))
    without = float(np.mean([each["rewards"].sum() for each in forgetful]))
    rows = np.mean([described(each) for each in ordinary], axis=0)
    return {
        "return": earned,
        "lost": 1 - without / earned if earned > 0 else 0.0,
        **dict(zip(("search", "speed", "turning", "side"), map(float, rows), strict=True)),
    }
