"""Native problems of one robot as Gymnasium environments: botschool/Discrim-v0 and others."""

from __future__ import annotations

from typing import ClassVar

import gymnasium
import numpy as np
from gymnasium import spaces

from botschool.envs.simulation import INFOS, RENDER_MODES, Simulation
from botschool.errors import BotschoolError

_FAR = float(np.finfo(np.float32).max)
_MOST_NOISE = 6.0
"""Standard deviations that the noise of a sensor never reaches."""

_BOUNDS = {
    "ErDpole": np.full(3, _FAR),
    "envSwingupCustom": np.array([_FAR, _FAR, 1.0, 1.0, _FAR]),
}
"""Greatest size of each observed value."""


class NativeEnv(gymnasium.Env):
    """A native problem with one robot; the same world as in evolution, in double precision.

    Observations are float32 as evolution's policies get them, actions one number per actuator
    from -1 to 1. An episode ends early as the problem says; its longest length is the affair of
    gymnasium.make, whose TimeLimit truncates. What is random follows from the seed of reset().

    problem: its name in experiment files, such as ErDiscrim. noise: standard deviation of an
    arena's infrared readings; None is the problem's own.
    """

    metadata: ClassVar[dict] = {"render_modes": RENDER_MODES}

    def __init__(
        self, problem: str, render_mode: str | None = None, noise: float | None = None
    ) -> None:
        self.render_mode = render_mode
        self._stage = Simulation(problem, render_mode, noise=noise)
        info = INFOS[problem]
        self.metadata = self.metadata | {"render_fps": round(1 / info["seconds"])}
        self.observation_space = _observation_space(info, noise)
        self._shape = (info["outputs"],)
        self.action_space = spaces.Box(-1.0, 1.0, self._shape, np.float32)

    def reset(self, *, seed: int | None = None, options: dict | None = None):
        super().reset(seed=seed)
        self._stage.start(self.np_random)
        self._stage.show()
        return self._observation(), {}

    def step(self, action: np.ndarray):
        action = np.asarray(action)
        if action.shape != self._shape or action.dtype.kind not in "fiub":
            raise BotschoolError(
                f"An action has {self._shape[0]} numbers, but this one is {action.tolist()}."
            )
        reward, ended = self._stage.step(action)
        self._stage.show()
        return self._observation(), reward, ended, False, {}

    def render(self) -> np.ndarray | None:
        return self._stage.render()

    def close(self) -> None:
        self._stage.close()

    def _observation(self) -> np.ndarray:
        return self._stage.observation.astype(np.float32)


def _observation_space(info: dict, noise: float | None) -> spaces.Box:
    if "plan" not in info:
        high = _BOUNDS[info["name"]].astype(np.float32)
        return spaces.Box(-high, high)
    most = np.float32(_MOST_NOISE * (info["plan"]["noise"] if noise is None else noise))
    return spaces.Box(-most, 1 + most, (info["observations"],), np.float32)
