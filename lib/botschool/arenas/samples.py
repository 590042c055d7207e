"""Read measured infrared tables: `.sample` files (docs/specification.md, "Wheeled robots").

    8 180 20 5 2            sensors, angles, distances, first distance and step in mm
    TURN 0                  the first distance
    0.91 0.40 ...           180 lines of 8 readings: the object straight ahead, then every
    ...                     360 / 180 degrees farther round, counter-clockwise
    TURN 1                  the next distance
    ...
    END

Readings are shares of a sensor's greatest one. If a file has a reading above 1, all its readings
are raw units of a sensor with a maximum of 1023, and are divided by that.
"""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from io import TextIOWrapper

import numpy as np

from botschool import _core
from botschool.errors import BotschoolError
from botschool.inifile import refusal, shown
from botschool.npy import opened

SENSORS = 8
RAW_UNITS = 1023.0
HEADER = "8 180 20 5 2"
MOST = 10_000
"""Largest number of angles or distances."""


@dataclass(frozen=True)
class Samples:
    """Measured readings of eight infrared sensors."""

    first: float
    """Nearest distance between the robot's and the object's surface, mm."""
    step: float
    """Difference between two neighbouring distances, mm."""
    readings: np.ndarray
    """Shape (distances, angles, 8), 0 to 1."""

    def core(self) -> _core.Table:
        """Return the C++ counterpart."""
        return _core.Table(self.first, self.step, self.readings)


def load(path: str | os.PathLike[str]) -> Samples:
    """Read a `.sample` file. Raises BotschoolError with the line that is wrong."""
    lines = _Lines(path, _read(path))
    angles, distances, first, step = _header(lines)
    readings = np.empty((distances, angles, SENSORS))
    for distance in range(distances):
        _turn(lines, distance)
        for angle in range(angles):
            readings[distance, angle] = _readings(lines)
    end = lines.next("END")
    if end != ["END"]:
        lines.refuse(f"after the last distance comes END, not {shown(' '.join(end))}")
    if lines.left():
        lines.refuse(f"nothing may follow END, but there is {shown(' '.join(lines.next('')))}")
    if readings.max() > 1:
        readings /= RAW_UNITS
    return Samples(first, step, readings)


class _Lines:
    """The lines of a file that are not blank, one after another, as lists of words."""

    def __init__(self, path: str | os.PathLike[str], text: str) -> None:
        self._path = path
        numbered = enumerate(text.splitlines(), 1)
        self._lines = [(number, line.split()) for number, line in numbered if line.strip()]
        self._next = 0

    def left(self) -> int:
        """Return how many lines are yet to come."""
        return len(self._lines) - self._next

    def next(self, wanted: str) -> list[str]:
        """Return the next line's words; `wanted` names the missing part if the file ends here."""
        if not self.left():
            raise refusal(self._path, 0, f"the file ends where {wanted} should come")
        self._next += 1
        return self._lines[self._next - 1][1]

    def refuse(self, sentence: str) -> None:
        """Raise an error about the last line that was read."""
        raise refusal(self._path, self._lines[self._next - 1][0], sentence)


def _header(lines: _Lines) -> tuple[int, int, float, float]:
    words = lines.next(f"the header, such as {HEADER},")
    numbers = [_number(word) for word in words]
    if len(words) != 5 or None in numbers:
        lines.refuse(
            f"the header has five numbers, sensors angles distances first_distance step, such as "
            f"{HEADER}, not {shown(' '.join(words))}"
        )
    sensors, angles, distances, first, step = numbers
    if sensors != SENSORS:
        lines.refuse(f"a robot has {SENSORS} infrared sensors, but the header says {sensors:g}")
    for name, count in (("angles", angles), ("distances", distances)):
        if count != int(count) or not 1 <= count <= MOST:
            lines.refuse(f"the number of {name} is 1 to {MOST}, not {count:g}")
    if first < 0 or step <= 0:
        lines.refuse(
            f"the first distance must not be negative and the step must be above 0, "
            f"but they are {first:g} and {step:g}"
        )
    return int(angles), int(distances), first, step


def _turn(lines: _Lines, distance: int) -> None:
    words = lines.next(f"the readings at distance {distance + 1}, a line TURN {distance},")
    if len(words) != 2 or words[0] != "TURN" or not words[1].isdecimal():
        lines.refuse(
            f"here distance {distance + 1} begins with a line TURN {distance}, "
            f"not {shown(' '.join(words))}"
        )


def _readings(lines: _Lines) -> list[float]:
    words = lines.next(f"{SENSORS} readings")
    if len(words) != SENSORS:
        lines.refuse(f"{SENSORS} readings are needed, not {len(words)}: {shown(' '.join(words))}")
    numbers = []
    for word in words:
        number = _number(word)
        if number is None or not 0 <= number <= RAW_UNITS:
            lines.refuse(f"a reading is a number from 0 to {RAW_UNITS:g}, not {shown(word)}")
        numbers.append(number)
    return numbers


def _number(word: str) -> float | None:
    try:
        number = float(word)
    except ValueError:
        return None
    return number if math.isfinite(number) else None


def _read(path: str | os.PathLike[str]) -> str:
    try:
        with TextIOWrapper(opened(path), encoding="utf-8") as file:
            return file.read()
    except FileNotFoundError:
        raise refusal(path, 0, "there is no such file") from None
    except OSError as error:
        raise refusal(path, 0, f"it cannot be read ({error.strerror})") from None
    except ValueError:
        raise refusal(path, 0, "this is no .sample file: it is not plain text") from None
    except TypeError:
        raise BotschoolError(f"A .sample file is named by its path, not by {path!r}.") from None
