"""Define the objects of a declared arena (botschool.arenas.plan), and their texts in files.

Lengths are in mm, angles in degrees, counter-clockwise from the x axis. A position or a heading is
a number, a range (low, high) from which every episode draws, or None: anywhere.
"""

from __future__ import annotations

import re
from dataclasses import MISSING, Field, dataclass, field, fields, replace
from typing import Any

import numpy as np

from botschool.arenas.robots import RobotModel, find
from botschool.errors import BotschoolError
from botschool.inifile import nearest, shown

LONGEST = 100_000.0
"""Largest side and length, mm."""

Range = float | tuple[float, float] | None
NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?"


@dataclass(frozen=True)
class Thing:
    """An object that a line of [ARENA] puts into the arena."""

    @classmethod
    def read(cls, text: str) -> Any:
        """Return the object of a text such as `x 100 to 300, y 50`. Raises ValueError or
        BotschoolError.
        """
        known = {f.name: f for f in fields(cls)}
        values: dict[str, Any] = {}
        for place, part in enumerate(str(text).split(",")):
            words = part.split()
            if not words and place == 0 and "," not in str(text):
                continue
            if "kind" in known and place == 0 and len(words) == 1:
                values["kind"] = words[0]
                continue
            name = words[0].lower() if words else ""
            if name not in known or name == "kind":
                own = [n for n in known if n != "kind"]
                raise ValueError(f"{shown(part.strip())} is unknown here: {nearest(name, own)}")
            if name in values:
                raise ValueError(f"{name} is given twice")
            values[name] = _range(name, " ".join(words[1:]), str(known[name].type))
        missing = [n for n, f in known.items() if f.default is MISSING and n not in values]
        if missing:
            raise ValueError(f"{missing[0]} is missing: write {missing[0]} 100")
        return cls(**values)

    def text(self) -> str:
        """Return the text from which `read` makes the same object."""
        parts = []
        for f in fields(self):
            value = getattr(self, f.name)
            if f.name == "kind":
                parts.append(value)
            elif isinstance(value, tuple):
                parts.append(f"{f.name} {value[0]:.17g} to {value[1]:.17g}")
            elif value is not None:
                parts.append(f"{f.name} {value:.17g}")
        return ", ".join(parts)

    def __post_init__(self) -> None:
        for f in fields(self):
            value = getattr(self, f.name)
            if f.name == "kind":
                object.__setattr__(self, "kind", find(str(value)).name)
            elif value is not None or "Range" not in f.type:
                object.__setattr__(self, f.name, _checked(f, value))


def _checked(f: Field, value: Any) -> Range:
    """Return the value of an object's field, a float or a range of two. Raises BotschoolError."""
    ranged = "Range" in f.type and isinstance(value, (tuple, list)) and len(value) == 2
    numbers = tuple(value) if ranged else (value,)
    if not all(is_number(number) for number in numbers):
        raise BotschoolError(f"{f.name} = {shown(value)} is not a number from -100000 to 100000.")
    low, high = float(numbers[0]), float(numbers[-1])
    if low > high:
        raise BotschoolError(f"{f.name} {low:g} to {high:g} goes from high to low.")
    limits = f.metadata
    if "above" in limits and low <= limits["above"]:
        raise BotschoolError(f"{f.name} must be above {limits['above']:g}, but is {low:g}.")
    if "high" in limits and not limits["low"] <= low <= limits["high"]:
        raise BotschoolError(
            f"{f.name} must be {limits['low']:g} to {limits['high']:g}, but is {low:g}."
        )
    return low if low == high else (low, high)


@dataclass(frozen=True)
class Robot(Thing):
    """A wheeled robot (botschool.arenas.robots)."""

    kind: str = "Khepera"
    x: Range = None
    y: Range = None
    heading: Range = None
    speed: float = field(default=0.0, metadata={"low": 0, "high": LONGEST})
    """Speed of a wheel at an action of 1, in mm/s; 0 means the kind's own."""

    @property
    def model(self) -> RobotModel:
        """Return the robot's model."""
        model = find(self.kind)
        return replace(model, speed=self.speed) if self.speed else model

    @property
    def radius(self) -> float:
        return self.model.radius


@dataclass(frozen=True)
class Wall(Thing):
    """A wall inside the arena, from (x, y) to (x2, y2)."""

    x: float
    y: float
    x2: float
    y2: float


@dataclass(frozen=True)
class Cylinder(Thing):
    x: Range = None
    y: Range = None
    radius: float = field(default=12.5, metadata={"above": 0})


@dataclass(frozen=True)
class Light(Thing):
    """A light above the floor, which robots cannot hit."""

    x: Range = None
    y: Range = None
    radius = 0.0


@dataclass(frozen=True)
class Zone(Thing):
    """A disc on the floor."""

    x: Range = None
    y: Range = None
    radius: float = field(default=100.0, metadata={"above": 0})
    shade: float = field(default=1.0, metadata={"low": 0, "high": 1})
    """Reading of a ground sensor above it; the floor reads 0."""


KINDS = {"robot": Robot, "wall": Wall, "cylinder": Cylinder, "light": Light, "zone": Zone}


def _range(name: str, text: str, kind: str) -> Any:
    match = re.fullmatch(rf"({NUMBER})(?:\s+to\s+({NUMBER}))?", text, re.ASCII | re.IGNORECASE)
    if not match or (match[2] and "Range" not in kind):
        ranged = f", or {name} 100 to 300" if "Range" in kind else ""
        said = shown(f"{name} {text}".strip())
        raise ValueError(f"{said} is not a number: write {name} 100{ranged}")
    return (float(match[1]), float(match[2])) if match[2] else float(match[1])


def is_number(value: Any, most: float = LONGEST) -> bool:
    """Return whether the value is a finite number, at most `most`."""
    numeric = isinstance(value, (int, float, np.integer, np.floating))
    return numeric and not isinstance(value, bool) and abs(value) <= most
