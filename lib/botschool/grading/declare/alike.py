"""Compare answers to a call: the submission's, ours, and that of a known mistake."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from botschool.grading.declare.checks import cuts_fractions
from botschool.sandbox.protocol import unpack

MAX_LEAVES = 20_000
"""Largest number of arrays, numbers and texts to compare in an answer."""
TIE, TINY, SINGLE = 1e-6, 1e-9, 1e-5
"""Relative differences: TIE covers rounding in single precision, TINY in double precision, SINGLE
what `expect_close` allows in single precision."""
INPUTS = 2
"""Smallest number of different calls that must point to a mistake."""
LONG = 0.125
"""Processor seconds of a call on which no mistakes are tried if there is a quicker one."""
SHARE = 1e-2
"""Equal answers differ by less than this share of their difference from ours."""


def distance(one: Any, other: Any) -> float:
    """Return the largest relative difference of two answers; infinity if their structure differs.

    A list of numbers counts as an array, a whole number as a number.
    """
    first, second = _leaves(one), _leaves(other)
    if first is None or second is None or len(first) != len(second):
        return math.inf
    return max((_apart(a, b) for a, b in zip(first, second, strict=True)), default=0.0)


def fits(got: Any, other: Any, ours: Any) -> bool:
    """Return whether `other` equals `got` to rounding, unless both are nearly `ours`.

    An array that cannot hold the fractions of ours equals only another one that cannot. In single
    precision, differences of large numbers have larger rounding errors.
    """
    if cuts_fractions(got, ours) != cuts_fractions(other, ours):
        return False
    error, effect = distance(got, other), distance(got, ours)
    tie = SINGLE if _in_single(got) else TIE
    return error <= tie and (effect <= tie or error <= SHARE * effect)


def _in_single(answer: Any) -> bool:
    """Return whether all numbers of an answer fit into single precision, and some have fractions.

    A correct answer in it may be this far from ours.
    """
    leaves = [leaf for _, leaf in _leaves(answer) or [] if isinstance(leaf, np.ndarray)]
    with np.errstate(over="ignore", invalid="ignore"):
        single = all((leaf.astype(np.float32) == leaf).all() for leaf in leaves)
        return single and any((leaf % 1).any() for leaf in leaves)


def weight(got: Any, other: Any, ours: Any) -> float:
    """Return how much proof a fit of `other` to `got` is: 1, 1/2 for a yes or no, or 0."""
    effect = distance(got, ours)
    if effect <= TINY or distance(got, other) > SHARE * effect:
        return 0.0
    parts = [*(_leaves(got) or []), *(_leaves(ours) or [])]
    leaves = [leaf for _, leaf in parts if isinstance(leaf, np.ndarray)]
    many = sum(leaf.size for leaf in leaves)
    choices = many < 16 and all(np.isin(leaf, (0, 1)).all() for leaf in leaves)
    return 0.5 if choices else 1.0


def _leaves(value: Any) -> list[tuple[str, Any]] | None:
    """Return (place, an array or another value) of all parts; None if there are many."""
    leaves: list[tuple[str, Any]] = []
    waiting = [("", value)]
    while waiting:
        if len(leaves) + len(waiting) > MAX_LEAVES:
            return None
        place, part = waiting.pop()
        if isinstance(part, dict):
            waiting += [(f"{place}.{key}", part[key]) for key in sorted(part)]
        elif isinstance(part, (bool, int, float, np.ndarray)):
            leaves.append((place, _numbers(part)))
        elif isinstance(part, (list, tuple)):
            if part and all(isinstance(number, (bool, int, float)) for number in part):
                leaves.append((place, _numbers(part)))
            elif (table := _table(part)) is not None:
                leaves.append((place, table))
            else:
                waiting += [(f"{place}[{i}]", inner) for i, inner in enumerate(part)]
        else:
            leaves.append((place, part))
    return leaves


def _numbers(value: Any) -> np.ndarray | str:
    try:
        return np.asarray(value).astype(np.float64)
    except (OverflowError, ValueError, TypeError):
        return repr(type(value))


def _table(value: Any) -> np.ndarray | None:
    """Return a list of equally long lists or arrays as an array; None for anything else."""
    if not value or not all(isinstance(row, (list, tuple, np.ndarray)) for row in value):
        return None
    try:
        array = np.asarray(value)
    except (ValueError, TypeError, OverflowError):
        return None
    return array.astype(np.float64) if array.dtype.kind in "biuf" else None


def _apart(one: tuple[str, Any], other: tuple[str, Any]) -> float:
    """Return the relative difference of two leaves."""
    (place, a), (where, b) = one, other
    if place != where or isinstance(a, np.ndarray) != isinstance(b, np.ndarray):
        return math.inf
    if not isinstance(a, np.ndarray):
        return 0.0 if type(a) is type(b) and a == b else math.inf
    if a.shape != b.shape:
        return math.inf
    finite = np.isfinite(a)
    odd = ~finite
    if not np.array_equal(finite, np.isfinite(b)) or not np.array_equal(
        a[odd], b[odd], equal_nan=True
    ):
        return math.inf
    if not finite.any():
        return 0.0
    with np.errstate(over="ignore", invalid="ignore"):
        largest = float(np.abs(a[finite] - b[finite]).max())
        scale = float(max(np.abs(a[finite]).max(), np.abs(b[finite]).max()))
    return largest / scale if scale else 0.0


@dataclass
class Call:
    """A request, and the answers of our solution and of the submission."""

    request: bytes
    ours: Any
    check: Callable[[Any], None] | None = None
    seconds: float = 0.0
    """Processor seconds that our solution took."""
    got: Any = None
    took: float = 0.0
    """Processor seconds that the submission took."""
    equal: Callable[[Any, Any], bool] | None = None
    """Whether two answers are the same to the grader, if it looks at parts of them only."""

    @cached_property
    def wrong(self) -> bool:
        """Whether the submission's answer, which must be known, differs from ours."""
        return not self.right(self.got)

    def right(self, answer: Any) -> bool:
        """Return whether an answer equals ours."""
        if self.equal is not None and not raised(answer):
            return self.equal(answer, self.ours)
        return distance(answer, self.ours) <= TIE

    def agrees(self, answer: Any) -> bool:
        """Return whether an answer is the submission's; any wrong one is as good as an exception.

        Two exceptions must be equal.
        """
        if raised(self.got):
            return answer == self.got if raised(answer) else not self.right(answer)
        if self.equal is not None:
            return not raised(answer) and self.equal(self.got, answer)
        return fits(self.got, answer, self.ours)

    def proof(self, answer: Any) -> float:
        """Return how much proof an answer that agrees is."""
        if raised(self.got) and not (raised(answer) and answer == self.got):
            return 0.0
        if self.equal is not None and not raised(self.got):
            return float(self.wrong)
        return weight(self.got, answer, self.ours)

    def numbers(self) -> tuple[np.ndarray, np.ndarray, list[Any], str] | None:
        """Return the submission's answer, ours, the arguments, and the name of a part or "".

        Of two dicts it is the first part that differs. None if these are no numbers or arrays.
        """
        given, pair, name = unpack(self.request), (self.got, self.ours), ""
        if self.equal is None and isinstance(self.ours, dict) and isinstance(self.got, dict):
            both = ((key, (self.got.get(key), value)) for key, value in self.ours.items())
            apart = ((key, two) for key, two in both if distance(*two) > TIE)
            name, pair = next(apart, ("", pair))
        if not all(isinstance(value, (int, float, np.ndarray, list)) for value in pair):
            return None
        got, wanted = (_as_array(value) for value in pair)
        if got is None or wanted is None:
            return None
        return got, wanted, [*given["arguments"]], name


def _as_array(value: Any) -> np.ndarray | None:
    """Return a number, a list of numbers or an array as an array, or None."""
    try:
        array = np.asarray(value)
    except ValueError:  # of lists of different lengths
        return None
    return array if array.dtype.kind in "biuf" else None


def raised(answer: Any) -> bool:
    """Return whether an answer stands for an exception."""
    return isinstance(answer, dict) and answer.keys() == {"raised", "text"}


def proves(calls: list[Call], answers: list[Any]) -> bool:
    """Return whether answers that fit the submission's prove a mistake, on enough inputs.

    Exceptions alone are half as much proof, because many mistakes raise them.
    """
    proof: dict[bytes, float] = {}
    for call, answer in zip(calls, answers, strict=True):
        if call.agrees(answer):
            proof[call.request] = max(proof.get(call.request, 0.0), call.proof(answer))
    failing = {call.request for call in calls if raised(call.got)}
    only = not any(much for request, much in proof.items() if request not in failing)
    return sum(proof.values()) / (2 if only else 1) >= INPUTS


def telling_call(calls: list[Call]) -> Call:
    """Return the call with the shortest request among those whose answers are wrong.

    An exception comes after other wrong answers, because many mistakes raise it. So does a call
    that takes our solution long: mistakes would run out of time.
    """
    return min(
        calls,
        key=lambda c: (
            not c.wrong,
            c.equal is None and distance(c.got, c.ours) <= SINGLE,  # perhaps by rounding
            raised(c.got),
            max(c.seconds, c.took) > LONG,
            len(c.request),
        ),
    )
