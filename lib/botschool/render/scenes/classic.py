"""Draw classic control: cart-poles, Pendulum, Acrobot and MountainCarContinuous."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, cos, sin

import numpy as np

from botschool.render.scene import Scene, draws
from botschool.render.shapes import arrow, bent_arrow, rectangle

# --- Carts with poles: CartPole-v1, envSwingupCustom and ErDpole.


@dataclass(frozen=True)
class Pole:
    """A pole on a cart."""

    angle: int
    """Index of its angle in the state (radians, 0 upright)."""
    length: float
    """Metres."""
    colour: str = "pole"
    clockwise: bool = True
    """Whether the angle grows as the pole leans to the right."""


class CartScene(Scene):
    """A cart with poles on a track of +-2.4 m, with the force on it as an arrow.

    The state starts with the cart's position. The force is full at an action of +-1; a discrete
    action always has full force: 0 to the left, 1 to the right.
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
    """Return the scene of a pole to keep upright."""
    return CartScene(
        [Pole(angle=2, length=1.0)], state_size=4, track_y=300, fps=50.0, discrete=True
    )


@draws("envSwingupCustom")
def swingup(robots: tuple) -> Scene:
    """Return the scene of a pole to swing up."""
    poles = [Pole(angle=2, length=0.6, clockwise=False)]
    return CartScene(poles, state_size=4, track_y=200, fps=100.0)


@draws("ErDpole")
def double_pole(robots: tuple) -> Scene:
    """Return the scene of two poles to keep upright."""
    poles = [Pole(angle=2, length=1.0), Pole(angle=4, length=0.5, colour="short pole")]
    return CartScene(poles, state_size=6, track_y=300, fps=50.0)


# --- Pendulum-v1.


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


# --- Acrobot-v1.


@draws("Acrobot-v1")
class AcrobotScene(Scene):
    """Two hanging links, the height to reach, and the torque at the elbow as a bent arrow."""

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


# --- MountainCarContinuous-v0.


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
