"""Let a trained native agent act in Gymnasium environments, without torch."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from botschool.errors import BotschoolError
from botschool.rl.native import files
from botschool.rl.native.ppo import PPO
from botschool.rl.settings import Settings


class NativeAgent:
    """A native agent with the interface of botschool.rl.agent.Agent."""

    def __init__(self, ppo: PPO) -> None:
        self.ppo = ppo

    @classmethod
    def load(cls, path: Path, settings: Settings) -> NativeAgent:
        """Return the model in a file of a native training's folder. Raises BotschoolError."""
        if not path.exists():
            raise BotschoolError(f"There is no model {path}: train one with `botschool rl train`.")
        ppo = files.make(settings)
        try:
            files.fill(ppo, path)
        except Exception as error:  # a damaged file can fail in any way
            raise BotschoolError(
                f"{path} is damaged, or it is not a model of this training: take the other "
                "model of its folder, or train again."
            ) from error
        return cls(ppo)

    def act(
        self, observations: Any, state: Any = None, starts: np.ndarray | None = None
    ) -> tuple[np.ndarray, Any]:
        """Return the most probable actions for observations (n, inputs)."""
        return self.ppo.act(np.asarray(observations)), None
