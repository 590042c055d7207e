"""Physics in numbers: `gravity=3.7, friction=0.4..1.2, push=30` for runners and bodies in space."""

from __future__ import annotations

import re
from typing import NamedTuple

from botschool.errors import BotschoolError
from botschool.inifile import nearest, shown


class Number(NamedTuple):
    """A number of the world in which an episode takes place."""

    meaning: str
    own: float
    """What it is where nothing is said; gravity below 0 is the robot's own."""
    low: float
    high: float


NUMBERS = {
    "firmness": Number("firmness of the ground, times the robot's own", 1, 0.1, 10),
    "friction": Number("friction of the ground, times the robot's own", 1, 0, 10),
    "mass": Number("mass of the robot, times its own", 1, 0.1, 10),
    "motors": Number("torque of the motors, times their own", 1, 0, 10),
    "delay": Number("steps after which an action arrives, a whole number", 0, 0, 5),
    "noise": Number("standard deviation in sensed coordinates; of speeds 10 times it", 0, 0, 1),
    "gravity": Number("gravity in m/s^2", -1, 0.01, 100),
    "push": Number("newtons of a push, in each second one of 0.1 s", 0, 0, 100_000),
    "slope": Number("metres that the ground rises with each metre ahead", 0, -1, 1),
    "step": Number("metres that the ground rises at x = 2", 0, -0.5, 0.5),
    "bumps": Number("height of the ground's bumps in metres", 0, 0, 0.2),
    "stairs": Number("height of stairs in metres, one each 0.5 m from x = 2", 0, -0.3, 0.3),
}
"""In the order of Kind in lib/arena/robots/jointed/solid.hpp."""

VARY = {
    "ground": {"firmness": (0.5, 2.0), "friction": (0.6, 1.2)},
    "mass": {"mass": (0.8, 1.25)},
    "motors": {"motors": (0.8, 1.25)},
    "delay": {"delay": (0.0, 1.0)},
    "noise": {"noise": (0.02, 0.02)},
}
"""The words of the option `vary`, which stand for ranges."""

Spans = dict[str, tuple[float, float]]

_NUMBER = r"[+-]?(?:\d+(?:\.(?!\.)\d*)?|\.\d+)(?:e[+-]?\d+)?"
_ENTRY = re.compile(
    rf"\s*(\w+)\s*=\s*['\"(\[]?\s*({_NUMBER})(?:\s*(?:\.\.|,)\s*({_NUMBER}))?\s*['\")\]]?\s*(?:,|$)"
)


def read(text: str) -> Spans:
    """Return least and greatest value of each number that a text names, `friction=0.4..1.2`.

    Raises BotschoolError.
    """
    spans: Spans = {}
    place = 0
    while text[place:].strip():
        entry = _ENTRY.match(text, place)
        if not entry:
            raise BotschoolError(
                f"physics = {shown(text)} cannot be read: write name=number or name=low..high, "
                "separated by commas, as in gravity=3.7, friction=0.4..1.2."
            )
        name, low, high = entry.groups()
        spans |= span(name, float(low), float(high or low), spans)
        place = entry.end()
    return spans


def span(name: str, low: float, high: float, known: Spans) -> Spans:
    """Return the range of one number. Raises BotschoolError."""
    if name not in NUMBERS:
        raise BotschoolError(f"physics has no '{shown(name)}': {nearest(name, NUMBERS)}.")
    if name in known:
        raise BotschoolError(f"physics says {name} twice: keep one.")
    number = NUMBERS[name]
    if not number.low <= low <= high <= number.high:
        raise BotschoolError(
            f"{name} = {low:g}{'' if low == high else f'..{high:g}'} is not possible: it is "
            f"{number.meaning}, from {number.low:g} to {number.high:g}, the smaller one first."
        )
    if name == "delay" and (low % 1 or high % 1):
        raise BotschoolError("delay is a whole number of steps, as in delay=2 or delay=0..3.")
    return {name: (low, high)}


def rows(spans: Spans) -> list[list[float]]:
    """Return the rows that C++ takes."""
    return [list(spans.get(name, (number.own, number.own))) for name, number in NUMBERS.items()]
