"""Decode the 64 parameters of a BodyBrain robot's body (docs/specification.md, "Bodies").

They are, in this order: length and thickness of each of the 11 segments; two limits for each of the
10 joints; default angle of each segment; density of each segment.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

SEGMENTS = 11
JOINTS = SEGMENTS - 1
MORPHOLOGY_SIZE = 2 * SEGMENTS + 2 * JOINTS + 2 * SEGMENTS

LENGTH, THICKNESS, DENSITY = 0.8, 0.2, 5.0
"""Values of a segment whose parameters are 0: metres, metres, kg / m^2."""
SIZE_RANGE = 0.9
DENSITY_RANGE = 0.8
LIMIT_RANGE = np.pi / 2
ANGLE_RANGE = 3 * np.pi / 4


@dataclass(frozen=True)
class Morphology:
    """A chain of segments, the torso first."""

    lengths: np.ndarray
    """Metres, shape (11,)."""
    thicknesses: np.ndarray
    """Metres, shape (11,)."""
    limits: np.ndarray
    """Radians around the default angle, shape (10, 2): lower and upper limit of each joint."""
    angles: np.ndarray
    """Radians, shape (11,): angle of the torso, then of each segment relative to the one before."""
    densities: np.ndarray
    """kg / m^2, shape (11,)."""

    def pose(self) -> tuple[np.ndarray, np.ndarray]:
        """Return centres, shape (11, 2), and absolute angles, shape (11,), with the torso's rear at
        (0, 0) and every joint at its default angle.
        """
        headings = np.cumsum(self.angles)
        along = self.lengths[:, None] * np.stack([np.cos(headings), np.sin(headings)], axis=1)
        ends = np.cumsum(along, axis=0)
        return ends - along / 2, headings

    def corners(self) -> np.ndarray:
        """Return the corners of the segments in that pose, shape (11, 4, 2)."""
        centres, headings = self.pose()
        signs = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) / 2
        boxes = signs * np.stack([self.lengths, self.thicknesses], axis=1)[:, None]
        cos, sin = np.cos(headings), np.sin(headings)
        rotations = np.stack([np.stack([cos, sin], 1), np.stack([-sin, cos], 1)], axis=1)
        return centres[:, None] + boxes @ rotations


def decode(parameters: np.ndarray) -> Morphology:
    """Return the body of 64 parameters; all 0 is a straight one. Raises ValueError."""
    p = np.asarray(parameters, dtype=np.float64)
    if p.shape != (MORPHOLOGY_SIZE,) or not np.all(np.isfinite(p)):
        raise ValueError(f"a morphology is {MORPHOLOGY_SIZE} finite numbers, not shape {p.shape}.")
    sizes, limits, angles, densities = np.split(p, np.cumsum([2 * SEGMENTS, 2 * JOINTS, SEGMENTS]))
    scales = 1 + SIZE_RANGE * np.tanh(sizes.reshape(SEGMENTS, 2))
    return Morphology(
        lengths=LENGTH * scales[:, 0],
        thicknesses=THICKNESS * scales[:, 1],
        limits=np.sort(LIMIT_RANGE * np.clip(limits.reshape(JOINTS, 2), -1, 1), axis=1),
        angles=ANGLE_RANGE * np.clip(angles, -1, 1),
        densities=DENSITY + DENSITY_RANGE * np.tanh(densities),
    )


# --- The rough ground of BodyBrain (docs/specification.md, "Bodies"); lengths in metres.


TERRAIN_STEP = 14 / 30
TERRAIN_STEPS = 200
FLAT_STEPS = 40
TERRAIN_HEIGHT = 5.0
TERRAIN_END = TERRAIN_STEP * TERRAIN_STEPS
START_X = TERRAIN_STEP * FLAT_STEPS / 2


def terrain(rng: np.random.Generator) -> list[float]:
    """Return heights of the ground every 14/30 m, 201 of them: flat first, then a random slope."""
    height, slope = TERRAIN_HEIGHT, 0.0
    heights = [height] * (FLAT_STEPS + 1)
    for bump in rng.uniform(-1, 1, TERRAIN_STEPS - FLAT_STEPS).tolist():
        back = (height < TERRAIN_HEIGHT) - (height > TERRAIN_HEIGHT)
        slope = 0.8 * slope + 0.01 * back + bump / 15
        height += slope
        heights.append(height)
    return heights
