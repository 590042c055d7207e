"""Check answers for grader files, in sentences for the learner."""

from __future__ import annotations

import re
from typing import Any

import numpy as np

from botschool.grading.declare import diagnosis
from botschool.grading.declare.values import FEW, apart, arrays_apart, kind, show, start_of
from botschool.sandbox.exceptions import nearest
from botschool.screen import plain as plain

_TASK = re.compile(r"task (\d+\.\d+)\b")


class Wrong(Exception):
    """A check failed; the message is the sentence that the learner reads."""

    said = ""
    """The call, or its part, that the sentence is about; "" if a check composed the sentence."""
    wanted = ""
    """What was expected there, in a few words."""
    stays = False
    """Whether the sentence says already that something stays from call to call."""


class Mismatch(Wrong):
    """An answer differs from the expected one."""

    def __init__(self, sentence: str, said: str, wanted: Any) -> None:
        super().__init__(sentence)
        self.said, self.wanted = said, show(wanted)


class NotDone(Wrong):
    """A function is not started: the skeleton still raises NotImplementedError."""

    def __init__(self, text: str) -> None:
        """Take the text of the skeleton's exception, "task 3.2: rank the population"."""
        super().__init__(f"not done yet{f': {text}' if text else ''}")
        named = _TASK.match(text)
        self.task = named[1] if named else ""


def expect(condition: bool, sentence: str) -> None:
    """Raise Wrong(sentence) unless the condition holds."""
    if not condition:
        raise Wrong(sentence)


def expect_fields(said: str, value: Any, *keys: str) -> list[Any]:
    """Return the values of these keys of a dict, which may have other keys."""
    expect(isinstance(value, dict), f"{said} {came(said)} {kind(value)}, but a dict is needed.")
    for key in keys:
        if key not in value:
            near = nearest(key, list(value)[:100])
            has = f" (it has {near!r}: rename that)" if near else ""
            raise Wrong(f"{said} {came(said)} a dict without {key!r}{has}.")
    return [value[key] for key in keys]


def expect_array(said: str, value: Any, shape: tuple[int, ...]) -> np.ndarray:
    """Return the value as a finite float64 array of this shape; said: the name of the call."""
    array = _array(said, value, shape)
    if array.shape != shape:
        hint = diagnosis.of_shapes(array.shape, shape)
        raise Wrong(f"{_but(said, value, shape)} {hint}".rstrip())
    bad = ~np.isfinite(array)
    if bad.any():
        raise Wrong(_not_finite(said, array, bad))
    return array


def expect_close(said: str, value: Any, expected: Any, tolerance: float = 1e-9) -> None:
    """Raise Mismatch unless the value equals the expected number or array.

    tolerance: relative and absolute. Fractions in single precision may differ by as much as single
    precision does (see `_allowed`).
    """
    wanted = np.asarray(expected, dtype=np.float64)
    array = _array(said, value, wanted.shape)
    if array.shape != wanted.shape:
        raise Mismatch(_but(said, value, wanted.shape), said, wanted)
    odd = ~np.isfinite(wanted) & ((array == wanted) | (np.isnan(array) & np.isnan(wanted)))
    got, wanted = (
        expect_array(said, np.where(odd, 0.0, array), wanted.shape),
        np.where(odd, 0.0, wanted),
    )
    finite = np.isfinite(wanted)
    nearly = np.where(finite, wanted, 0.0)
    close = finite & (np.abs(got - nearly) <= _allowed(got, nearly, tolerance))
    if not close.all():
        shown = show(got) if isinstance(value, np.ndarray) else start_of(got)
        sentence = _unequal(said, got, wanted, close, shown)
        if all(isinstance(each, (bool, np.bool_)) for each in (value, expected)):
            sentence = f"{said} {came(said)} {bool(value)}, but {bool(expected)} was expected."
        if cuts_fractions(value, wanted):
            sentence += f"\n  It is an array of {value.dtype}, which holds no fractions."
        raise Mismatch(sentence, said, expected)


def cuts_fractions(value: Any, wanted: Any) -> bool:
    """Return whether a value is an array of whole numbers, but the wanted array has fractions."""
    if not (isinstance(value, np.ndarray) and isinstance(wanted, np.ndarray)):
        return False
    fractions = wanted.dtype.kind == "f" and bool((wanted != np.round(wanted)).any())
    return value.dtype.kind in "iu" and fractions


def _array(said: str, value: Any, shape: tuple[int, ...]) -> np.ndarray:
    """Return the value as an array of numbers, of any shape."""
    if value is None or isinstance(value, (str, dict)):
        raise Wrong(_but(said, value, shape))
    try:
        array = np.asarray(value)
    except (ValueError, TypeError, OverflowError):
        array = np.asarray(None)
    if array.dtype.kind not in "biuf":
        raise Wrong(
            f"{said} {came(said)} {kind(value)}, which is not an array of numbers: one of "
            f"shape {shape} is needed."
        )
    return array.astype(np.float64)


def _allowed(got: np.ndarray, wanted: np.ndarray, tolerance: float) -> np.ndarray:
    """Return how far each number may differ; single precision is allowed if all fit into float32.

    That is a relative difference of 1e-5, or 1e-6 of the largest number. Whole numbers stay exact.
    """
    allowed = tolerance * (1 + np.abs(wanted))
    with np.errstate(over="ignore"):
        single = got.size > 0 and bool((got.astype(np.float32) == got).all())
    if single and (got % 1).any():
        allowed = np.maximum(allowed, 1e-5 * np.abs(wanted) + 1e-6 * np.abs(wanted).max())
    return allowed


def _but(said: str, value: Any, shape: tuple[int, ...]) -> str:
    """Return the sentence about a value of another kind or shape."""
    needed, were = f"an array of shape {shape}" if shape else "a single number", "was"
    if isinstance(value, list) and len(shape) == 1:
        needed, were = ("1 number", "was") if shape == (1,) else (f"{shape[0]} numbers", "were")
    elif isinstance(value, list) and shape:
        needed = f"shape {shape}"
    if value is None:
        end = "" if came(said) in ("is", "are") else ": does it end without `return`?"
        return f"{said} {came(said)} None, but {needed} is needed{end}"
    was = kind(value)
    if isinstance(value, list) and (inner := np.shape(np.asarray(value))) and len(inner) > 1:
        was += f" (shape {inner})"
    return f"{said} {came(said)} {was}, but {needed} {were} expected."


def _not_finite(said: str, array: np.ndarray, bad: np.ndarray) -> str:
    where = np.unravel_index(int(np.argmax(bad)), bad.shape)
    place = f" at [{', '.join(map(str, where))}]" if array.ndim else ""
    what = "NaN" if np.isnan(array[where]) else "infinity"
    causes = {
        "NaN": (
            "0 / 0, 0 * log(0), infinity / infinity, infinity minus infinity, the root of a "
            "negative number, or np.nan"
        ),
        "infinity": "a division by 0, the logarithm of 0, np.exp of a large number, or np.inf",
    }
    many = f" ({int(bad.sum())} of {bad.size} numbers are NaN or infinity)" if bad.size > 1 else ""
    verb = "holds" if array.ndim else came(said)
    return f"{said} {verb} {what}{place}{many}. It may come from {causes[what]}."


def _unequal(said: str, got: np.ndarray, wanted: np.ndarray, close: np.ndarray, shown: str) -> str:
    """Return the sentence about wrong numbers; shown: words for the submission's, if many."""
    start = f"{said} {came(said)}"
    if got.ndim == 0:
        one, other = apart(float(got), float(wanted))
        return f"{start} {one}, but {other} was expected."
    if got.size <= FEW:
        one, other = arrays_apart(got, wanted)
        return f"{start} {one}, but {other} was expected."
    where = np.unravel_index(int(np.argmin(close)), close.shape)
    place = ", ".join(map(str, where))
    one, other = apart(float(got[where]), float(wanted[where]))
    wrong = int((~close).sum())
    return (
        f"{start} {shown}; at [{place}] it is {one}, but {other} was expected "
        f"({'all' if wrong == got.size else wrong} of {got.size} numbers differ)."
    )


_CALL = re.compile(r"[\w.]+(?:[(,]|$)")
_INSIDE = re.compile(r"\([^()]*\)|\[[^][]*\]|'[^']*'")


_SEVERAL = re.compile(r"the (?:\w+ )?\w+[^aius\W]s\b(?! (?:and|or))")
"""A name of several things: "the seeds of evaluate"."""


def came(said: str) -> str:
    """Return the verb after a call, "rank(x)", or after a part of an answer, "play(x): best"."""
    outside = said
    while (shorter := _INSIDE.sub("", outside)) != outside:
        outside = shorter
    if _CALL.match(said) and ": " not in outside:
        return "returned"
    return "are" if _SEVERAL.match(outside.rpartition(": ")[2]) else "is"
