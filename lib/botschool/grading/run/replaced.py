"""Replace a function for a while in the confined child, whoever holds a reference to it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FunctionType
from typing import Any


def _stub(*arguments: Any, _botschool_instead: Callable[..., Any], **options: Any) -> Any:
    return _botschool_instead(*arguments, **options)


@contextmanager
def replaced(
    place: Any, name: str, instead: Callable[[Callable[..., Any]], Callable[..., Any]]
) -> Iterator[None]:
    """Have instead(place.name) called in place of a module's function.

    A Python function is changed itself, so that names in other modules, default arguments and
    partials that stand for it call the other one, too. Of anything else only the name is replaced.
    """
    function = getattr(place, name)
    if not isinstance(function, FunctionType) or function.__closure__:
        setattr(place, name, instead(function))
        try:
            yield
        finally:
            setattr(place, name, function)
        return
    kept = function.__code__, function.__defaults__, function.__kwdefaults__
    own = FunctionType(kept[0], function.__globals__, function.__name__, kept[1])
    own.__kwdefaults__ = kept[2]
    other = instead(own)
    function.__code__ = _stub.__code__
    function.__defaults__, function.__kwdefaults__ = None, {"_botschool_instead": other}
    try:
        yield
    finally:
        function.__code__, function.__defaults__, function.__kwdefaults__ = kept
