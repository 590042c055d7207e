"""Find the known mistakes whose text is most like a submission's: they are tried first."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import pairwise

_TOKEN = re.compile(r"\w+|[^\w\s]+")


def likest(made: Iterable[tuple[str, str]], solution: str, text: str) -> list[tuple[str, str]]:
    """Return (sentence, text of a wrong solution), the one most like the submission first.

    Pairs of neighbouring words count: those that a mistake adds to our solution and those that it
    takes away, which the submission may share. Equals stay in order.
    """
    lines, theirs = {*solution.splitlines()}, _pairs(text.splitlines())

    def likeness(mistake: tuple[str, str]) -> float:
        wrong = {*mistake[1].splitlines()}
        more, fewer = _pairs(wrong - lines), _pairs(lines - wrong)
        added, missing = more - fewer, fewer - more
        return sum(
            len(shared) / len(whole)
            for whole, shared in ((added, added & theirs), (missing, missing - theirs))
            if whole
        )

    return sorted(made, key=likeness, reverse=True)


def _pairs(lines: Iterable[str]) -> set[tuple[str, str]]:
    return {pair for line in lines for pair in pairwise(_TOKEN.findall(line))}
