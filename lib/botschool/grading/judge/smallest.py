"""Find a small failing call: a few rows of arguments on which a submission differs from ours."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from botschool.grading.declare.alike import distance
from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.values import pasted
from botschool.grading.judge.sentence import APART
from botschool.grading.run.student import Student

SECONDS = 2.0
"""Processor seconds for all calls to our solution and to the submission."""
FEW = 4
"""Fewer numbers in an array may be one thing with so many parts, a state or a pair of limits."""
MOST_ROWS = 60
"""Single rows to try."""
PREFIXES = (1, 2, 3, 4, 6, 8)
"""Numbers of first rows to try."""
LONGEST, WORDS, MOST = 640, 48, 72
"""Characters and words of a call to show, and numbers in one of its arguments."""
DIGITS = (3, 5, 17)
"""Digits of fractions in such a call; the first that makes the answers differ is used."""
Cut = Callable[[np.ndarray], np.ndarray]


def smallest_call(
    request: dict[str, Any], submission: Student, ours: Student
) -> tuple[str, dict[str, Any], Any] | None:
    """Return a small call that the submission answers wrongly: text, request and our answer.

    request: a function call with arrays that was answered wrongly; with {} there is no small one.
    submission, ours: both in processes whose time does not count. Raises Wrong and BotschoolError.
    """
    end = ours.seconds_left - SECONDS
    for call in (*_smaller(request), request) if request else ():
        small = _simplest(call, submission, ours)
        if small or ours.seconds_left < end:
            return small
    return None


def _simplest(
    call: dict[str, Any], submission: Student, ours: Student
) -> tuple[str, dict[str, Any], Any] | None:
    """Return a call with the fewest digits that still tell the answers apart.

    None if both agree, or one of them cannot answer.
    """
    for digits in DIGITS:
        simple = _rounded(call, digits)
        parts = simple["name"], tuple(simple["arguments"]), simple["options"]
        text = pasted(*parts, LONGEST, MOST)
        many = len(text.split()) > WORDS
        if not text or many or ours.seconds_left <= 0 or submission.seconds_left <= 0:
            continue
        try:
            right, got = ours.ask(simple), submission.ask(simple)
        except Wrong:
            continue
        size = right.size if isinstance(right, np.ndarray) else right != [] and right != {}
        if size and _finite(got) and _finite(right) and distance(got, right) > APART:
            return text, simple, right
    return None


def _finite(answer: Any) -> bool:
    """Return whether an answer holds no NaN and no infinity."""
    if isinstance(answer, dict):
        answer = list(answer.values())
    if isinstance(answer, list) and not all(isinstance(number, (int, float)) for number in answer):
        return all(map(_finite, answer))
    try:
        return bool(np.isfinite(answer).all())
    except TypeError:
        return True


def _smaller(request: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Yield the call with one row of its arrays, then with the first few rows (and columns)."""
    arrays = [*_arrays(list(request["arguments"])), *_arrays(request["options"])]
    lengths = [len(array) for array in arrays]
    if not lengths or max(lengths) < 2 or _of_uneven_runs(list(request["arguments"])):
        return
    rows = max(set(lengths), key=lengths.count)
    if any(array.ndim == 1 and len(array) == rows < FEW for array in arrays):
        return
    square = all(array.ndim == 2 and array.shape[0] == array.shape[1] for array in arrays)
    for i in range(0 if square else min(rows, MOST_ROWS)):
        yield _cut(request, partial(_some, rows=rows, first=i, many=1))
    for many in PREFIXES:
        if many < rows:
            cut = partial(_corner, many=many) if square else partial(_some, rows=rows, many=many)
            yield _cut(request, cut)


def _of_uneven_runs(value: Any) -> bool:
    """Return whether lists hold dicts with arrays of different lengths, one for each run.

    Their rows belong to different steps: cut to a few of them, the runs may have none in common.
    """
    return len({len(arrays[0]) for arrays in map(_arrays, _listed(value)) if arrays}) > 1


def _listed(value: Any) -> Iterator[dict]:
    """Yield the dicts in a list, and those in the lists that it holds."""
    parts = value.values() if isinstance(value, dict) else value
    for part in parts:
        if isinstance(part, dict) and not isinstance(value, dict):
            yield part
        if isinstance(part, (dict, list, tuple)):
            yield from _listed(part)


def _some(array: np.ndarray, rows: int, many: int, first: int = 0) -> np.ndarray:
    """Return this many rows of an array, plus one if the array has one row more than the others."""
    more = len(array) - rows
    return array[first : first + many + more] if more in (0, 1) else array


def _corner(array: np.ndarray, many: int) -> np.ndarray:
    return array[:many, :many]


def _arrays(value: Any) -> list[np.ndarray]:
    """Return the arrays with rows in a value of plain data."""
    if isinstance(value, np.ndarray):
        return [value] if value.ndim else []
    if isinstance(value, dict):
        value = list(value.values())
    return [array for part in value for array in _arrays(part)] if isinstance(value, list) else []


def _cut(value: Any, cut: Cut) -> Any:
    """Return a value of plain data with all its arrays cut."""
    if isinstance(value, np.ndarray):
        return cut(value) if value.ndim else value
    if isinstance(value, dict):
        return {key: _cut(part, cut) for key, part in value.items()}
    return [_cut(part, cut) for part in value] if isinstance(value, (list, tuple)) else value


def _rounded(value: Any, digits: int) -> Any:
    """Return a value of plain data with its fractions rounded to this many digits."""
    if isinstance(value, float):
        return float(f"{value:.{digits}g}")
    if isinstance(value, np.ndarray) and value.dtype.kind == "f":
        texts = [f"{number:.{digits}g}" for number in value.ravel()]
        return np.array(texts, dtype=value.dtype).reshape(value.shape)
    if isinstance(value, dict):
        return {key: _rounded(part, digits) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [_rounded(part, digits) for part in value]
    return value
