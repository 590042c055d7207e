"""Translate Gymnasium's spaces for policies and for learners.

A policy (`botschool es`) reads a flat vector, and its outputs choose an action. A learner
(`botschool rl`) reads the numbers, and acts, in plain spaces: without nests, limits at infinity and
other axes than it can handle, with choices counted from 0. The rules are in docs/specification.md,
"Any environment".
"""

from __future__ import annotations

from collections.abc import Container, Iterator
from typing import Any

import numpy as np
from gymnasium import spaces

from botschool.policies.policy import Image, Interface
from botschool.problems.base import say

CHOICES = (spaces.Discrete, spaces.MultiDiscrete, spaces.MultiBinary)

OBSERVED = (
    "policies read numbers (a Box, Discrete, MultiDiscrete or MultiBinary, or a Dict or Tuple of "
    "them)"
)
ACTED = "policies give a Box, Discrete, MultiDiscrete or MultiBinary"


LARGEST = float(np.finfo(np.float32).max)
SMALLEST_IMAGE = 36
"""Pixels that the convolutional networks of Stable-Baselines3 need in each direction."""


class Unsupported(ValueError):
    """Raised for a space that no policy can handle; it names the space and the usable ones."""


class Flattener:
    """Turns an observation into a vector: its parts one after the other.

    A Box gives its values in order, a Discrete value its one-hot vector. The parts of a Dict come
    in the order of its keys; parts that are not numbers, such as texts, are left out.
    """

    def __init__(self, space: spaces.Space, name: str) -> None:
        """Prepare the vector. Raises Unsupported."""
        self._parts = _parts(space, name)
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


class PlainObservations:
    """Turns an observation into one that a learner reads, of `space`.

    Parts of a nest stand side by side in one Dict; parts that are not numbers are left out.
    """

    def __init__(self, space: spaces.Space, name: str) -> None:
        """Prepare the space. Raises Unsupported."""
        parts = _parts(space, name)
        alone = len(parts) == 1 and not parts[0][0]
        self._parts: dict[str, tuple[tuple, spaces.Space, spaces.Space]] = {}
        for path, leaf in parts:
            self._parts[_key(path, self._parts)] = path, leaf, _plain(leaf, alone)
        plain = [(key, space) for key, (*_, space) in self._parts.items()]
        self._alone = plain[0][0] if alone else None
        self.space = plain[0][1] if alone else spaces.Dict(plain)

    def __call__(self, raw: Any) -> Any:
        """Return the plain observation.

        Raises TypeError, ValueError or LookupError for a value outside the space.
        """
        found = {}
        for key, (path, leaf, plain) in self._parts.items():
            value = _at(raw, path)
            if not isinstance(leaf, spaces.Box):
                value = _chosen(leaf, value)
            elif not np.isfinite(_single(leaf, value)).all():
                raise ValueError("it holds NaN or infinity")
            found[key] = np.array(value).reshape(plain.shape)  # a copy: some environments reuse it
        return found if self._alone is None else found[self._alone]

    def back(self, key: str, values: np.ndarray) -> np.ndarray:
        """Return plain values of this part, (n, ...), as the environment gave them."""
        _, leaf, _ = self._parts[key]
        return values.reshape(len(values), *(leaf.shape or (1,))) + getattr(leaf, "start", 0)


def _key(path: tuple, taken: Container[str]) -> str:
    """Return a part's name; torch refuses dots and the names of its own methods."""
    key = "/".join(map(str, path)).replace(".", "/")
    if not path:
        return key
    from torch.nn import ModuleDict

    while key in taken or hasattr(ModuleDict, key) or key in vars(ModuleDict()):
        key += "/"
    return key


def _plain(leaf: spaces.Space, alone: bool) -> spaces.Space:
    """Return the space that a learner reads in place of this part."""
    if isinstance(leaf, spaces.Discrete):
        return spaces.Discrete(int(leaf.n))
    if isinstance(leaf, spaces.MultiDiscrete):
        return spaces.MultiDiscrete(_choices(leaf))
    if isinstance(leaf, spaces.MultiBinary):
        return spaces.MultiBinary(int(np.prod(leaf.shape)))
    if leaf.shape and (alone or len(leaf.shape) != 3 or is_image(leaf)):
        return leaf
    return spaces.Box(leaf.low.ravel(), leaf.high.ravel(), dtype=leaf.dtype)


def is_image(space: spaces.Space) -> bool:
    """Return whether a learner's convolutional network can read the space."""
    return (
        isinstance(space, spaces.Box)
        and len(space.shape) == 3
        and space.dtype == np.uint8
        and sorted(space.shape)[1] >= SMALLEST_IMAGE
    )


def _parts(space: spaces.Space, name: str) -> list[tuple[tuple, spaces.Space]]:
    """Return the parts that are numbers, with their paths; say what is left out."""
    leaves = list(_leaves(space, ()))
    parts = [(path, leaf) for path, leaf in leaves if _numbers(leaf)]
    if not parts:
        raise Unsupported(f"observations are {_short(space)}, but {OBSERVED}")
    for path, leaf in leaves:
        if not _numbers(leaf):
            part, kind = ".".join(map(str, path)), type(leaf).__name__
            say(f"{name}: '{part}' of its observations is left out ({kind}, no numbers)")
    return parts


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
    if isinstance(space, spaces.Box):
        return _single(space, raw).astype(np.float64).ravel()
    chosen = _chosen(space, raw)
    if isinstance(space, spaces.MultiBinary):
        return chosen.astype(np.float64)
    counts = _choices(space)
    hot = np.zeros(counts.sum())
    hot[np.cumsum(counts) - counts + chosen] = 1.0
    return hot


def _single(space: spaces.Box, raw: Any) -> np.ndarray:
    """Return the values of a Box in single precision."""
    with np.errstate(over="ignore"):
        values = np.asarray(raw, dtype=np.float32)
    if values.shape != space.shape:
        if np.squeeze(values).shape == tuple(n for n in space.shape if n != 1):
            return values.reshape(space.shape)
        raise ValueError(f"it has shape {values.shape} instead of {space.shape}")
    return values


def _choices(space: spaces.Space) -> np.ndarray:
    """Return how many choices each value of the space has."""
    if isinstance(space, spaces.MultiBinary):
        return np.full(int(np.prod(space.shape)), 2)
    return np.ravel(space.n if isinstance(space, spaces.Discrete) else space.nvec)


def _chosen(space: spaces.Space, raw: Any) -> np.ndarray:
    """Return the values of the choices in order, each counted from 0."""
    given = np.asarray(raw)
    if given.shape != space.shape and (space.shape or given.size != 1):
        raise ValueError(f"it has shape {given.shape} instead of {space.shape}")
    values = given.ravel() - np.ravel(getattr(space, "start", 0))
    if not ((values >= 0) & (values < _choices(space)) & (values % 1 == 0)).all():
        raise ValueError("it is none of the choices")
    return values.astype(np.int64)


def _image(space: spaces.Box) -> Image | None:
    if not 2 <= len(space.shape) <= 4:
        return None
    return Image(space.shape, 255.0 if space.dtype == np.uint8 else 1.0)


def _short(space: spaces.Space) -> str:
    if isinstance(space, spaces.Box):
        return f"{space.dtype} values"
    return f"a {type(space).__name__} space"


def interface(
    size: int,
    acted: spaces.Space,
    morphology: int,
    image: Image | None = None,
    scaled: bool = False,
) -> Interface:
    """Return the interface for observations of that size and these actions. Raises Unsupported.

    scaled: whether outputs with limits are scaled to those of the actions.
    """
    seen: dict[str, Any] = {"morphology": morphology, "image": image}
    if isinstance(acted, spaces.Discrete):
        return Interface(size, int(acted.n), discrete=True, **seen)
    if isinstance(acted, (spaces.MultiDiscrete, spaces.MultiBinary)):
        groups = tuple(map(int, _choices(acted)))
        return Interface(size, sum(groups), discrete=True, groups=groups, **seen)
    _check_actions(acted)
    low, high = np.unique(acted.low), np.unique(acted.high)
    common = len(low) == len(high) == 1 and np.isfinite([low[0], high[0]]).all()
    return Interface(
        size,
        int(np.prod(acted.shape)),
        discrete=False,
        low=float(low[0]) if common else None,
        high=float(high[0]) if common else None,
        reach=_reach(acted),
        scaled=scaled,
        **seen,
    )


def _reach(space: spaces.Box) -> tuple[tuple[float, float], ...]:
    """Return the smallest and the largest action of each actuator, infinite without limits.

    Whole numbers get half a step more on both sides, so that all have the same share.
    """
    low, high = (np.float64(edge).ravel() for edge in (space.low, space.high))
    half, largest = 0.0, LARGEST
    if space.dtype.kind != "f":
        half, largest = 0.5, float(2**31 - 1)  # ClipAction sets the largest whole number
    far = (low <= -largest) | (high >= largest)
    low, high = np.where(far, [[-np.inf], [np.inf]], [low - half, high + half])
    return tuple(zip(low.tolist(), high.tolist(), strict=True))


def plain_actions(space: spaces.Space) -> spaces.Space:
    """Return the space in which a learner acts; `fitted` translates its actions.

    Where a Box has no limit, this one has the largest number. Raises Unsupported.
    """
    if isinstance(space, CHOICES):
        return _plain(space, alone=True)
    _check_actions(space)
    if space.dtype.kind == "f" and len(space.shape) == 1 and has_limits(space):
        return space
    half = 0.0 if space.dtype.kind == "f" else 0.5  # each whole number gets the same share
    low, high = space.low.ravel() - half, space.high.ravel() + half
    return spaces.Box(*np.clip([low, high], -LARGEST, LARGEST).astype(np.float32))


def has_limits(space: spaces.Space) -> bool:
    """Return whether a learner can scale its actions to the limits of the Box."""
    within = np.abs([space.low, space.high], dtype=np.float64) < LARGEST
    return bool(within.all()) and space.is_bounded()


def _check_actions(space: spaces.Space) -> None:
    if not isinstance(space, spaces.Box) or space.dtype.kind not in "fiub":
        raise Unsupported(f"actions are {_short(space)}, but {ACTED}")


def fitted(action: Any, space: spaces.Space) -> Any:
    """Return an action in the space: choices start at its first value, numbers are clipped, and
    whole ones rounded.
    """
    if isinstance(space, spaces.Discrete):
        return space.start + action
    if isinstance(space, (spaces.MultiDiscrete, spaces.MultiBinary)):
        start = getattr(space, "start", 0)
        return (np.reshape(action, space.shape) + start).astype(space.dtype)
    if not np.isfinite(action).all():
        action = np.nan_to_num(action)
    if len(space.shape) != 1:
        action = action.reshape(space.shape)
    if space.dtype.kind != "f":
        action = np.rint(action)
    limited = np.minimum(np.maximum(action, space.low), space.high)  # a third of np.clip's time
    return limited.astype(space.dtype, copy=False)
