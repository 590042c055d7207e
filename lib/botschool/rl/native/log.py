"""Log the indicators of a training by Stable-Baselines3's names: progress.csv and TensorBoard."""

from __future__ import annotations

import csv
import time
from collections import deque
from pathlib import Path

import numpy as np

from botschool import linear
from botschool.evolution.events import VERSION, event, record
from botschool.output import cannot_write
from botschool.rl.native.discounted import DiscountedReturns
from botschool.rl.native.ppo import PPO

RECENT = 100
"""Number of recent episodes that rollout/ep_rew_mean covers."""

HISTOGRAMS = 100
"""Histograms of each kind in a whole training; TensorBoard shows about as many."""

TIME = ("time/fps", "time/time_elapsed")
"""Indicators that differ from run to run."""

TRAIN = (
    "approx_kl", "clip_fraction", "clip_range", "explained_variance", "learning_rate", "loss",
    "value_loss",
)  # fmt: skip


class Log:
    """Files that grow by a row at each update; a checkpoint stores their length."""

    def __init__(self, folder: Path, ppo: PPO, more: Path | None = None, resumed: bool = False):
        self._ppo = ppo
        self._csv = folder / "progress.csv"
        folders = [folder] if more is None else [folder, more / folder.name]
        self._events = [self._event_file(each, resumed) for each in folders]
        self._columns = columns(ppo)
        self._sums = DiscountedReturns(ppo)
        self._spread: list[tuple[str, np.ndarray]] = []
        self._parts = 0
        self._begun, self._before, self._first = time.monotonic(), 0.0, ppo.steps
        self.returns: deque[float] = deque(maxlen=RECENT)
        self.lengths: deque[int] = deque(maxlen=RECENT)
        self.discounted: deque[float] = deque(maxlen=RECENT)

    def indicators(self, found: dict[str, float]) -> dict[str, float]:
        """Return the indicators of update() and the rollout, by Stable-Baselines3's names."""
        ppo = self._ppo
        _, returns, lengths = ppo.episodes
        self.returns.extend(returns.tolist())
        self.lengths.extend(lengths.tolist())
        self.discounted.extend(self._sums.add(returns).tolist())
        rollout, named = ppo.rollout, {}
        if self.returns:
            named["rollout/ep_rew_mean"] = float(np.mean(self.returns))
            named["rollout/ep_len_mean"] = float(np.mean(self.lengths))
        if self.discounted:  # a checkpoint of an older version has none
            named["rollout/discounted_return"] = float(np.mean(self.discounted))
        named |= moments("rollout/advantage", rollout.advantages)
        actions = rollout.actions.reshape(-1, rollout.actions.shape[2])
        self._spread = [("rollout/advantage", rollout.advantages)]
        self._spread += zip(_names(ppo, ["actions/chosen"]), actions.T, strict=False)
        std = ppo.weights.get("log_std")
        if std is None:
            counts = np.bincount(actions[:, 0].astype(int), minlength=ppo.outputs)
            for action, share in enumerate(counts / counts.sum()):
                named[f"actions/frequency_{action}"] = float(share)
        else:
            for number, column in enumerate(actions.T):
                named |= moments(f"actions/{number}", column)
        seconds = max(1e-9, time.monotonic() - self._begun)
        named["time/fps"] = float(int((ppo.steps - self._first) / seconds))
        named["time/time_elapsed"] = float(int(self._before + seconds))
        named["time/iterations"] = float(int(ppo.core.updates))
        for name in TRAIN:
            named[f"train/{name}"] = found[name]
        named["train/entropy_loss"] = -found["entropy"]
        named["train/policy_gradient_loss"] = found["policy_loss"]
        named["train/n_updates"] = float(ppo.core.updates * ppo.hyperparameters.n_epochs)
        if std is not None:
            named["train/std"] = float(linear.exp(std).mean())
        return named

    def add(self, values: dict[str, float]) -> None:
        """Append a row. Raises BotschoolError."""
        step, now = self._ppo.steps, time.time()
        parts = HISTOGRAMS * step // max(1, self._ppo.total_timesteps)
        spread = self._spread if parts > self._parts else []
        self._parts = parts
        written = record(event(now, step, list(values.items()), histograms=spread))
        try:
            for file in self._events:
                with open(file, "ab") as events_file:
                    events_file.write(written)
            self._row({**values, "time/total_timesteps": step})
        except OSError as error:
            raise cannot_write(self._csv.parent, error.strerror or str(error)) from error

    def _row(self, values: dict[str, float]) -> None:
        with open(self._csv, "a", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, self._columns)
            if file.tell() == 0:
                writer.writeheader()
            writer.writerow(values)

    def state(self) -> dict[str, np.ndarray]:
        """Return the part of the log that a checkpoint stores."""
        sizes = [self._csv.stat().st_size if self._csv.exists() else 0]
        sizes += [file.stat().st_size for file in self._events]
        return {
            "log_sizes": np.array(sizes),
            "log_returns": np.array(self.returns, dtype=np.float64),
            "log_lengths": np.array(self.lengths, dtype=np.int64),
            "log_discounted": np.array(self.discounted, dtype=np.float64),
            "log_sums": self._sums.carried,
            "log_seconds": np.array([self._before + time.monotonic() - self._begun]),
        }

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Restore the log from a checkpoint and cut off all later rows."""
        returns, lengths = state["log_returns"], state["log_lengths"]
        sizes = [int(size) for size in state["log_sizes"]]
        if returns.ndim != 1 or returns.shape != lengths.shape or min(sizes, default=0) < 0:
            raise ValueError("these are no indicators")
        self._before = float(state["log_seconds"][0])
        self.returns.extend(returns.tolist())
        self.lengths.extend(lengths.tolist())
        if "log_sums" in state:
            self._sums.restore(state["log_sums"])
            self.discounted.extend(state["log_discounted"].tolist())
        self._parts = HISTOGRAMS * self._ppo.steps // max(1, self._ppo.total_timesteps)
        for file, size in zip([self._csv, *self._events], sizes, strict=False):
            if file.exists() and file.stat().st_size > size:
                with open(file, "r+b") as cut:
                    cut.truncate(size)

    def _event_file(self, folder: Path, resumed: bool) -> Path:
        found = sorted(folder.glob("events.out.tfevents.*")) if resumed else []
        if found:
            return found[0]
        now = time.time()
        file = folder / f"events.out.tfevents.{int(now)}.botschool.0"
        try:
            folder.mkdir(parents=True, exist_ok=True)
            file.write_bytes(record(event(now, version=VERSION)))
        except OSError as error:
            raise cannot_write(folder, error.strerror or str(error)) from error
        return file


def moments(name: str, values: np.ndarray) -> dict[str, float]:
    """Return mean and standard deviation."""
    return {f"{name}_mean": float(np.mean(values)), f"{name}_std": float(np.std(values))}


def _names(ppo: PPO, discrete: list[str]) -> list[str]:
    """Return the names of the actions' numbers; discrete: those of a discrete problem."""
    return [f"actions/{i}" for i in range(ppo.outputs)] if "log_std" in ppo.weights else discrete


def columns(ppo: PPO) -> list[str]:
    """Return the columns of progress.csv."""
    discrete = "log_std" not in ppo.weights
    actions = _names(ppo, [f"actions/frequency_{i}" for i in range(ppo.outputs)])
    pairs = ["rollout/advantage", *([] if discrete else actions)]
    return [
        "time/total_timesteps", "time/iterations", *TIME,
        "rollout/ep_rew_mean", "rollout/ep_len_mean", "rollout/discounted_return",
        "eval/mean_reward", "eval/mean_ep_length",
        *(f"{name}_{what}" for name in pairs for what in ("mean", "std")),
        *(actions if discrete else ["train/std"]),
        *(f"train/{name}" for name in TRAIN),
        "train/entropy_loss", "train/policy_gradient_loss", "train/n_updates",
    ]  # fmt: skip
