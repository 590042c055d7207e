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
