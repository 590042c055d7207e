"""Adapt Gymnasium's spaces to a policy: a flat vector in, outputs that choose an action.

The rules are in docs/specification.md, "Any environment".
"""

from __future__ import annotations

import multiprocessing
import sys
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
from gymnasium import spaces

from botschool.policies.policy import Image, Interface

CHOICES = (spaces.Discrete, spaces.MultiDiscrete, spaces.MultiBinary)

OBSERVED = (
    "policies read numbers (a Box, Discrete, MultiDiscrete or MultiBinary, or a Dict or Tuple of "
    "them)"
)
ACTED = "policies give a Box, Discrete, MultiDiscrete or MultiBinary"


class Unsupported(ValueError):
    """Raised for a space that no policy can handle; it names the space and the usable ones."""


class Flattener:
    """Turns an observation into a vector: its parts one after the other.

    A Box gives its values in order, a Discrete value its one-hot vector. The parts of a Dict come
    in the order of its keys; parts that are not numbers, such as texts, are left out.
    """

    def __init__(self, space: spaces.Space, name: str) -> None:
        """Prepare the vector. Raises Unsupported."""
        leaves = list(_leaves(space, ()))
        self._parts = [(path, leaf) for path, leaf in leaves if _numbers(leaf)]
        if not self._parts:
            raise Unsupported(f"observations are {_short(space)}, but {OBSERVED}")
        for path, leaf in leaves:
            if not _numbers(leaf):
                _say_left_out(name, ".".join(map(str, path)), type(leaf).__name__)
        self.size = sum(spaces.flatdim(leaf) for _, leaf in self._parts)
        [(path, leaf), *others] = self._parts
        self._vector = not path and not others and isinstance(leaf, spaces.Box)
        self.image = _image(leaf) if self._vector else None
        """Image format of the observation, if it is one."""

    def __call__(self, raw: Any) -> np.ndarray:
        """Return the vector, float64, shape (size,), rounded to single precision.

        Raises TypeError, ValueError or LookupError for a value outside the space.
        """
        if self._vector:
            return _values(self._parts[0][1], raw)
        return np.concatenate([_values(leaf, _at(raw, path)) for path, leaf in self._parts])


def _leaves(space: spaces.Space, path: tuple) -> Iterator[tuple[tuple, spaces.Space]]:
    """Yield the spaces that contain no others, each with the keys that lead to it."""
    if isinstance(space, (spaces.Dict, spaces.Tuple)):
        named = space.items() if isinstance(space, spaces.Dict) else enumerate(space)
        for key, part in named:
            yield from _leaves(part, (*path, key))
    else:
        yield path, space


def _numbers(space: spaces.Space) -> bool:
    if isinstance(space, spaces.Box):
        return space.dtype.kind in "fiub"
    return isinstance(space, CHOICES)


def _at(raw: Any, path: tuple) -> Any:
    for key in path:
        raw = raw[key]
    return raw


def _values(space: spaces.Space, raw: Any) -> np.ndarray:
    if isinstance(space, spaces.Discrete):
        return np.asarray(spaces.flatten(space, raw), dtype=np.float64)
    if not isinstance(space, spaces.Box):
        given = np.asarray(raw)
        if given.shape != space.shape:
            raise ValueError("another shape")
        return np.asarray(spaces.flatten(space, given), dtype=np.float64)
    values = np.asarray(raw, dtype=np.float32)
    if values.shape != space.shape:
        raise ValueError("another shape")
    return values.astype(np.float64).ravel()


def _image(space: spaces.Box) -> Image | None:
    if not 2 <= len(space.shape) <= 4:
        return None
    return Image(space.shape, 255.0 if space.dtype == np.uint8 else 1.0)


def _short(space: spaces.Space) -> str:
    if isinstance(space, spaces.Box):
        return f"{space.dtype} values"
    return f"a {type(space).__name__} space"


@cache
def _say_left_out(name: str, part: str, kind: str) -> None:
    if multiprocessing.parent_process() is None:
        print(
            f"note: {name}: '{part}' of its observations is left out ({kind}, no numbers)",
            file=sys.stderr,
        )


def interface(
    size: int, acted: spaces.Space, morphology: int, image: Image | None = None
) -> Interface:
    """Return the interface for observations of that size and these actions. Raises Unsupported."""
    seen: dict[str, Any] = {"morphology": morphology, "image": image}
    if isinstance(acted, spaces.Discrete):
        return Interface(size, int(acted.n), discrete=True, **seen)
    if isinstance(acted, (spaces.MultiDiscrete, spaces.MultiBinary)):
        binary = isinstance(acted, spaces.MultiBinary)
        groups = (2,) * int(np.prod(acted.shape)) if binary else map(int, acted.nvec.ravel())
        groups = tuple(groups)
        return Interface(size, sum(groups), discrete=True, groups=groups, **seen)
    if not isinstance(acted, spaces.Box) or acted.dtype.kind not in "fiub":
        raise Unsupported(f"actions are {_short(acted)}, but {ACTED}")
    low, high = np.unique(acted.low), np.unique(acted.high)
    common = len(low) == len(high) == 1 and np.isfinite([low[0], high[0]]).all()
    return Interface(
        size,
        int(np.prod(acted.shape)),
        discrete=False,
        low=float(low[0]) if common else None,
        high=float(high[0]) if common else None,
        **seen,
    )


def fitted(action: Any, space: spaces.Space) -> Any:
    """Return an action in the space: choices start at its first value, numbers are clipped."""
    if isinstance(space, spaces.Discrete):
        return space.start + action
    if isinstance(space, (spaces.MultiDiscrete, spaces.MultiBinary)):
        start = getattr(space, "start", 0)
        return (np.reshape(action, space.shape) + start).astype(space.dtype)
    if not np.isfinite(action).all():
        action = np.nan_to_num(action)
    if len(space.shape) != 1:
        action = action.reshape(space.shape)
    limited = np.minimum(np.maximum(action, space.low), space.high)  # a third of np.clip's time
    return limited.astype(space.dtype, copy=False)
