"""Frames of the native problems, drawn from their states."""

from __future__ import annotations

import warnings
from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from math import cos, sin
from typing import TYPE_CHECKING

import numpy as np

from botschool.errors import BotschoolError
from botschool.render.canvas import BLACK, GREY, blank, disc, draw_offscreen, polygon, to_frame

if TYPE_CHECKING:
    import pygame

AXLE = (129, 132, 203)
POLE = (202, 152, 101)
SHORT_POLE = (86, 158, 140)
FORCE = (204, 77, 77)


class Scene(ABC):
    """Draws the states of one problem."""

    fps: float
    """Frames a second: the speed at which a film looks right."""
    state_size: int

    def draw(self, state: np.ndarray, action: np.ndarray | float | None = None) -> np.ndarray:
        """The frame of a state, (height, width, 3) uint8.

        `state` is the native problem's, (state_size,); `action` the one that led to it, where it
        can be seen. Raises BotschoolError if a number is not finite, ValueError if the size is
        wrong.
        """
        state = np.asarray(state, dtype=np.float64)
        if state.shape != (self.state_size,):
            raise ValueError(f"a state of shape {state.shape} where ({self.state_size},) is drawn")
        if not np.isfinite(state).all():
            raise BotschoolError(
                f"the state {state.tolist()} cannot be drawn: it holds numbers that are not finite."
            )
        first = None if action is None else float(np.ravel(action)[0])
        draw_offscreen()
        return self._draw(state, first if first is not None and np.isfinite(first) else None)

    @abstractmethod
    def _draw(self, state: np.ndarray, action: float | None) -> np.ndarray:
        """As `draw`; `action` is the first number of the action, or None."""


class GymnasiumScene(Scene):
    """Gymnasium's own pictures of a classic-control environment."""

    def __init__(self, env_id: str, state_size: int) -> None:
        import gymnasium

        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            env = gymnasium.make(env_id, render_mode="rgb_array")
        self.state_size = state_size
        self.fps = float(env.metadata["render_fps"])
        self._env = env.unwrapped
        self._env.reset(seed=0)

    def _draw(self, state: np.ndarray, action: float | None) -> np.ndarray:
        self._env.state = state.copy()
        self._show_action(action)
        return np.array(self._env.render())

    def _show_action(self, action: float | None) -> None:
        """Most pictures show no action."""


class PendulumScene(GymnasiumScene):
    """The pendulum, with the torque as a bent arrow."""

    def _show_action(self, action: float | None) -> None:
        limit = self._env.max_torque
        self._env.last_u = None if action is None else float(np.clip(action, -limit, limit))


@dataclass(frozen=True)
class Pole:
    """A pole on a cart."""

    angle: int
    """Where in the state its angle is (radians, 0 upright)."""
    length: float
    """Metres."""
    colour: tuple[int, int, int]
    clockwise: bool = True
    """Whether the angle grows as the pole leans to the right."""


class CartScene(Scene):
    """A cart with poles on a track of +-2.4 m, and the force that pushes it as an arrow.

    The state starts with the cart's position; the force is full at an action of +-1.
    """

    WIDTH, HEIGHT = 600, 400
    SCALE = 110.0
    """Pixels a metre."""
    TRACK_END = 2.4
    CART = (50, 30)
    POLE_WIDTH = 10
    ARROW = 60.0

    def __init__(self, poles: list[Pole], state_size: int, track_y: int, fps: float) -> None:
        self.poles = poles
        self.state_size = state_size
        self.fps = fps
        self._track_y = track_y

    def _draw(self, state: np.ndarray, action: float | None) -> np.ndarray:
        surface = blank(self.WIDTH, self.HEIGHT)
        cart_x = self.WIDTH / 2 + self.SCALE * float(np.clip(state[0], -3.0, 3.0))
        self._draw_track(surface)
        self._draw_cart(surface, cart_x)
        axle = (cart_x, self._track_y - self.CART[1] / 4)
        for pole in self.poles:
            self._draw_pole(surface, axle, pole, state[pole.angle])
        disc(surface, axle, self.POLE_WIDTH / 2, AXLE)
        if action is not None:
            self._draw_force(surface, cart_x, float(np.clip(action, -1.0, 1.0)))
        return to_frame(surface)

    def _draw_track(self, surface: pygame.Surface) -> None:
        y, end = self._track_y, self.SCALE * self.TRACK_END
        surface.fill(BLACK, (0, y, self.WIDTH, 1))
        for x in (self.WIDTH / 2 - end, self.WIDTH / 2 + end):
            surface.fill(GREY, (round(x) - 1, y - 12, 3, 25))

    def _draw_cart(self, surface: pygame.Surface, x: float) -> None:
        width, height = self.CART
        surface.fill(BLACK, (round(x - width / 2), self._track_y - height // 2, width, height))

    def _draw_pole(
        self, surface: pygame.Surface, axle: tuple[float, float], pole: Pole, angle: float
    ) -> None:
        if not pole.clockwise:
            angle = -angle
        along, across = (sin(angle), -cos(angle)), (cos(angle), sin(angle))
        half = self.POLE_WIDTH / 2
        ends = (-half, self.SCALE * pole.length)
        corners = [(ends[0], -half), (ends[0], half), (ends[1], half), (ends[1], -half)]
        points = [
            (axle[0] + a * along[0] + b * across[0], axle[1] + a * along[1] + b * across[1])
            for a, b in corners
        ]
        polygon(surface, points, pole.colour)

    def _draw_force(self, surface: pygame.Surface, cart_x: float, force: float) -> None:
        length = self.ARROW * abs(force)
        if length < 1.0:
            return
        side = 1.0 if force > 0 else -1.0
        tail = cart_x + side * (self.CART[0] / 2 + 3)
        head, tip = tail + side * max(length - 12.0, 0.0), tail + side * length
        y = self._track_y
        shaft = [(tail, y - 3), (head, y - 3), (head, y + 3), (tail, y + 3)]
        polygon(surface, shaft, FORCE)
        half = min(9.0, 0.75 * length)
        polygon(surface, [(head, y - half), (tip, y), (head, y + half)], FORCE)


def _swingup() -> Scene:
    poles = [Pole(angle=2, length=0.6, colour=POLE, clockwise=False)]
    return CartScene(poles, state_size=4, track_y=200, fps=100.0)


def _double_pole() -> Scene:
    poles = [Pole(angle=2, length=1.0, colour=POLE), Pole(angle=4, length=0.5, colour=SHORT_POLE)]
    return CartScene(poles, state_size=6, track_y=300, fps=50.0)


_SCENES: dict[str, Callable[[], Scene]] = {
    "CartPole-v0": lambda: GymnasiumScene("CartPole-v1", 4),
    "CartPole-v1": lambda: GymnasiumScene("CartPole-v1", 4),
    "Pendulum-v0": lambda: PendulumScene("Pendulum-v1", 2),
    "Pendulum-v1": lambda: PendulumScene("Pendulum-v1", 2),
    "Acrobot-v1": lambda: GymnasiumScene("Acrobot-v1", 4),
    "MountainCarContinuous-v0": lambda: GymnasiumScene("MountainCarContinuous-v0", 2),
    "envSwingupCustom": _swingup,
    "ErDpole": _double_pole,
}


def make_scene(problem_name: str) -> Scene:
    """The scene of a native problem. Raises BotschoolError if there is none for the name."""
    if problem_name not in _SCENES:
        raise BotschoolError(
            f"there are no pictures of {problem_name}: those that can be drawn are "
            f"{', '.join(_SCENES)}."
        )
    return _SCENES[problem_name]()
