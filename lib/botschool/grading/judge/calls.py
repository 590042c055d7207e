"""Hold a call beside three answers: the submission's, ours, and that of a mistake."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from botschool.grading.judge.alike import TIE, distance, fits, weight
from botschool.grading.run.student import Student
from botschool.sandbox.protocol import unpack

STRICT, LOOSE, LOOSEST = 0, 1, 2
"""How well a mistake must explain a call: with LOOSE it may also leave the answer right; with
LOOSEST it may also be wrong in another way where the answer is wrong.
"""
Check = Callable[[Student], None]


@dataclass
class Call:
    """A request, and the answers of our solution and of the submission."""

    request: bytes
    ours: Any
    seconds: float = 0.0
    """Processor seconds that our solution took."""
    got: Any = None
    took: float = 0.0
    """Processor seconds that the submission took."""
    equal: Callable[[Any, Any], bool] | None = None
    """Whether two answers are the same to the grader, if it looks at parts of them only."""

    check: Check | None = None
    loose: int = STRICT
    """Whether another mistake may have changed this answer, too: one of STRICT, LOOSE, LOOSEST."""

    @cached_property
    def wrong(self) -> bool:
        """Whether the submission's answer, which must be known, differs from ours."""
        return self._is_wrong(self.got)

    def _is_wrong(self, answer: Any) -> bool:
        if self.equal is not None and not raised(answer):
            return not self.equal(answer, self.ours)
        return distance(answer, self.ours) > TIE

    def agrees(self, made: Any) -> bool:
        """Return whether an answer equals the submission's; any wrong one equals an exception."""
        if self.loose and distance(made, self.ours) <= TIE:
            return True
        if self.loose == LOOSEST and self.wrong and self._is_wrong(made):
            return True
        if raised(self.got):
            return made == self.got if raised(made) else distance(made, self.ours) > TIE
        if self.equal is not None:
            return not raised(made) and self.equal(self.got, made)
        return fits(self.got, made, self.ours)

    def proof(self, made: Any) -> float:
        """Return how much proof an answer that agrees is."""
        unlike = raised(self.got) and not (raised(made) and made == self.got)
        if self.loose or unlike:
            return 0.0
        if self.equal is not None and not raised(self.got):
            return float(self.wrong)
        return weight(self.got, made, self.ours)

    def numbers(self) -> tuple[np.ndarray, np.ndarray, list[Any], str] | None:
        """Return the submission's answer, ours, the arguments, and the name of a part or "".

        Of two dicts it is the first part that differs. None if these are no numbers or arrays.
        """
        given, pair, name = unpack(self.request), (self.got, self.ours), ""
        if "driver" in given:
            return None
        if self.equal is None and isinstance(self.ours, dict) and isinstance(self.got, dict):
            both = ((key, (self.got.get(key), value)) for key, value in self.ours.items())
            apart = ((key, two) for key, two in both if distance(*two) > TIE)
            name, pair = next(apart, ("", pair))
        if not all(isinstance(each, (int, float, np.ndarray, list)) for each in pair):
            return None
        got, wanted = (_as_array(each) for each in pair)
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
