"""Find a small failing call: a few rows of arguments on which a submission differs from ours."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import closing, suppress
from functools import partial
from typing import Any

import numpy as np

from botschool.errors import BotschoolError
from botschool.grading.declare.checks import Wrong, came, expect_close
from botschool.grading.declare.values import pasted, show
from botschool.grading.judge.alike import distance
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
APART = 1e-4
"""Relative difference of two answers that is reported."""
Cut = Callable[[np.ndarray], np.ndarray]


def smallest_case(
    request: dict[str, Any], found: Student, ours: Callable[[], Student]
) -> tuple[str, dict[str, Any]] | None:
    """Return the text of a small call that the submission answers wrongly, and this call.

    request: a function call with arrays that was answered wrongly; with {} there is no small one.
    found: the submission, whose time does not count. ours: makes a Student of our solution.
    """
    if not request:
        return None
    with suppress(BotschoolError, Wrong, OSError), closing(ours()) as solution:
        end = solution.seconds_left - SECONDS
        for call in (*_smaller(request), request):
            told = _told(call, found, solution)
            if told or solution.seconds_left < end:
                return told
    return None  # a fault of the machine, or no time is left


def _told(call: dict[str, Any], found: Student, ours: Student) -> tuple[str, dict[str, Any]] | None:
    """Return a call as text, and as it is shown there.

    None if both agree, or one of them cannot answer.
    """
    for digits in DIGITS:
        simple = _rounded(call, digits)
        parts = simple["name"], tuple(simple["arguments"]), simple["options"]
        text = pasted(*parts, LONGEST, MOST)
        many = len(text.split()) > WORDS
        if not text or many or ours.seconds_left <= 0 or found.seconds_left <= 0:
            continue
        try:
            right, got = ours.ask(simple), found.ask(simple)
        except Wrong:
            continue
        size = right.size if isinstance(right, np.ndarray) else right != [] and right != {}
        if size and _finite(got) and _finite(right) and distance(got, right) > APART:
            return text, simple
    return None


def _finite(answer: Any) -> bool:
    """Return whether an answer holds no NaN and no infinity."""
    if isinstance(answer, dict):
        answer = list(answer.values())
    if isinstance(answer, list) and not all(isinstance(each, (int, float)) for each in answer):
        return all(map(_finite, answer))
    try:
        return bool(np.isfinite(answer).all())
    except TypeError:
        return True


def difference(said: str, got: Any, right: Any) -> str:
    """Return a sentence about the first part of two answers that differs."""
    if isinstance(got, dict) and isinstance(right, dict):
        for key in right:
            if key in got and distance(got[key], right[key]) > APART:
                return difference(f"{said}: {key}", got[key], right[key])
    if _of_parts(got) and _of_parts(right) and len(got) == len(right):
        for place, (mine, wanted) in enumerate(zip(got, right, strict=True)):
            if distance(mine, wanted) > APART:
                return difference(f"{said}[{place}]", mine, wanted)
    if _of_parts(right) and isinstance(got, list) and len(got) != len(right):
        return f"{said} has {len(got)} parts, but {len(right)} were expected."
    if not _of_parts(right) and got is not None and right is not None:
        try:
            expect_close(said, got, right, APART)
        except Wrong as error:
            return str(error)
        except (TypeError, ValueError, OverflowError):  # no numbers, or rows of different lengths
            pass
    return f"{said} {came(said)} {show(got)}, but {show(right)} was expected."


def _of_parts(answer: Any) -> bool:
    """Return whether an answer is a list with arrays, dicts or None."""
    kinds = (np.ndarray, dict, type(None))
    return isinstance(answer, list) and any(isinstance(part, kinds) for part in answer)


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
    return [each for part in value for each in _arrays(part)] if isinstance(value, list) else []


def _cut(value: Any, cut: Cut) -> Any:
    """Return a value of plain data with all its arrays cut."""
    if isinstance(value, np.ndarray):
        return cut(value) if value.ndim else value
    if isinstance(value, dict):
        return {key: _cut(each, cut) for key, each in value.items()}
    return [_cut(each, cut) for each in value] if isinstance(value, (list, tuple)) else value


def _rounded(value: Any, digits: int) -> Any:
    """Return a value of plain data with its fractions rounded to this many digits."""
    if isinstance(value, float):
        return float(f"{value:.{digits}g}")
    if isinstance(value, np.ndarray) and value.dtype.kind == "f":
        texts = [f"{each:.{digits}g}" for each in value.ravel()]
        return np.array(texts, dtype=value.dtype).reshape(value.shape)
    if isinstance(value, dict):
        return {key: _rounded(each, digits) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_rounded(each, digits) for each in value]
    return value
