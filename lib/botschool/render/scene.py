"""The pictures of the native problems, each described once: shapes, and what moves them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from math import atan, cos, sin

import numpy as np

from botschool.errors import BotschoolError
from botschool.problems.transition import Transition
from botschool.render.canvas import Painter, draw_offscreen
from botschool.render.shapes import Shape, arrow, bent_arrow, rectangle


class Scene(ABC):
    """The picture of one problem. A subclass adds its shapes when it is made."""

    fps: float
    """Steps a second: the speed at which a film looks right."""
    state_size: int
    view: tuple[float, float, float, float]
    """What is seen of the world: left, bottom, right, top."""
    scale: float
    """Pixels of a frame per unit of length."""
    robots: tuple[str, ...] = ("",)
    """Names of the robots whose networks are seen, where there is more than one."""
    closeups: tuple[tuple[str, int, float], ...] = ()
    """What a replay can follow: name, pose, width of what is seen around it."""

    def __init__(self) -> None:
        self.shapes: list[Shape] = []
        self.count = 0
        """How many numbers a step has."""
        self._past: list[np.ndarray] = []
        self._painter: Painter | None = None

    def add(self, kind: str, points, colour: str, **options) -> None:
        """Adds a shape in front of those before; see Shape."""
        self.shapes.append(Shape(kind, tuple(points), colour, **options))

    def pose(self) -> int:
        """Reserves three numbers: x, y, angle."""
        self.count += 3
        return self.count - 3

    def value(self) -> int:
        """Reserves one number."""
        self.count += 1
        return self.count - 1

    def numbers(
        self,
        state: np.ndarray,
        action: np.ndarray | float | None = None,
        observation: np.ndarray | None = None,
        reward: float = 0.0,
    ) -> np.ndarray:
        """What moves the shapes, float64 (count,).

        `state` is the native problem's, (state_size,); `action` the one that led to it,
        `observation` what it answered to and `reward` what it earned, where they can be seen.
        Raises BotschoolError if a number of the state is not finite, ValueError if the size of
        the state, the action or the observation is wrong.
        """
        state = np.asarray(state, dtype=np.float64)
        if state.shape != (self.state_size,):
            raise ValueError(f"a state of shape {state.shape} where ({self.state_size},) is drawn")
        if not np.isfinite(state).all():
            raise BotschoolError(
                f"the state {state.tolist()} cannot be drawn: it holds numbers that are not finite."
            )
        action = np.nan_to_num(np.ravel([] if action is None else action).astype(np.float64))
        if observation is not None:
            observation = np.nan_to_num(np.ravel(observation).astype(np.float64))
        return np.array(self._numbers(state, action, observation, reward), dtype=np.float64)

    @abstractmethod
    def _numbers(
        self,
        state: np.ndarray,
        action: np.ndarray,
        observation: np.ndarray | None,
        reward: float,
    ) -> list[float]:
        """As `numbers`, in the order in which they were reserved; `action` may be empty."""

    def draw(
        self,
        state: np.ndarray,
        action: np.ndarray | float | None = None,
        observation: np.ndarray | None = None,
        reward: float = 0.0,
    ) -> np.ndarray:
        """The frame of a step, (height, width, 3) uint8; arguments and errors as `numbers`.

        Where there are trails, they show what was drawn before in the same episode.
        """
        numbers = self.numbers(state, action, observation, reward)
        longest = max((shape.steps for shape in self.shapes), default=0)
        if not self._follows(state):
            self._past = []
        self._past = [*self._past, numbers][-longest - 1 :]
        draw_offscreen()
        if self._painter is None:
            self._painter = Painter(self.shapes, self.view, self.scale)
        return self._painter.frame(self._past)

    def draw_transition(self, transition: Transition) -> np.ndarray:
        """The frame of a step that `Problem.play` yielded; see draw."""
        return self.draw(
            transition.state, transition.action, transition.observation, transition.reward
        )

    def _follows(self, state: np.ndarray) -> bool:
        """Whether the state comes after those drawn before, in the same episode."""
        return False


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
        self.poles, self.state_size, self.fps, self._discrete = poles, state_size, fps, discrete
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
            corners = [(side * x, y) for x, y in push]
            self.add(
                "polygon", corners, "force",
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
        if self._discrete and len(action):
            force = 1.0 if action[0] >= 0.5 else -1.0
        return [*numbers, max(force, 0.0), max(-force, 0.0)]


class PendulumScene(Scene):
    """The pendulum, with the torque as a bent arrow."""

    state_size, fps, scale = 2, 20.0, 160.0
    view = (-1.25, -1.25, 1.25, 1.25)
    TORQUE = 2.0

    def __init__(self) -> None:
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


class AcrobotScene(Scene):
    """Two links that hang, the height to reach, and the torque at the elbow as a bent arrow."""

    state_size, fps, scale = 4, 15.0, 90.0
    view = (-2.4, -2.3, 2.4, 2.3)

    def __init__(self) -> None:
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


class MountainCarScene(Scene):
    """A car between two hills, its engine's force as an arrow, and the flag to reach."""

    state_size, fps, scale = 2, 30.0, 310.0
    LEFT, RIGHT, GOAL = -1.2, 0.6, 0.45
    view = (-1.25, -0.1, 0.68, 1.25)

    def __init__(self) -> None:
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


def _cartpole() -> Scene:
    return CartScene(
        [Pole(angle=2, length=1.0)], state_size=4, track_y=300, fps=50.0, discrete=True
    )


def _swingup() -> Scene:
    poles = [Pole(angle=2, length=0.6, clockwise=False)]
    return CartScene(poles, state_size=4, track_y=200, fps=100.0)


def _double_pole() -> Scene:
    poles = [Pole(angle=2, length=1.0), Pole(angle=4, length=0.5, colour="short pole")]
    return CartScene(poles, state_size=6, track_y=300, fps=50.0)


def _discrim() -> Scene:
    from botschool.render.arena import DiscrimScene

    return DiscrimScene()


def _predprey() -> Scene:
    from botschool.render.arena import PredpreyScene

    return PredpreyScene()


_SCENES: dict[str, Callable[[], Scene]] = {
    "CartPole-v0": _cartpole,
    "CartPole-v1": _cartpole,
    "Pendulum-v0": PendulumScene,
    "Pendulum-v1": PendulumScene,
    "Acrobot-v1": AcrobotScene,
    "MountainCarContinuous-v0": MountainCarScene,
    "envSwingupCustom": _swingup,
    "ErDpole": _double_pole,
    "ErDiscrim": _discrim,
    "ErPredprey": _predprey,
}


def make_scene(problem_name: str) -> Scene:
    """The scene of a native problem. Raises BotschoolError if there is none for the name."""
    if problem_name not in _SCENES:
        raise BotschoolError(
            f"there are no pictures of {problem_name}: those that can be drawn are "
            f"{', '.join(_SCENES)}."
        )
    return _SCENES[problem_name]()
