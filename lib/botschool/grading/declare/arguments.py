"""Make other arguments from a call's, which a right function must answer, too."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from botschool.sandbox.protocol import pack

SETTINGS = 6
"""Numbers in a list of which each is changed by itself."""


def numbers(value: Any) -> bool:
    """Return whether a list holds numbers only."""
    return all(isinstance(each, (int, float)) and not isinstance(each, bool) for each in value)


def with_others(arguments: tuple, others: tuple, inputs: Callable[[], list[tuple]]) -> tuple:
    """Return the others; a text or array that is the same in both comes from another input."""
    found = list(others)
    for place, (one, other) in enumerate(zip(arguments, others, strict=False)):
        if isinstance(one, (str, np.ndarray)) and pack([one]) == pack([other]):
            given = (each[place] for each in inputs() if len(each) > place)
            found[place] = next((each for each in given if _stands_for(one, each)), other)
    return tuple(found)


def _stands_for(one: Any, other: Any) -> bool:
    """Return whether another value of the same kind and shape differs."""
    alike = type(one) is type(other) and np.shape(one) == np.shape(other)
    return alike and pack([one]) != pack([other])


def one_changed(value: Any, other: Any) -> Iterator[tuple[tuple, Any]]:
    """Yield (place, a tuple, list or dict with one part changed), as the other one has it."""
    places = list(value) if isinstance(value, dict) else range(len(value))
    if type(value) is not type(other) or len(value) != len(other):
        return
    for place in places:
        if isinstance(value, dict) and place not in other:
            continue
        for inner, new in _changed(value[place], other[place]):
            parts: Any = copy.copy(value) if isinstance(value, dict) else list(value)
            parts[place] = new
            yield (place, *inner), tuple(parts) if isinstance(value, tuple) else parts


def _changed(value: Any, other: Any) -> Iterator[tuple[tuple, Any]]:
    """Yield (place in it, another value that may stand for a value); other: of another draw."""
    if isinstance(value, np.ndarray):
        if np.shape(other) == value.shape and not np.array_equal(value, other):
            yield (), other
    elif isinstance(value, dict):
        yield from one_changed(value, other)
    elif type(value) is type(other) and pack([value]) != pack([other]):
        if not isinstance(value, (list, tuple)) or len(value) == len(other):
            yield (), other
    elif isinstance(value, int) and not isinstance(value, bool) and value >= 2:
        yield (), value - 2 if value > 3 else value + 2  # even numbers stay even, and none is 0
    elif isinstance(value, float) and value:
        yield (), value / 2
    if isinstance(value, list) and len(value) <= SETTINGS and numbers(value):
        yield from one_changed(value, other)


def cut_to_size(arguments: tuple) -> Iterator[tuple[str, tuple]]:
    """Yield arguments whose arrays are cut to a square, then to size one, if one is a table.

    The tables in a dict, as a network's, are cut together with a vector that goes with them.
    """
    given = [each for each in arguments if isinstance(each, np.ndarray)]
    tables = [array for array in given if array.ndim > 1][:1]
    if given and not tables:
        dicts = [each.values() for each in arguments if isinstance(each, dict)]
        tables = [e for parts in dicts for e in parts if isinstance(e, np.ndarray) and e.ndim > 1]
    sizes = {n for table in tables for n in table.shape}
    rows = len(tables[0]) if given and tables else 0
    if not sizes or 0 in sizes:
        return
    for name, size in (("square", min(sizes)), ("one", 1)):

        def cut(array: np.ndarray, size: int = size) -> np.ndarray:
            return array[tuple(slice(_length(n, sizes, rows, size)) for n in array.shape)]

        yield name, mapped(arguments, cut, inside=True)


def _length(n: int, sizes: set[int], rows: int, size: int) -> int:
    """Return the length that n becomes; an array may have two places for each row of a table."""
    return size if n in sizes else size * (n // rows) if rows and n % rows == 0 else n


def in_single(array: np.ndarray) -> np.ndarray:
    """Return an array of double precision in single precision; others as they are."""
    return array.astype(np.float32) if array.dtype == np.float64 else array


def mapped(arguments: tuple, change: Callable[[np.ndarray], Any], inside: bool = False) -> tuple:
    """Return arguments with their arrays changed; inside: those in dicts of arrays, too."""

    def one(value: Any) -> Any:
        if inside and isinstance(value, dict):
            return {key: one(part) for key, part in value.items()}
        return change(value) if isinstance(value, np.ndarray) else value

    return tuple(one(each) for each in arguments)
