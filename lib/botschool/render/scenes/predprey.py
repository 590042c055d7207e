"""ErPredprey."""

from __future__ import annotations

import numpy as np

from botschool.render.scene import draws
from botschool.render.scenes.arenas import ArenaScene, Look


@draws("ErPredprey")
class PredpreyScene(ArenaScene):
    """ErPredprey: the floor darkens away from the centre, as the ground sensors read it.

    A ring marks where the predator caught the prey, which a reward other than 0 tells; then they
    touch.
    """

    state_size, side, trail, scale_bar = 7, 3000.0, 80, 500.0
    looks = (Look("predator", "orange", 24, camera=True), Look("prey", "blue", 24, camera=True))
    robots = ("predator", "prey")

    def _add_ground(self) -> None:
        self._add_gradient()

    def _add_objects(self, poses: list[int]) -> None:
        self._caught, caught = self.pose(), self.value()
        for radius, opacity in ((330.0, 0.18), (250.0, 0.25)):
            self.add(
                "disc", [(0.0, 0.0)], "force",
                radius=radius, pose=self._caught, opacity=opacity, level=caught,
            )  # fmt: skip

    def _numbers(self, state, action, observation, reward) -> list[float]:
        if reward:
            state = state.copy()
            state[:2] = touching(state[:2], state[3:5], sum(model.radius for model in self.models))
        return super()._numbers(state, action, observation, reward)

    def _objects(self, state: np.ndarray, reward: float) -> list[float]:
        x, y = (state[0] + state[3]) / 2, (state[1] + state[4]) / 2
        return [x, y, 0.0, float(reward != 0.0)]


def touching(predator: np.ndarray, prey: np.ndarray, apart: float) -> np.ndarray:
    """Where a predator that has caught the prey is drawn, x and y: led up to it.

    The arena does not carry out a move that ends in a collision, so the last poses leave a gap.
    apart: distance of the centres of robots that touch.
    """
    away = predator - prey
    return prey + away * (apart / np.linalg.norm(away))
