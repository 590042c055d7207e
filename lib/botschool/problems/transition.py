"""Describe one step of an episode that is being played."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass
class Transition:
    """One step of an episode, as `Problem.play` yields it."""

    step: int
    """Steps done so far, from 1."""
    reward: float
    total: float
    """Return so far, including this step's reward."""
    observation: np.ndarray
    """Shape (observations,): what the policy saw before this step's action."""
    action: np.ndarray
    """Shape (outputs,), or one index for a discrete problem."""
    activations: np.ndarray
    """Shape (neurons,): inputs, hidden, outputs after this step's update."""
    state: np.ndarray | None = None
    """The native problem's state after the step, else None."""
    frame: np.ndarray | None = None
    """The environment's own picture after the step, (height, width, 3) uint8, on request."""
    totals: tuple[float, ...] = ()
    """For two sides with returns of their own: the return of each so far. `reward` and `total` are
    the first side's; all other values hold the first side's, then the second's.
    """
