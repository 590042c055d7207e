"""Read the answers of workers: any bytes become a known answer or a ValueError."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from botschool.cluster import wire

SHAPES: dict[str, dict[str, Any]] = {
    "sentence": {"sentence": str},
    "failure": {"failure": str},
    "lacks": {"lacks": list},
    "version": {"version": str, "threads": int, "bits": bytes, "differs": list},
    "fitness": {
        "fitness": np.ndarray,
        "steps": np.ndarray,
        "moments": (np.ndarray, type(None)),
        "seconds": float,
    },
}
"""Kinds of answers by their first field, and the type of each field."""


def read(data: bytes, kinds: Sequence[str] = tuple(SHAPES)) -> dict[str, Any]:
    """Return an answer of one of these kinds, after checking its fields and values.

    Raises ValueError for anything else.
    """
    answer = wire.unpack(data)
    kind = next((name for name in kinds if isinstance(answer, dict) and name in answer), None)
    if kind is None:
        raise ValueError("the answer is of no known kind")
    for name, types in SHAPES[kind].items():
        if name not in answer or not isinstance(answer[name], types):
            raise ValueError(f"the answer's {name} is missing, or of another type")
    if not all(CHECKS[kind](answer)):
        raise ValueError(f"the answer's values are impossible: {kind}")
    return answer


def _outcome(answer: dict[str, Any]) -> list[bool]:
    fitness, steps, moments = (answer[name] for name in ("fitness", "steps", "moments"))
    return [
        fitness.dtype == np.float64 and fitness.ndim in (1, 2),
        steps.dtype == np.int32 and steps.ndim == 1 and bool((steps >= 0).all()),
        moments is None or (moments.dtype == np.float64 and moments.ndim == 2),
        math.isfinite(answer["seconds"]) and answer["seconds"] >= 0,
    ]


CHECKS = {
    "sentence": lambda answer: [],
    "failure": lambda answer: [],
    "lacks": lambda answer: [answer["lacks"], all(isinstance(n, bytes) for n in answer["lacks"])],
    "version": lambda answer: [
        answer["threads"] > 0,
        all(isinstance(name, str) for name in answer["differs"]),
    ],
    "fitness": _outcome,
}
"""Conditions on the values of each kind."""
