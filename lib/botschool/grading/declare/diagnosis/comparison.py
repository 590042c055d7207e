"""Compare a wrong answer with the right one, for detectors of likely causes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

MAX_NUMBERS = 1_000_000
"""Numbers of an answer to look at, at most."""


@dataclass(frozen=True)
class Comparison:
    """Two different arrays of finite float64, with the arguments of the call."""

    got: np.ndarray
    wanted: np.ndarray
    arguments: tuple = ()
    """Arguments of the call."""
    answer: Any = None
    """The whole answer, of which `got` may be a part."""

    def same(self, candidate: Any) -> bool:
        """Return whether the wrong answer equals this, to rounding (single precision included)."""
        return alike(self.got, candidate)

    @property
    def in_rows(self) -> bool:
        """Return whether both have the same shape, with at least three rows."""
        return self.got.shape == self.wanted.shape and self.got.ndim > 0 and len(self.got) > 2

    @cached_property
    def varied(self) -> int:
        """Return how many different numbers other than 0 are expected; few numbers prove little."""
        return len(np.unique(self.wanted[self.wanted != 0]))

    @cached_property
    def telling(self) -> bool:
        """Return whether no factor or formula fits by chance; one fits 1/2, or a count like 200."""
        parts = 60 * self.wanted
        simple = np.abs(parts - np.round(parts)).max() < 1e-9 and np.abs(parts).max() < 1200
        whole = (
            np.array_equal(self.wanted, np.round(self.wanted)) and np.abs(self.wanted).max() < 1000
        )
        return self.varied >= (3 if simple or whole else 1)

    @cached_property
    def given(self) -> list[np.ndarray]:
        """Return the arrays of numbers among the arguments, also inside lists and dicts."""
        return [each for each in arrays(self.arguments, 0) if each.size <= MAX_NUMBERS]

    @property
    def pairs(self) -> list[int]:
        """Return [2] if two things are counted here, else []."""
        return [2] if 2 in self._counted else []

    @property
    def counts(self) -> list[int]:
        """Return counts at hand: lengths of the arguments and the answer, small integers."""
        return sorted(n for n in self._counted if n > 2)

    @cached_property
    def _counted(self) -> set[int]:
        found = set(self.wanted.shape)
        found |= {len(each) for each in self.arguments if isinstance(each, (list, dict))}
        for each in self.given:
            found |= {*each.shape, each.size}
            if each.ndim == 0 and each == np.round(each) and abs(float(each)) < 10_000:
                found.add(int(each))
        return found


def alike(one: Any, other: Any) -> bool:
    """Return whether two arrays are the same, to rounding."""
    one, other = np.asarray(one, dtype=np.float64), np.asarray(other, dtype=np.float64)
    if one.shape != other.shape or not np.all(np.isfinite(other)):
        return False
    scale = float(np.abs(other).max()) if other.size else 0.0
    return bool(np.allclose(one, other, rtol=1e-5, atol=1e-7 * scale))


def arrays(value: Any, depth: int = 0) -> list[np.ndarray]:
    """Return the arrays of numbers in a value of plain data; a list of numbers is an array."""
    if isinstance(value, np.ndarray):
        return [value.astype(np.float64)] if value.dtype.kind in "biuf" else []
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return [np.asarray(value, dtype=np.float64)] if abs(value) < 1e300 else []
    if isinstance(value, dict):
        value = list(value.values())
    if not isinstance(value, (list, tuple)) or depth > 3 or len(value) > 1000:
        return []
    found = [each for part in value for each in arrays(part, depth + 1)]
    if value and all(isinstance(each, (int, float)) for each in value):
        return [np.asarray(value, dtype=np.float64)]
    return found


def parts(answer: Any, depth: int = 0) -> list[tuple[str, Any]]:
    """Return (name, value) of a few parts of an answer that are numbers or arrays of numbers."""
    found: list[tuple[str, Any]] = []
    if depth > 2 or not isinstance(answer, (dict, list)):
        return found
    named = isinstance(answer, dict)
    entries = answer.items() if isinstance(answer, dict) else enumerate(answer, 1)
    for _, (key, value) in zip(range(50), entries, strict=False):
        if isinstance(value, dict) or (isinstance(value, list) and not arrays(value)):
            found += parts(value, depth + 1)
        elif isinstance(value, (list, np.ndarray, int, float)) and not isinstance(value, bool):
            found.append((repr(key) if named else f"number {key} of your values", value))
    return found


Detector = Callable[[Comparison], "str | None"]


def adding_to(detectors: list[Detector]) -> Callable[[Detector], Detector]:
    """Return a decorator that appends functions to this list."""

    def add(function: Detector) -> Detector:
        detectors.append(function)
        return function

    return add
