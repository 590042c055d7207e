"""Define the picture of a native problem: shapes, described once, and the numbers that move them.

Each problem's picture is a file in botschool/render/scenes.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any

import numpy as np

from botschool.errors import BotschoolError
from botschool.problems.transition import Transition
from botschool.render.canvas import Painter, draw_offscreen
from botschool.render.shapes import Shape
from botschool.render.space import Space


class Scene(ABC):
    """The picture of one problem. The constructor of a subclass adds its shapes."""

    fps: float
    """Steps per second in a film."""
    state_size: int
    view: tuple[float, float, float, float]
    """The visible part of the world: left, bottom, right, top."""
    scale: float
    """Pixels of a frame per unit of length."""
    robots: tuple[str, ...] = ("",)
    """Names of the robots whose networks are shown, if there is more than one."""
    closeups: tuple[tuple[str, int, float], ...] = ()
    """Objects that a replay can follow: name, pose, width of the view around it."""
    charted: tuple[tuple[str, tuple[int, ...]], ...] = ()
    """Charts of a replay below the neurons: name, and the numbers that are its lines (-1 to 1)."""

    memory = 0
    """Steps before a frame that it depends on, besides those of trails."""
    space: Space | None = None
    """What is painted in space, in place of shapes."""

    def __init__(self) -> None:
        self.shapes: list[Shape] = []
        self.count = 0
        """Numbers per step."""
        self._past: list[np.ndarray] = []
        self._painter: Any = None

    def add(self, kind: str, points, colour: str, **options) -> None:
        """Add a shape in front of the earlier ones; see Shape."""
        self.shapes.append(Shape(kind, tuple(points), colour, **options))

    def pose(self) -> int:
        """Reserve three numbers: x, y, angle; return the index of the first."""
        self.count += 3
        return self.count - 3

    def value(self) -> int:
        """Reserve one number; return its index."""
        self.count += 1
        return self.count - 1

    def numbers(
        self,
        state: np.ndarray,
        action: np.ndarray | float | None = None,
        observation: np.ndarray | None = None,
        reward: float = 0.0,
    ) -> np.ndarray:
        """Return the numbers that move the shapes, float64 (count,).

        state: of the native problem, (state_size,). action: the one that led to it. observation:
        what the robots saw before the action. reward: of the action. All but the state may be
        unknown. Raises BotschoolError if a number of the state is not finite, and ValueError if the
        size of the state, the action or the observation is wrong.
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
        """Return the same as `numbers`, in the order of reservation; `action` may be empty."""

    def draw(
        self,
        state: np.ndarray,
        action: np.ndarray | float | None = None,
        observation: np.ndarray | None = None,
        reward: float = 0.0,
    ) -> np.ndarray:
        """Return the frame of a step, (height, width, 3) uint8; arguments as in `numbers`.

        Trails show what was drawn before in the same episode.
        """
        numbers = self.numbers(state, action, observation, reward)
        longest = max((shape.steps for shape in self.shapes), default=self.memory)
        if not self._follows(state):
            self._past = []
        self._past = [*self._past, numbers][-longest - 1 :]
        draw_offscreen()
        if self._painter is None:
            self._painter = self.painter()
        return self._painter.frame(self._past)

    def painter(self) -> Any:
        """Return what paints the frames."""
        return Painter(self.shapes, self.view, self.scale)

    def draw_transition(self, transition: Transition) -> np.ndarray:
        """Return the frame of a step that `Problem.play` yielded; see draw."""
        return self.draw(
            transition.state, transition.action, transition.observation, transition.reward
        )

    def _follows(self, state: np.ndarray) -> bool:
        """Return whether the state continues the drawn episode."""
        return False


Maker = Callable[..., Scene]
"""Makes a scene for the problem's wheeled robots (often none) and its plan, if any."""

SCENES: dict[str, Maker] = {}
"""By the problem's name in C++; importing botschool.render.scenes fills it."""


def draws(problem: str) -> Callable[[Maker], Maker]:
    """Decorate the maker of a problem's scene to register it."""

    def enter(maker: Maker) -> Maker:
        SCENES[problem] = maker
        return maker

    return enter
