"""Read and write the weights (by Stable-Baselines3's names) and checkpoint of a native training.

A trained native agent acts in Gymnasium environments, too, without torch.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from botschool.errors import BotschoolError
from botschool.output import save_npz
from botschool.rl.native import sb3
from botschool.rl.native.hyperparameters import Hyperparameters
from botschool.rl.native.ppo import PPO
from botschool.rl.settings import Settings
from botschool.rl.weights import NORMALISATION, numbers, reading

CHECKPOINT = "checkpoint.npz"


def make(settings: Settings, threads: int = 1) -> PPO:
    """Return an untrained agent with these settings. Raises BotschoolError."""
    h = Hyperparameters.of(settings.parameters)
    return PPO(
        settings.env,
        settings.seed,
        settings.envs,
        settings.normalize,
        settings.steps,
        threads,
        own=settings.own,
        **vars(h),
    )


def save_model(ppo: PPO, path: Path) -> None:
    """Write the weights and the normalisation of observations atomically."""
    save_npz(path, sb3.weights(ppo) | scaling(ppo))


def scaling(ppo: PPO) -> dict[str, np.ndarray]:
    """Return the normalisation of observations by the names of weights.py."""
    if not ppo.normalize:
        return {}
    mean, variance = ppo.core.observed
    values = {"mean": mean, "variance": variance, "clip": 10.0, "epsilon": 1e-8}
    return {f"{NORMALISATION}.{name}": np.asarray(each) for name, each in values.items()}


def fill(ppo: PPO, path: Path) -> None:
    """Load a model's weights and normalisation into the agent. Raises ValueError or OSError."""
    arrays = numbers(path)
    sb3.fill(ppo, arrays)
    if ppo.normalize:
        names = (f"{NORMALISATION}.mean", f"{NORMALISATION}.variance")
        if not set(names) <= arrays.keys():
            raise ValueError("the normalisation is missing")
        ppo.core.observed = np.array([arrays[name] for name in names])


def save_checkpoint(folder: Path, arrays: dict[str, np.ndarray]) -> None:
    """Write the checkpoint that --resume continues from. Raises BotschoolError."""
    save_npz(folder / CHECKPOINT, arrays)


def load_checkpoint(folder: Path) -> dict[str, np.ndarray]:
    """Read the checkpoint. Raises BotschoolError."""
    path = folder / CHECKPOINT
    try:
        return numbers(path)
    except FileNotFoundError:
        raise BotschoolError(
            f"{folder} has no {CHECKPOINT}, so this training cannot continue: name the folder "
            "of a training of the native engine."
        ) from None
    except Exception:  # a damaged file can fail in any way
        raise BotschoolError(f"{path} is damaged: train again.") from None


class NativeAgent:
    """A native agent with the interface of botschool.rl.agent.Agent."""

    def __init__(self, ppo: PPO) -> None:
        self.ppo = ppo

    @classmethod
    def load(cls, path: Path, settings: Settings) -> NativeAgent:
        """Return the model in a file of a native training's folder. Raises BotschoolError."""
        with reading(path):
            ppo = make(settings)
            fill(ppo, path)
        return cls(ppo)

    def act(
        self, observations: Any, state: Any = None, starts: np.ndarray | None = None
    ) -> tuple[np.ndarray, Any]:
        """Return the most probable actions for observations (n, inputs)."""
        return self.ppo.act(np.asarray(observations)), None
