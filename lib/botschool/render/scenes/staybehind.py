"""ErStaybehind."""

from __future__ import annotations

from math import radians

import numpy as np

from botschool.render.scene import draws
from botschool.render.scenes.arenas import ArenaScene, Look
from botschool.render.shapes import ring

NEAR, FAR = 340.0, 600.0
"""Distances of the centres between which the leader has to be."""


@draws("ErStaybehind")
class StaybehindScene(ArenaScene):
    """ErStaybehind: a red disc and the word "blocked" mark a robot that is blocked.

    The piece of a ring before the follower is where the leader has to be; it is green in a step
    that is rewarded. The floor darkens away from the centre, as the ground sensors read it.
    """

    state_size, side, trail, scale_bar = 9, 3000.0, 80, 500.0
    looks = (
        Look("follower", "orange", 32, camera=True),
        Look("leader", "blue", 32, camera=True),
    )
    robots = ("follower", "leader")

    def _add_ground(self) -> None:
        self._add_gradient()

    def _add_objects(self, poses: list[int]) -> None:
        place = ring(radians(-45), radians(45), NEAR, FAR)
        self.add("polygon", place, "muted", pose=poses[0], opacity=0.12)
        self.add("polygon", place, "goal", pose=poses[0], opacity=0.45, level=self.value())
        for pose in poses:
            blocked, where = self.value(), self.pose()
            self.add(
                "disc", [(0.0, 0.0)], "force", radius=190.0, pose=pose, opacity=0.45, level=blocked
            )
            self.add("text", [(0.0, 0.0)], "force", pose=where, level=blocked, text="blocked")

    def _numbers(self, state, action, observation, reward) -> list[float]:
        action = np.concatenate([wheels(*pair) for pair in action.reshape(-1, 2)] or [action])
        return super()._numbers(state, action, observation, reward)

    def _objects(self, state: np.ndarray, reward: float) -> list[float]:
        numbers = [float(reward > 0)]
        for robot in range(2):
            x, y = state[3 * robot : 3 * robot + 2]
            numbers += [state[6 + robot], x, y + 260.0, 0.0]
        return numbers


def wheels(speed: float, turn: float) -> np.ndarray:
    """Shares of the greatest speed of the left and the right wheel that a robot's action means."""
    forward, turn = (speed + 1) / 2, (turn + 1) / 2
    slower = forward * (1 - 2 * abs(turn - 0.5))
    return np.array([slower, forward] if turn < 0.5 else [forward, slower])
