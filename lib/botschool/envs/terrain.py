"""The rough ground of BodyBrain (docs/specification.md, "Bodies"); lengths in metres."""

from __future__ import annotations

import numpy as np

TERRAIN_STEP = 14 / 30
TERRAIN_STEPS = 200
FLAT_STEPS = 40
TERRAIN_HEIGHT = 5.0
TERRAIN_END = TERRAIN_STEP * TERRAIN_STEPS
START_X = TERRAIN_STEP * FLAT_STEPS / 2


def terrain(rng: np.random.Generator) -> list[float]:
    """Heights of the ground every 14/30 m, 201 of them: flat first, then a random slope."""
    height, slope = TERRAIN_HEIGHT, 0.0
    heights = [height] * (FLAT_STEPS + 1)
    for bump in rng.uniform(-1, 1, TERRAIN_STEPS - FLAT_STEPS).tolist():
        back = (height < TERRAIN_HEIGHT) - (height > TERRAIN_HEIGHT)
        slope = 0.8 * slope + 0.01 * back + bump / 15
        height += slope
        heights.append(height)
    return heights
