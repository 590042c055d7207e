"""Put values into words, for sentences about answers: kinds, a few numbers, calls to paste.

The work is bounded, whatever a submission returns.
"""

from __future__ import annotations

import reprlib
from collections.abc import Iterable
from itertools import groupby
from typing import Any

import numpy as np

FEW = 6
"""Numbers of an array that is shown whole."""
PASTED = 24
"""Numbers in an argument of a call to paste; characters of other arguments."""
MOST_EQUAL = 200
"""Numbers in such an argument if many neighbours are equal."""
MAX_CALL = 300
"""Characters of a call to paste."""
DIGITS = 6
"""Smallest number of digits; two numbers get more if they differ only in later digits."""


class _Short(reprlib.Repr):
    """Bound the work of repr() for a value that holds others, perhaps the same ones many times."""

    def __init__(self) -> None:
        super().__init__()
        self.maxlist = self.maxtuple = self.maxset = self.maxfrozenset = self.maxdict = 400
        self.maxstring = self.maxlong = self.maxother = 400
        self._left = 1000

    def repr1(self, value: Any, level: int) -> str:
        self._left -= 1
        return super().repr1(value, level) if self._left > 0 else "..."

    def repr_ndarray(self, value: np.ndarray, level: int) -> str:
        return show(value) if value.size > 200 else self.repr_instance(value, level)

    def repr_int(self, value: int, level: int) -> str:
        many = value.bit_length()
        return super().repr_int(value, level) if many < 4000 else f"an integer of {many} bits"


def show(value: Any, longest: int = 60) -> str:
    """Return a value in a few words."""
    if isinstance(value, np.ndarray):
        if value.size > FEW:
            return f"an array of shape {value.shape} that starts {numbers(value.ravel()[:4], 5)}..."
        if value.ndim == 0 and value.dtype.kind not in "biuf":
            return show(value.item(), longest)
        return numbers(value, 5) if value.ndim else f"{value.item():.6g}"
    if isinstance(value, float):
        return f"{value:.6g}"
    text = _Short().repr(value)
    return text if len(text) <= longest else text[: longest - 3] + "..."


def start_of(many: np.ndarray) -> str:
    """Return how a list of many numbers begins, or a list of lists; many: as an array."""
    what = f"{many.size} numbers" if many.ndim == 1 else f"shape {many.shape}"
    return f"a list of {what} that starts {numbers(many.ravel()[:4], 5)}..."


def numbers(array: np.ndarray, digits: int) -> str:
    """Return a small array in one line; digits: after the point, at most."""
    array = _without_points(array)
    text = np.array2string(array, precision=digits, separator=", ", threshold=8)
    return " ".join(text.split()).replace("[ ", "[").replace(" ,", ",").replace(" ]", "]")


def _without_points(array: np.ndarray) -> np.ndarray:
    """Return whole numbers as integers, so that they are shown as 2 and not as 2."""
    whole = array.dtype.kind == "f" and (abs(array) < 1e15).all() and (array % 1 == 0).all()
    return array.astype(np.int64) if whole else array


def kind(value: Any) -> str:
    """Return what a value is: "a list of 3 numbers", "an array of shape (3,) (float64)"."""
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape} ({value.dtype.name})"
    if isinstance(value, list):
        return _kind_of_list(value)
    if isinstance(value, dict):
        return f"a dict with the keys {show(list(value))}" if value else "an empty dict"
    names = {bool: "the truth value", int: "the number", float: "the number", str: "the text"}
    return f"{names.get(type(value), '')} {show(value)}".strip()


def _kind_of_list(value: list) -> str:
    if not value:
        return "an empty list"
    kinds = {type(each) for each in value[:1000]}
    many = f"{len(value)} " if len(value) > 1 else "one "
    if kinds <= {int, float}:
        return f"a list of {many}number" + "s" * (len(value) > 1)
    single = {list: "list", dict: "dict", np.ndarray: "array", str: "text", bool: "truth value"}
    if len(kinds) == 1 and kinds <= single.keys():
        name = single[kinds.pop()] + "s" * (len(value) > 1)
        inner = f", the first of which is {kind(value[0])}" if name.startswith(("l", "a")) else ""
        return f"a list of {many}{name}{inner}"
    return f"a list of {len(value)} values, {show(value)}"


def apart(one: float, other: float) -> tuple[str, str]:
    """Return two different numbers with as many digits as they need to differ."""
    for digits in range(DIGITS, 18):
        texts = f"{one:.{digits}g}", f"{other:.{digits}g}"
        if texts[0] != texts[1]:
            return texts
    return repr(float(one)), repr(float(other))


def arrays_apart(one: np.ndarray, other: np.ndarray) -> tuple[str, str]:
    """Return two small arrays of the same shape, with as many digits as they need to differ."""
    for digits in range(5, 18):
        texts = numbers(one, digits), numbers(other, digits)
        if texts[0].replace(".,", ",").replace(".]", "]") != texts[1]:
            return texts
    return texts


def argument(value: Any) -> str:
    """Return an argument for the name of a call: few numbers, or the shape."""
    if isinstance(value, np.ndarray):
        return numbers(value, 5) if value.size <= FEW else f"<array {value.shape}>"
    if isinstance(value, (list, tuple)) and _long(value, value):
        return f"<list of {len(value)}>"
    if isinstance(value, dict) and _long(value, value.values()):
        return f"<dict: {', '.join(map(str, list(value)[:4]))}{', ...' if len(value) > 4 else ''}>"
    return show(value, 40)


def _long(value: Any, parts: Iterable[Any]) -> bool:
    """Return whether repr() has more than 40 characters; where parts tell it, without repr()."""
    many = len(value) > 13 or any(isinstance(p, np.ndarray) and p.size > 12 for p in parts)
    return many or len(repr_of(value)) > 40


def pasted(
    name: str, arguments: tuple, options: dict, longest: int = MAX_CALL, most: int = PASTED
) -> str:
    """Return a call to paste into Python after `import numpy as np`; "" if it is too long.

    longest: characters. most: numbers in an argument.
    """
    values = [paste(value, most) for value in (*arguments, *options.values())]
    if not all(values):
        return ""
    names = [""] * len(arguments) + [f"{key}=" for key in options]
    parts = [key + value for key, value in zip(names, values, strict=True)]
    text = f"{name}({', '.join(parts)})"
    return text if len(text) <= longest else ""


def paste(value: Any, most: int = PASTED) -> str:
    """Return a value as Python; "" if it is too large."""
    if isinstance(value, np.ndarray):
        if value.ndim == 0:
            return repr(value.item())
        listed = repr(value.tolist()) if value.size <= most else ""
        if value.ndim == 1 and PASTED < value.size <= MOST_EQUAL:
            listed = _with_runs(value, most)
        kept = "" if value.dtype in (np.float64, np.int64, np.bool_) else f", dtype='{value.dtype}'"
        return f"np.array({listed}{kept})" if listed else ""
    if isinstance(value, (np.generic,)):
        return repr(value.item())
    if isinstance(value, dict):
        pairs = [(key, paste(each, most)) for key, each in value.items()]
        if len(pairs) > most or not all(text for _, text in pairs):
            return ""
        return "{" + ", ".join(f"{key!r}: {text}" for key, text in pairs) + "}"
    if isinstance(value, (list, tuple)):
        parts = [paste(each, most) for each in value[: most + 1]]
        return "" if len(parts) > most or not all(parts) else f"[{', '.join(parts)}]"
    text = repr_of(value)
    return text if len(text) <= 120 else ""


def _with_runs(array: np.ndarray, most: int) -> str:
    """Return a list of numbers as Python, with equal neighbours in short: [1.0, *9 * [0.0]].

    It is "" if it has too many parts.
    """
    runs = [(text, len(list(run))) for text, run in groupby(map(repr, array.tolist()))]
    parts = [f"*{many} * [{text}]" if many > 1 else text for text, many in runs]
    return f"[{', '.join(parts)}]" if len(parts) <= most else ""


def repr_of(value: Any) -> str:
    """Return repr() of a value, with bounded work."""
    return _Short().repr(value)
