"""Pendulum-v1."""

from __future__ import annotations

import numpy as np

from botschool.render.scene import Scene, draws
from botschool.render.shapes import bent_arrow


@draws("Pendulum-v1")
class PendulumScene(Scene):
    """The pendulum, with the torque as a bent arrow."""

    state_size, fps, scale = 2, 20.0, 160.0
    view = (-1.25, -1.25, 1.25, 1.25)
    TORQUE = 2.0

    def __init__(self, robots: tuple = ()) -> None:
        super().__init__()
        self.add("line", [(0.0, 1.06), (0.0, 1.16)], "muted", radius=0.01)
        pole = self.pose()
        self.add("line", [(0.0, 0.0), (0.0, 1.0)], "pole", radius=0.08, pose=pole)
        self.add("disc", [(0.0, 0.0)], "pole", radius=0.08, pose=pole)
        self.add("disc", [(0.0, 1.0)], "pole", radius=0.08, pose=pole)
        self.add("disc", [(0.0, 0.0)], "ink", radius=0.035)
        self.add("polygon", bent_arrow(0.34, 0.2), "force", size=self.value())

    def _numbers(self, state, action, observation, reward) -> list[float]:
        torque = float(np.clip(action[0] / self.TORQUE, -1.0, 1.0)) if len(action) else 0.0
        return [0.0, 0.0, float(state[0]), torque]
