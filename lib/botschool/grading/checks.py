"""What grader files say about answers, in sentences for the learner."""

from __future__ import annotations

import reprlib
from typing import Any

import numpy as np


class Wrong(Exception):
    """A check failed; the message is the sentence that the learner reads."""


class NotDone(Wrong):
    """The task has not been started: the skeleton's NotImplementedError came back."""


def expect(condition: bool, sentence: str) -> None:
    """Raises Wrong(sentence) unless the condition holds."""
    if not condition:
        raise Wrong(sentence)


def expect_fields(said: str, value: Any, *keys: str) -> list[Any]:
    """The values of these keys of a dict, which may have others."""
    expect(isinstance(value, dict), f"{said} {_came(said)} {show(value)}, but a dict is needed.")
    for key in keys:
        expect(key in value, f"{said} {_came(said)} a dict without {key!r}.")
    return [value[key] for key in keys]


def expect_array(said: str, value: Any, shape: tuple[int, ...]) -> np.ndarray:
    """The value as a float64 array of this shape, all finite; `said` names the call."""
    if value is None or isinstance(value, (str, dict)):
        raise Wrong(f"{said} {_came(said)} {show(value)}, but an array of shape {shape} is needed.")
    try:
        array = np.asarray(value)
    except (ValueError, TypeError, OverflowError):
        array = np.asarray(None)
    if array.dtype.kind not in "biuf":
        raise Wrong(f"{said} {_came(said)} {show(value)}, which is no array of numbers.")
    array = array.astype(np.float64)
    expect(array.shape == shape, f"{said} has shape {array.shape}, but {shape} was expected.")
    expect(bool(np.all(np.isfinite(array))), f"{said} holds NaN or infinity.")
    return array


def expect_close(said: str, value: Any, expected: Any, tolerance: float = 1e-9) -> None:
    """The value equals the expected number or array, within a relative and absolute tolerance."""
    wanted = np.asarray(expected, dtype=np.float64)
    got = expect_array(said, value, wanted.shape)
    close = np.isclose(got, wanted, rtol=tolerance, atol=tolerance)
    if close.all():
        return
    if got.size <= 6:
        raise Wrong(f"{said} {_came(said)} {show(got)}, but {show(wanted)} was expected.")
    where = np.unravel_index(int(np.argmin(close)), close.shape)
    place = ", ".join(map(str, where))
    raise Wrong(
        f"{said} {_came(said)} {show(got)}; at [{place}] it is {got[where]:.6g}, but "
        f"{wanted[where]:.6g} was expected."
    )


def _came(said: str) -> str:
    """The verb: `said` names a call, as "rank(x)", or a part of an answer, as "play(x): best"."""
    return "is" if "): " in said else "returned"


def plain(text: str) -> str:
    """A submission's text without what would steer a terminal or turn the writing around."""
    return "".join(c if c in "\n\t" or c.isprintable() or c == " " else "\ufffd" for c in text)


class _Short(reprlib.Repr):
    """repr() in bounded work: of a value that holds others, again and again the same perhaps."""

    def __init__(self) -> None:
        super().__init__()
        self.maxlist = self.maxtuple = self.maxset = self.maxfrozenset = self.maxdict = 400
        self.maxstring = self.maxlong = self.maxother = 400
        self._left = 1000

    def repr1(self, value: Any, level: int) -> str:
        self._left -= 1
        return super().repr1(value, level) if self._left > 0 else "..."

    def repr_int(self, value: int, level: int) -> str:
        many = value.bit_length()
        return super().repr_int(value, level) if many < 4000 else f"an integer of {many} bits"


def show(value: Any, longest: int = 60) -> str:
    """A value in a few words."""
    if isinstance(value, np.ndarray):
        if value.size > 6:
            return f"an array of shape {value.shape} that starts {_numbers(value.ravel()[:4])}..."
        return _numbers(value) if value.ndim else f"{value.item():.6g}"
    if isinstance(value, float):
        return f"{value:.6g}"
    text = _Short().repr(value)
    return text if len(text) <= longest else text[: longest - 3] + "..."


def _numbers(array: np.ndarray) -> str:
    return np.array2string(array, precision=5, separator=", ", threshold=8).replace("\n", "")
