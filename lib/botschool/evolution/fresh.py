"""Measure a run's best robot in fresh episodes (docs/specification.md, "Fresh episodes").

The best of many post-evaluations is a lucky one. Fresh episodes had no part in choosing the robot,
so their mean is the number to report.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from botschool.errors import BotschoolError, Option
from botschool.output import save_bytes
from botschool.terminal import readable

EPISODES = 20
"""Fresh episodes; a run with more `pepisodes` has as many as those."""

T95 = {1: 12.706, 2: 4.303, 3: 3.182, 4: 2.776}
"""Quantiles 0.975 of Student's t for few degrees of freedom."""


def half_width(values: np.ndarray) -> float:
    """Return half the 95 % interval of the mean, by Student's t; NaN for fewer than two values."""
    n = len(values)
    if n < 2:
        return math.nan
    z, v = 1.959964, n - 1
    quantile = z + (z**3 + z) / (4 * v) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * v**2)
    quantile += (3 * z**7 + 19 * z**5 + 17 * z**3 - 15 * z) / (384 * v**3)
    return T95.get(v, quantile) * float(np.std(values, ddof=1)) / math.sqrt(n)


def told(values: np.ndarray) -> str:
    """Return mean and interval as words: 57.60 ± 12.30."""
    half = half_width(values)
    spread = "" if math.isnan(half) else f" ± {readable(half)}"
    return f"{readable(float(np.mean(values)))}{spread}"


def save(path: Path, returns: np.ndarray) -> None:
    """Write the return of each episode, one a line. Raises BotschoolError."""
    save_bytes(path, "".join(f"{value!r}\n" for value in returns.tolist()).encode())


def read(path: Path) -> np.ndarray | None:
    """Return what `save` wrote, float64, shape (episodes,); None if there is no such file.

    Raises BotschoolError for a file that holds something else.
    """
    try:
        returns = np.array([float(word) for word in path.read_text("utf-8").split()])
    except FileNotFoundError:
        return None
    except (OSError, ValueError):  # not text, or no numbers
        returns = np.zeros(0)
    if not (len(returns) and np.isfinite(returns).all()):
        raise BotschoolError(
            f"{path} does not hold the returns of episodes, one a line: measure them again by ",
            Option("the run's command with --resume.", "evolve(..., resume=True)."),
        )
    return returns
