"""ErDiscrim."""

from __future__ import annotations

from math import hypot

import numpy as np

from botschool.render.scene import draws
from botschool.render.scenes.arenas import ArenaScene, Look


@draws("ErDiscrim")
class DiscrimScene(ArenaScene):
    """ErDiscrim: the cylinder, and around it the zone in which the robot is rewarded."""

    state_size, side, trail, scale_bar = 6, 400.0, 120, 100.0
    looks = (Look("robot", "blue", observations=8),)
    CYLINDER = 12.5

    @property
    def zone(self) -> float:
        """Distance of the centres below which there is a reward."""
        return self.models[0].radius + self.CYLINDER + 60.0

    def _add_objects(self, poses: list[int]) -> None:
        cylinder, near = self.pose(), self.value()
        self.add("disc", [(0.0, 0.0)], "goal", radius=self.zone, pose=cylinder, opacity=0.08)
        self.add(
            "disc", [(0.0, 0.0)], "goal",
            radius=self.zone, pose=cylinder, opacity=0.16, level=near,
        )  # fmt: skip
        self.add("disc", [(0.0, 0.0)], "object", radius=self.CYLINDER, pose=cylinder)

    def _objects(self, state: np.ndarray, reward: float) -> list[float]:
        x, y, _, cylinder_x, cylinder_y, _ = state
        near = hypot(x - cylinder_x, y - cylinder_y) < self.zone
        return [cylinder_x, cylinder_y, 0.0, float(near)]
