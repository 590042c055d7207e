"""Step a native problem for the environments that offer it to Gymnasium and PettingZoo."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np

from botschool import _core
from botschool.arenas.plan import Plan
from botschool.errors import BotschoolError
from botschool.problems.native import INFOS, NativeProblem
from botschool.problems.transition import Transition
from botschool.render.scenes import scene_of, with_frames

RENDER_MODES = ["human", "rgb_array"]


class Simulation:
    """A native problem with its robots' observations and its pictures.

    problem: its name in C++. limit: longest episode in steps, None means the problem's own. noise:
    standard deviation of an arena's infrared readings, None means the problem's own. robots: kinds
    of its wheeled robots, one for all or one each; () means the problem's own. plan: a declared
    arena. options: of a runner (botschool.problems.space). reward, ends: of one's own.
    """

    def __init__(
        self,
        problem: str,
        render_mode: str | None,
        limit: int | None = None,
        noise: float | None = None,
        robots: Sequence[str] = (),
        plan: Plan | None = None,
        options: str = "",
        reward: str = "",
        ends: str = "",
        physics: str = "",
    ) -> None:
        if render_mode not in (None, *RENDER_MODES):
            raise BotschoolError(
                f"render_mode is one of {', '.join(RENDER_MODES)} or None, not {render_mode!r}."
            )
        self._problem = NativeProblem(
            problem, robots, plan=plan, options=options, reward=reward, ends=ends, physics=physics
        )
        self.info = INFOS[problem] | {"seconds": 1 / self._problem.fps}
        self.interface = self._problem.interface
        self.limit = self._problem.limit if limit is None else limit
        self.steps = 0
        self._stepper = _core.make_stepper(problem)
        try:
            self._stepper.set(self.limit, self._problem.options(noise))
        except (TypeError, ValueError):
            raise BotschoolError(
                f"max_steps must be at least 1 and noise at least 0, but they are {limit!r} and "
                f"{noise!r}."
            ) from None
        self._mode = render_mode
        self._scene: Any = None
        self._window: Any = None
        self._shown: Any = None

    @property
    def bounds(self) -> np.ndarray:
        """Return the limits of a robot's observation: smallest, then largest, (2, observations)."""
        return self._stepper.bounds

    @property
    def observation(self) -> np.ndarray:
        """Return the observations of all robots, one after another, float64."""
        return self._stepper.observation

    @property
    def state(self) -> np.ndarray:
        """Return the native problem's state."""
        return self._stepper.state

    def set_body(self, parameters: np.ndarray) -> None:
        """Set an evolved body for the episodes from the next start on."""
        self._stepper.set_body(np.ascontiguousarray(parameters, dtype=np.float64))

    def start(self, random: np.random.Generator) -> int:
        """Start an episode with a seed drawn from `random`, and return the seed."""
        seed = int(random.integers(2**63))
        self._stepper.start(seed, 0)
        self.steps = 0
        self._shown = (None, None, 0.0)
        return seed

    def step(self, action: np.ndarray) -> tuple[float, bool]:
        """Let all robots act; return (reward, whether the episode has ended before its limit)."""
        action = np.ascontiguousarray(action, dtype=np.float64)
        if not np.isfinite(action).all():
            raise BotschoolError(f"An action holds finite numbers, not {action.tolist()}.")
        seen = self.observation
        reward, ended = self._stepper.step(action)
        self.steps += 1
        self._shown = (action, seen, reward)
        return reward, ended

    def show(self) -> None:
        """Show the step, if there is a window."""
        if self._mode == "human":
            self.render()

    def render(self) -> np.ndarray | None:
        """Return the picture, (height, width, 3) uint8, or None if the window shows it."""
        if self._mode is None:
            gymnasium.logger.warn('make the environment with render_mode="rgb_array" to see it.')
            return None
        if self._shown is None:
            raise BotschoolError("There is nothing to see before the first reset().")
        frame = self._frame()
        if self._mode == "rgb_array":
            return frame
        if self._window is None:
            self._window = Window(self.info["name"], frame.shape, 1 / self.info["seconds"])
        self._window.show(frame)
        return None

    def _frame(self) -> np.ndarray:
        if self._scene is None:
            self._scene = scene_of(self._problem)
        if self._scene is not None:
            return self._scene.draw(self.state, *self._shown)
        action, seen, reward = self._shown
        step = Transition(self.steps, reward, 0.0, seen, action, np.zeros(0), self.state)
        (shown,) = with_frames(self._problem, iter([step]))
        return shown.frame

    def close(self) -> None:
        """Close the window, if there is one."""
        if self._window is not None:
            self._window.close()
            self._window = None


class Window:
    """A window that runs at the speed of the world. Raises BotschoolError without a display."""

    def __init__(self, title: str, shape: tuple[int, ...], fps: float) -> None:
        from botschool.render.canvas import import_pygame
        from botschool.render.window import open_display

        self._pygame = import_pygame()
        open_display(self._pygame)
        self._surface = self._pygame.display.set_mode((shape[1], shape[0]))
        self._pygame.display.set_caption(title)
        self._clock, self._fps = self._pygame.time.Clock(), fps

    def show(self, frame: np.ndarray) -> None:
        """Show a frame, then wait until the next one is due."""
        self._pygame.surfarray.blit_array(self._surface, frame.swapaxes(0, 1))
        self._pygame.event.pump()
        self._pygame.display.flip()
        self._clock.tick(self._fps)

    def close(self) -> None:
        """Close the window."""
        self._pygame.display.quit()
