"""Look at what a function computes with, in the confined child."""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import FrameType
from typing import Any


def with_kinds(function: Callable[..., Any], *arguments: Any) -> tuple[Any, set[str]]:
    """Return a function's answer and the kinds of numbers that it held, as NumPy names them.

    "c" is complex, "f" floating-point. All variables of all functions that returned count.
    """
    kinds = set[str]()

    def look(frame: FrameType, event: str, result: Any) -> None:
        if event == "return":
            values = (*frame.f_locals.values(), result)
            kinds.update(getattr(getattr(each, "dtype", each), "kind", "") for each in values)
            kinds.update("c" for each in values if isinstance(each, complex))

    sys.setprofile(look)
    try:
        return function(*arguments), kinds
    finally:
        sys.setprofile(None)
