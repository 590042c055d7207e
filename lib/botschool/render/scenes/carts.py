"""Carts with poles: CartPole-v1, envSwingupCustom and ErDpole."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from botschool.render.scene import Scene, draws
from botschool.render.shapes import arrow, rectangle


@dataclass(frozen=True)
class Pole:
    """A pole on a cart."""

    angle: int
    """Where in the state its angle is (radians, 0 upright)."""
    length: float
    """Metres."""
    colour: str = "pole"
    clockwise: bool = True
    """Whether the angle grows as the pole leans to the right."""


class CartScene(Scene):
    """A cart with poles on a track of +-2.4 m, and the force that pushes it as an arrow.

    The state starts with the cart's position; the force is full at an action of +-1, or with a
    discrete action always full: 0 to the left, 1 to the right.
    """

    scale = 110.0
    WIDTH, HEIGHT = 600, 400
    TRACK_END = 2.4
    CART = (0.45, 0.27)
    POLE_WIDTH = 0.09

    def __init__(
        self, poles: list[Pole], state_size: int, track_y: int, fps: float, discrete: bool = False
    ) -> None:
        super().__init__()
        self.poles, self.state_size, self.fps, self.discrete = poles, state_size, fps, discrete
        half = self.WIDTH / 2 / self.scale
        bottom, top = (track_y - self.HEIGHT) / self.scale, track_y / self.scale
        self.view = (-half, bottom, half, top)
        self._add_track(half)
        width, height = (side / 2 for side in self.CART)
        cart = self.pose()
        self.add("polygon", rectangle(-width, -height, width, height), "ink", pose=cart)
        half = self.POLE_WIDTH / 2
        for pole in poles:
            corners = rectangle(-half, -half, half, pole.length)
            self.add("polygon", corners, pole.colour, pose=self.pose())
        self.add("disc", [(0.0, self.CART[1] / 4)], "axle", radius=half, pose=cart)
        push = arrow(0.55, 0.16)
        for side in (1, -1):
            head = [(side * x, y) for x, y in push]
            self.add(
                "polygon", head, "force",
                at=(side * (width + 0.03), 0.0), pose=cart, size=self.value(),
            )  # fmt: skip

    def _add_track(self, half: float) -> None:
        self.add("line", [(-half, 0.0), (half, 0.0)], "ink", radius=0.005)
        for x in (-self.TRACK_END, self.TRACK_END):
            self.add("line", [(x, -0.11), (x, 0.11)], "muted", radius=0.012)

    def _numbers(self, state, action, observation, reward) -> list[float]:
        x = float(np.clip(state[0], -3.0, 3.0))
        numbers = [x, 0.0, 0.0]
        for pole in self.poles:
            angle = float(state[pole.angle])
            numbers += [x, self.CART[1] / 4, -angle if pole.clockwise else angle]
        force = float(np.clip(action[0], -1.0, 1.0)) if len(action) else 0.0
        if self.discrete and len(action):
            force = 1.0 if action[0] >= 0.5 else -1.0
        return [*numbers, max(force, 0.0), max(-force, 0.0)]


@draws("CartPole-v1")
def cartpole(robots: tuple) -> Scene:
    """A pole to be kept upright."""
    return CartScene(
        [Pole(angle=2, length=1.0)], state_size=4, track_y=300, fps=50.0, discrete=True
    )


@draws("envSwingupCustom")
def swingup(robots: tuple) -> Scene:
    """A pole to be swung up."""
    poles = [Pole(angle=2, length=0.6, clockwise=False)]
    return CartScene(poles, state_size=4, track_y=200, fps=100.0)


@draws("ErDpole")
def double_pole(robots: tuple) -> Scene:
    """Two poles to be kept upright."""
    poles = [Pole(angle=2, length=1.0), Pole(angle=4, length=0.5, colour="short pole")]
    return CartScene(poles, state_size=6, track_y=300, fps=50.0)
