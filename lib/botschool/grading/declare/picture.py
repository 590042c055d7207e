"""Say how the answers of a task are drawn: what one sees, its axes, and a call made for it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

KINDS = {
    "against": "your numbers against the expected ones, of single numbers from many calls",
    "arrows": "(n, 4): arrows, each a start and a change",
    "bars": "a few numbers beside each other",
    "curves": "(n,) or (n, curves) over their index, or over what `of` names OVER",
    "groups": "(n, 3): points and the number of their group",
    "heat": "a table as a heat map; beside the expected one, their difference",
    "histogram": "the distribution of many numbers",
    "path": "(n, 2) or (n, paths, 2): ways from a ring to a disc",
    "points": "(n, 2): points in a plane",
    "shapes": "(n, corners, 2): filled polygons",
}
"""Kinds of pictures; "" leaves the choice to the shape of the answer."""
OVER = "over"
"""The name of the values of a horizontal axis in what `of` returns."""


def all_over(module: Any, name: str, inputs: Any, *more: Any) -> list[list[float]]:
    """{0}(observation), all over a plane"""
    return [[float(getattr(module, name)(each, *more)) for each in row] for row in inputs]


@dataclass(frozen=True)
class Picture:
    """How the answers of a task are drawn (docs/specification.md, "Pictures of tasks")."""

    says: str
    """What one sees in the picture of a right answer, in a sentence."""
    x: str = ""
    y: str = ""
    """Labels of the axes, with units."""
    kind: str = ""
    of: Callable[..., Any] | None = None
    """Returns what is drawn, of an answer and its arguments: an array, or names and arrays."""
    call: tuple[Any, ...] | Callable[[Any], tuple[Any, ...]] = ()
    """A function's name, or a driver, and arguments that show more than the inputs of a check; or
    a function of the grader's module that returns them."""
    extent: tuple[float, float, float, float] | None = None
    """Left, right, bottom and top of the axes."""

    def __post_init__(self) -> None:
        if self.kind not in {"", *KINDS}:
            raise ValueError(f"There is no picture {self.kind!r}; there are {list(KINDS)}.")
