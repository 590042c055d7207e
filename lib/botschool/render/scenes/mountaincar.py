"""MountainCarContinuous-v0."""

from __future__ import annotations

from math import atan, cos, sin

import numpy as np

from botschool.render.scene import Scene, draws
from botschool.render.shapes import arrow, rectangle


@draws("MountainCarContinuous-v0")
class MountainCarScene(Scene):
    """A car between two hills, its engine's force as an arrow, and the flag to reach."""

    state_size, fps, scale = 2, 30.0, 310.0
    LEFT, RIGHT, GOAL = -1.2, 0.6, 0.45
    view = (-1.25, -0.1, 0.68, 1.25)

    def __init__(self, robots: tuple = ()) -> None:
        super().__init__()
        left, bottom, right, _ = self.view
        hills = [(x, self._height(x)) for x in np.linspace(left, right, 80)]
        self.add("polygon", [(left, bottom), *hills, (right, bottom)], "ground")
        self.add("line", hills, "muted", radius=0.004)
        top = self._height(self.GOAL)
        self.add("line", [(self.GOAL, top), (self.GOAL, top + 0.2)], "ink", radius=0.004)
        flag = [(self.GOAL, top + 0.2), (self.GOAL, top + 0.12), (self.GOAL + 0.1, top + 0.16)]
        self.add("polygon", flag, "goal")
        car = self.pose()
        self.add("polygon", rectangle(-0.06, 0.025, 0.06, 0.065), "ink", pose=car)
        self.add("polygon", rectangle(-0.03, 0.06, 0.035, 0.095), "ink", pose=car)
        for x in (-0.035, 0.035):
            self.add("disc", [(x, 0.022)], "muted", radius=0.02, pose=car)
        push = arrow(0.2, 0.05)
        self.add("polygon", push, "force", at=(0.0, 0.13), pose=car, size=self.value())

    @staticmethod
    def _height(x: float) -> float:
        return 0.55 + 0.45 * sin(3 * x)

    def _numbers(self, state, action, observation, reward) -> list[float]:
        x = float(np.clip(state[0], self.LEFT, self.RIGHT))
        force = float(np.clip(action[0], -1.0, 1.0)) if len(action) else 0.0
        return [x, self._height(x), atan(1.35 * cos(3 * x)), force]
