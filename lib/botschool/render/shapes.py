"""Define the shapes of pictures in world coordinates, moved by a few numbers per step.

A scene (scene.py, scenes/arenas.py) describes its picture once, as shapes. The film's frames
(`canvas.Painter`) and the replay's page (replay.js) draw the same shapes from the same numbers.
World coordinates have y upwards; angles are radians, counter-clockwise.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields
from math import cos, sin

import numpy as np

Colour = tuple[int, int, int]
Point = tuple[float, float]

AXLE = (129, 132, 203)
POLE = (202, 152, 101)
SHORT_POLE = (86, 158, 140)
FORCE = (204, 77, 77)

PALETTE: dict[str, tuple[Colour, Colour]] = {
    "paper": ((255, 255, 255), (22, 27, 34)),
    "white": ((255, 255, 255), (244, 247, 250)),
    "ink": ((0, 0, 0), (226, 230, 236)),
    "muted": ((128, 128, 128), (139, 148, 160)),
    "axle": (AXLE, AXLE),
    "pole": (POLE, POLE),
    "short pole": (SHORT_POLE, SHORT_POLE),
    "force": (FORCE, (235, 106, 106)),
    "ground": ((222, 214, 198), (52, 48, 42)),
    "goal": ((0, 140, 105), (34, 190, 148)),
    "floor": ((247, 246, 242), (30, 36, 45)),
    "shade": ((196, 190, 176), (70, 82, 98)),
    "wall": ((62, 68, 78), (150, 160, 174)),
    "wheel": ((40, 44, 52), (8, 10, 13)),
    "blue": ((0, 114, 178), (66, 160, 222)),
    "orange": ((213, 94, 0), (240, 132, 48)),
    "object": ((120, 94, 160), (168, 142, 214)),
    "infrared": ((230, 60, 60), (255, 92, 80)),
    "camera": ((0, 150, 120), (52, 211, 170)),
    "light": ((238, 178, 17), (255, 205, 70)),
}
"""Name -> colour on white (films) and on a dark page."""


@dataclass(frozen=True)
class Shape:
    """One shape in a picture: its position, and the numbers that move it."""

    kind: str
    """polygon (corners), line (vertices), disc (its centre), text (its middle), trail (none)."""
    points: tuple[Point, ...]
    colour: str
    """A name in PALETTE."""
    radius: float = 0.0
    """Radius of a disc; half the width of a line or trail."""
    opacity: float = 1.0
    text: str = ""
    at: Point = (0.0, 0.0)
    """Offset of the points after scaling and before posing."""
    pose: int | None = None
    """Index of the first of three numbers (x, y, angle) that move the shape."""
    size: int | None = None
    """Index of a number that scales the points; a negative one mirrors x."""
    height: int | None = None
    """Index of a number that scales y in place of `size`."""
    level: int | None = None
    """Index of a number, 0 to 1, that multiplies the opacity."""
    steps: int = 0
    """Length of a fading trail in steps."""

    @property
    def moves(self) -> bool:
        """Return whether the numbers change the shape."""
        return (self.pose, self.size, self.level) != (None, None, None)

    def placed(self, numbers: np.ndarray) -> np.ndarray:
        """Return the points in the world, (points, 2)."""
        size = 1.0 if self.size is None else numbers[self.size]
        height = abs(size) if self.height is None else numbers[self.height]
        points = np.array(self.points) * (size, height) + self.at
        if self.pose is None:
            return points
        x, y, angle = numbers[self.pose : self.pose + 3]
        turned = [[cos(angle), sin(angle)], [-sin(angle), cos(angle)]]
        return points @ turned + (x, y)

    def visible(self, numbers: np.ndarray) -> float:
        """Return the opacity, 0 to 1."""
        level = 1.0 if self.level is None else float(np.clip(numbers[self.level], 0.0, 1.0))
        return self.opacity * level

    def as_dict(self) -> dict:
        """Return the attributes that differ from the defaults, rounded to 1e-4, for JSON."""
        shape = {field.name: field.default for field in fields(self)}
        kept = {name: value for name, value in asdict(self).items() if value != shape[name]}
        kept["points"] = [[round(float(x), 4), round(float(y), 4)] for x, y in self.points]
        return kept


def rectangle(left: float, bottom: float, right: float, top: float) -> tuple[Point, ...]:
    """Return the corners of a rectangle."""
    return ((left, bottom), (right, bottom), (right, top), (left, top))


def arc(start: float, end: float, radius: float, parts: int = 8) -> tuple[Point, ...]:
    """Return points on a circle around the origin, from one angle to another."""
    return tuple((radius * cos(a), radius * sin(a)) for a in np.linspace(start, end, parts + 1))


def ring(start: float, end: float, inner: float, outer: float) -> tuple[Point, ...]:
    """Return the corners of a piece of a ring."""
    return arc(start, end, outer) + arc(end, start, inner)


def arrow(length: float, width: float) -> tuple[Point, ...]:
    """Return the corners of an arrow from the origin along +x."""
    neck, half, shaft = 0.72 * length, width / 2, width / 6
    upper = ((0.0, shaft), (neck, shaft), (neck, half))
    return (*upper, (length, 0.0), *((x, -y) for x, y in reversed(upper)))


def bent_arrow(radius: float, width: float) -> tuple[Point, ...]:
    """Return the corners of a quarter-circle arrow above the origin, counter-clockwise."""
    start, neck, tip, half = 0.8, 2.1, 2.55, width / 6
    outer, inner = arc(start, neck, radius + half), arc(neck, start, radius - half)
    head = arc(neck, neck, radius + width / 2, 1)[:1] + arc(tip, tip, radius, 1)[:1]
    return outer + head + arc(neck, neck, radius - width / 2, 1)[:1] + inner
