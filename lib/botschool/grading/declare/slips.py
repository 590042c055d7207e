"""Compute what slips make of an answer, for the `mistakes` of a check."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from itertools import combinations
from typing import Any

import numpy as np


def slips(make: Callable[..., Any], most: int = 2, **parts: dict[str, Any]) -> dict[str, Any]:
    """Return sentence -> answer for one slip in the parts of an answer, then for two slips.

    make: returns the answer for a value of each part. parts: {"": the right value, sentence: the
    value with this slip, ...} for each. most: 1 leaves pairs out. Two slips have both sentences.
    An answer that `make` cannot compute (ValueError) is left out.
    """
    right = {name: values[""] for name, values in parts.items()}
    single = [(name, text) for name, values in parts.items() for text in values if text]
    found: dict[str, Any] = {}
    with np.errstate(all="ignore"):
        for many in range(1, most + 1):
            for chosen in combinations(single, many):
                wrong = {name: parts[name][text] for name, text in chosen}
                if len(wrong) < many:
                    continue
                text = " ".join(text for _, text in chosen)
                with suppress(ValueError):  # two slips may not fit together
                    found.setdefault(text, make(**{**right, **wrong}))
    return found


def spoiled(
    table: dict[str, Any], right: Any, changed: dict[str, Any] | None = None
) -> dict[str, Any]:
    """Return a table of slips, and what spoils a right answer at its end or its beginning.

    changed: sentence -> the answer to changed arguments. Pairs of slips come last.
    """
    answer = np.asarray(right, dtype=np.float64)
    with np.errstate(all="ignore"):
        found = {
            f"The answer is rounded to {k} place{'s' * (k > 1)}.": answer.round(k)
            for k in (1, 2, 3, 4)
        } | {
            "The answer is divided by pi.": answer / np.pi,
            "The answer is multiplied by pi.": answer * np.pi,
            "The answer is divided by 2 pi.": answer / (2 * np.pi),
        }  # fmt: skip
        if answer.ndim and len(answer) > 2:
            mean = answer.mean(axis=0)
            found |= {
                "The answer stands in the opposite order.": answer[::-1],
                "The answer is sorted.": np.sort(answer, axis=0),
                "The answer is divided by its sum.": answer / answer.sum(axis=0),
                "The answer is divided by its largest value.": answer / answer.max(axis=0),
                "The mean of the answer is subtracted from it.": answer - mean,
                "All values are the mean of the answer.": 0 * answer + mean,
                "All values are the first one of the answer.": 0 * answer + answer[0],
                "The first value of the answer is 0.":
                np.append(0 * answer[:1], answer[1:], axis=0),
                "The last value of the answer is 0.":
                np.append(answer[:-1], 0 * answer[:1], axis=0),
                "Each value stands one place too late; the last one comes first.":
                np.roll(answer, 1, axis=0),
                "Each value stands one place too early; the first one comes last.":
                np.roll(answer, -1, axis=0),
            }  # fmt: skip
    single = {text: made for text, made in table.items() if ". " not in text}
    return single | (changed or {}) | found | table
