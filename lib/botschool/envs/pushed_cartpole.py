"""Simulate CartPole with a motor of continuous force."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.envs.classic_control import CartPoleEnv

FORCE = 10.0
"""Force of an action of 1, in newtons, as in CartPole."""


class PushedCartPole(CartPoleEnv):
    """CartPole with another action: one number from -1 (10 N to the left) to 1 (10 N to the right).

    Observation, physics, reward and end are Gymnasium's. The action is clipped to its limits.
    """

    def __init__(self, render_mode: str | None = None) -> None:
        super().__init__(render_mode=render_mode)
        self._sides: gymnasium.Space = self.action_space
        self.action_space: Any = spaces.Box(-1.0, 1.0, (1,), np.float32)

    def step(self, action: np.ndarray):
        push = float(np.clip(np.asarray(action, dtype=np.float64).reshape(1)[0], -1.0, 1.0))
        self.force_mag = FORCE * abs(push)
        ours, self.action_space = self.action_space, self._sides
        try:
            return super().step(int(push > 0))
        finally:
            self.action_space = ours
