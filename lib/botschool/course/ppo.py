"""Train CartPole by the student's own loop of exercise 13, and by the engine's loop."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from botschool.rl.native import PPO, Rollout

ENVIRONMENT, STEPS = "CartPole-v1", 30_000
SETTINGS: dict[str, Any] = {
    "n_envs": 8, "n_steps": 64, "batch_size": 128, "n_epochs": 8, "gamma": 0.98,
    "gae_lambda": 0.9, "learning_rate": 0.002, "target_kl": 0.02, "net_arch": [32, 32],
}  # fmt: skip


class Pieces(PPO):
    """A PPO that leaves the loop to the student: without advantages, update() and learn()."""

    def __init__(self, *arguments: Any, **named: Any) -> None:
        super().__init__(*arguments, **named)
        self.ends: list[int] = []
        self.returns: list[float] = []
        """Steps so far and return at the end of each episode, in the order of their ends."""

    def collect(self) -> Rollout:
        """Collect a rollout; its advantages and returns are zeros."""
        rollout = super().collect()
        rollout.advantages[:], rollout.returns[:] = 0, 0
        ends, returns, _ = self.episodes
        self.ends += ends.tolist()
        self.returns += returns.tolist()
        return rollout

    def update(self) -> dict[str, float]:
        """Refuse, because the student writes this."""
        raise NotImplementedError("write the loop over epochs and batches yourself")

    def learn(self, *arguments: Any, **named: Any) -> PPO:
        """Refuse, because the student writes this."""
        raise NotImplementedError("write the loop over rollouts yourself")


def train_own(learn: Callable[[PPO, int, int], None] | None, seed: int) -> dict[str, Any]:
    """Train on CartPole-v1 by the student's loop, or by the engine's loop if `learn` is None.

    Return "steps" and "returns" of the episodes in the order of their ends, and "act", a function
    that takes the trained policy's most probable action.
    """
    steps, returns = [], []
    if learn is None:
        ppo = PPO(ENVIRONMENT, seed, **SETTINGS)
        while ppo.steps < STEPS:
            ppo.collect()
            steps += ppo.episodes[0].tolist()
            returns += ppo.episodes[1].tolist()
            ppo.update()
    else:
        ppo = Pieces(ENVIRONMENT, seed, **SETTINGS)
        learn(ppo, STEPS, seed)
        steps, returns = ppo.ends, ppo.returns

    def act(observation: np.ndarray) -> int:
        return int(ppo.act(np.asarray(observation)[None])[0])

    return {"steps": steps, "returns": returns, "act": act}


def draw_own_training(file: str | Path, runs: list[dict], reference: list[dict]) -> None:
    """Draw both kinds of trainings: means of 20 episodes, and the mean of all runs."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 4.5), layout="constrained")
    axes = figure.subplots()
    at = np.linspace(2_000, STEPS, 60)
    for name, colour, trained in (
        ("your loop", "#d55e00", runs), ("the engine's loop", "#0072b2", reference)
    ):  # fmt: skip
        curves = [np.interp(at, *_smooth(run)) for run in trained]
        for curve in curves:
            axes.plot(at, curve, color=colour, alpha=0.25, linewidth=1)
        label = f"{name}, mean of {len(trained)} seeds"
        axes.plot(at, np.mean(curves, axis=0), color=colour, linewidth=2.5, label=label)
    axes.set(xlabel="steps", ylabel="mean return of 20 episodes", title="Your loop trains CartPole")
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, loc="upper left")
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def _smooth(run: dict) -> tuple[np.ndarray, np.ndarray]:
    """Return steps and running means of 20 episodes."""
    returns = np.array(run["returns"], dtype=float)
    window = min(20, len(returns))
    return np.array(run["steps"])[window - 1 :], np.convolve(
        returns, np.full(window, 1 / window), "valid"
    )
