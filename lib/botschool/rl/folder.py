"""Find, make and read the folders of trainings. Needs no torch.

ppo/CartPole-v1_1/
  config.yaml        what was trained, and how (settings.py)
  best_model.zip     the model with the best post-evaluation, in Stable-Baselines3's format
  last_model.zip     the newest model, saved during the training
                     (both end in .npz and hold only weights if the native engine trained)
  checkpoint.npz     the state from which --resume continues a native training
  evaluations.npz    timesteps (n,), results (n, episodes), ep_lengths (n, episodes)
  progress.csv       the indicators, one row each time they were logged
  events.out.*       the same for TensorBoard

The number at the end is the next free one. A `.zip` file also holds the running means of a
normalised training, so a model is always complete.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from botschool.errors import BotschoolError
from botschool.output import cannot_write, save_npz
from botschool.problems.native import gym_id
from botschool.rl.weights import numbers

if TYPE_CHECKING:
    import gymnasium

    from botschool.rl.settings import Settings

CONFIG, EVALUATIONS = "config.yaml", "evaluations.npz"

DEPTH = 3
"""Levels below a folder that are searched for trainings, as in results/rl/ppo/CartPole-v1_1."""


@dataclass
class Evaluations:
    """The post-evaluations of a training, on the same fresh seeds each time."""

    steps: np.ndarray
    """int64, shape (n,): steps of training before each."""
    returns: np.ndarray
    """float64, shape (n, episodes)."""
    lengths: np.ndarray
    """int64, shape (n, episodes): steps of each episode."""

    @classmethod
    def after(
        cls, before: Evaluations | None, steps: int, returns: np.ndarray, lengths: np.ndarray
    ) -> Evaluations:
        """Return all post-evaluations, with a new one after those before; returns: (episodes,)."""
        new = np.array([steps]), returns[None], lengths[None].astype(np.int64)
        if before is None:
            return cls(*new)
        old = before.steps, before.returns, before.lengths
        return cls(*map(np.concatenate, zip(old, new, strict=True)))

    @property
    def best(self) -> float:
        """Return the mean return of the best post-evaluation, which best_model.zip reached."""
        return float(self.returns.mean(axis=1).max())

    @property
    def last(self) -> float:
        """Return the mean return of the last post-evaluation."""
        return float(self.returns[-1].mean())


class RunFolder:
    """The files of one training."""

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path)

    def __repr__(self) -> str:
        return f"RunFolder({str(self.path)!r})"

    @property
    def config(self) -> Path:
        return self.path / CONFIG

    @property
    def best(self) -> Path:
        return self._model("best_model")

    @property
    def last(self) -> Path:
        return self._model("last_model")

    def _model(self, name: str) -> Path:
        native = self.path / f"{name}.npz"
        return native if native.is_file() else self.path / f"{name}.zip"

    @property
    def number(self) -> int:
        """Return the number at the end of the folder's name, 0 if it has none."""
        match = re.search(r"_(\d+)$", self.path.name)
        return int(match[1]) if match else 0

    def settings(self) -> Settings:
        """Return the settings of the training. Raises BotschoolError."""
        from botschool.rl.settings import Settings

        return Settings.load(self.config)

    def make_env(self, **options: object) -> gymnasium.Env:
        """Return a new environment of the kind that the agent was trained on."""
        from botschool.rl.environments import make

        settings = self.settings()
        return make(settings.env, settings.wrappers, **settings.own, **options)

    def save_evaluations(self, evaluations: Evaluations) -> None:
        """Write evaluations.npz. Raises BotschoolError."""
        names = ("timesteps", "results", "ep_lengths")
        arrays = (evaluations.steps, evaluations.returns, evaluations.lengths)
        save_npz(self.path / EVALUATIONS, dict(zip(names, arrays, strict=True)))

    def evaluations(self) -> Evaluations:
        """Read evaluations.npz. Raises BotschoolError."""
        path = self.path / EVALUATIONS
        try:
            arrays = numbers(path)
            steps, returns, lengths = (
                arrays[name] for name in ("timesteps", "results", "ep_lengths")
            )
        except FileNotFoundError:
            raise BotschoolError(
                f"{self.path} is not the folder of a training with results: it has no "
                f"{EVALUATIONS}."
            ) from None
        except Exception:  # a damaged file can fail in any way
            raise BotschoolError(f"{path} is damaged: train again.") from None
        if (steps.ndim, returns.ndim) != (1, 2) or lengths.shape != returns.shape:
            raise BotschoolError(f"{path} holds no evaluations: train again.")
        if not len(steps) == len(returns) > 0 or not returns.size:
            raise BotschoolError(f"{path} holds no evaluations: train again.")
        return Evaluations(steps, returns, lengths)

    def log(self) -> dict[str, np.ndarray]:
        """Read progress.csv: name of the indicator -> float64, shape (rows,), NaN where absent.

        `steps` counts the steps of the training. Raises BotschoolError.
        """
        path = self.path / "progress.csv"
        try:
            with open(path, encoding="utf-8", newline="") as file:
                rows = list(csv.DictReader(file))
        except (OSError, UnicodeDecodeError, csv.Error) as error:
            raise BotschoolError(
                f"{path} cannot be read ({error}): train again with `botschool rl train`."
            ) from None
        names = sorted({name for row in rows for name in row if name})
        log = {name: np.array([_number(row.get(name)) for row in rows]) for name in names}
        log["steps"] = log.pop("time/total_timesteps", np.zeros(0))
        return log


def _number(text: object) -> float:
    try:
        return float(str(text))
    except ValueError:
        return float("nan")


def name_of(env: str) -> str:
    """Return an environment's id as part of a folder's name."""
    return re.sub(r"[^\w.-]+", "-", env)


def next_folder(base: Path, algo: str, env: str) -> RunFolder:
    """Make the folder base/algo/env_N with the next free number N. Raises BotschoolError."""
    name = name_of(env)
    parent = base / algo
    try:
        parent.mkdir(parents=True, exist_ok=True)
        taken = (re.fullmatch(re.escape(name) + r"_(\d+)", path.name) for path in parent.iterdir())
        number = 1 + max((int(match[1]) for match in taken if match), default=0)
        while True:
            path = parent / f"{name}_{number}"
            try:
                path.mkdir()
                return RunFolder(path)
            except FileExistsError:  # another training took this number first
                number += 1
    except OSError as error:
        raise cannot_write(parent, error.strerror or str(error)) from error


def runs_of(folder: Path | str, algo: str, env: str) -> dict[int, RunFolder]:
    """Return the trainings of an algorithm on an environment, by their numbers."""
    parent = Path(folder) / algo
    return {
        run.number: run
        for name in (name_of(env), name_of(gym_id(env)))  # old folders have the name as given
        for run in find_runs(parent)
        if run.path.name == f"{name}_{run.number}" and run.path.parent == parent
    }


def run_of(folder: Path | str, algo: str, env: str, number: int = 0, hint: str = "") -> RunFolder:
    """Return the training `number` of an algorithm on an environment; 0 means the newest one.

    hint: added to the error if there is no training at all. Raises BotschoolError.
    """
    numbered = runs_of(folder, algo, env)
    if not numbered or number not in (0, *numbered):
        there = (
            f"numbers there: {', '.join(map(str, sorted(numbered)))}"
            if numbered
            else f"train one with `botschool rl train --algo {algo} --env {env} -o {folder}`{hint}"
        )
        which = f" number {number}" if number else ""
        raise BotschoolError(
            f"There is no training{which} of {algo} on {env} in {folder}; {there}."
        )
    return numbered[number or max(numbered)]


def find_runs(folder: Path | str) -> list[RunFolder]:
    """Return the trainings in a folder, by name and number: the folder itself, or folders up to
    DEPTH levels below it.
    """
    return sorted(
        (RunFolder(path) for path in _folders(Path(folder))),
        key=lambda run: (run.path.parent, re.sub(r"_\d+$", "", run.path.name), run.number),
    )


def _folders(folder: Path) -> Iterator[Path]:
    if is_run(folder):
        yield folder
    elif folder.is_dir():
        for depth in range(1, DEPTH + 1):
            configs = folder.glob("/".join(["*"] * depth + [CONFIG]))
            yield from (config.parent for config in configs if is_run(config.parent))


def is_run(folder: Path) -> bool:
    """Return whether the folder holds a training."""
    return (folder / CONFIG).is_file() and any(
        (folder / name).is_file()
        for name in (EVALUATIONS, "last_model.zip", "last_model.npz", "progress.csv")
    )
