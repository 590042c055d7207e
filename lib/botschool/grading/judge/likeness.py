"""Find the known mistakes whose text is most like a submission's: they are tried first."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from itertools import pairwise

_TOKEN = re.compile(r"\w+|[^\w\s]+")
Pairs = Counter[tuple[str, str]]


def likest(made: Iterable[tuple[str, str]], solution: str, text: str) -> list[tuple[str, str]]:
    """Return (sentence, text of a wrong solution), the one most like the submission first.

    Pairs of neighbouring words count: of those that a mistake adds to our solution, or takes away,
    the share that the submission adds or takes away as well. Equals stay in order.
    """
    theirs = _changed(solution, text)

    def likeness(mistake: tuple[str, str]) -> float:
        own = _changed(solution, mistake[1])
        shared = sum((one & other).total() for one, other in zip(own, theirs, strict=True))
        return shared / (sum(each.total() for each in own) or 1)

    return sorted(made, key=likeness, reverse=True)


def _changed(solution: str, text: str) -> tuple[Pairs, Pairs]:
    """Return the pairs that a text adds to our solution, and those that it lacks."""
    ours, other = Counter(solution.splitlines()), Counter(text.splitlines())
    more, fewer = _pairs(other - ours), _pairs(ours - other)
    return more - fewer, fewer - more


def _pairs(lines: Counter[str]) -> Pairs:
    return Counter(pair for line in lines.elements() for pair in pairwise(_TOKEN.findall(line)))
