"""Acrobot-v1."""

from __future__ import annotations

from math import cos, sin

import numpy as np

from botschool.render.scene import Scene, draws
from botschool.render.shapes import bent_arrow


@draws("Acrobot-v1")
class AcrobotScene(Scene):
    """Two links that hang, the height to reach, and the torque at the elbow as a bent arrow."""

    state_size, fps, scale = 4, 15.0, 90.0
    view = (-2.4, -2.3, 2.4, 2.3)

    def __init__(self, robots: tuple = ()) -> None:
        super().__init__()
        self.add("line", [(-2.4, 1.0), (2.4, 1.0)], "goal", radius=0.012)
        upper, lower = self.pose(), self.pose()
        for link, colour in ((upper, "short pole"), (lower, "pole")):
            self.add("line", [(0.0, 0.0), (0.0, -1.0)], colour, radius=0.09, pose=link)
            self.add("disc", [(0.0, -1.0)], colour, radius=0.09, pose=link)
            self.add("disc", [(0.0, 0.0)], colour, radius=0.09, pose=link)
            self.add("disc", [(0.0, 0.0)], "axle", radius=0.06, pose=link)
        turn = self.pose()
        self.add("polygon", bent_arrow(0.3, 0.17), "force", pose=turn, size=self.value())

    def _numbers(self, state, action, observation, reward) -> list[float]:
        first, second = float(state[0]), float(state[1])
        elbow = (sin(first), -cos(first))
        torque = float(np.clip(action[0] - 1.0, -1.0, 1.0)) if len(action) else 0.0
        return [0.0, 0.0, first, *elbow, first + second, *elbow, 0.0, torque]
