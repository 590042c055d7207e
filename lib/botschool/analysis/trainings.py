"""Read trainings of `botschool rl` as learning curves that can be drawn next to evolution's."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from botschool.analysis.runs import (
    BEST_POST,
    GENERATION_AVERAGE,
    GENERATION_BEST,
    STEPS,
    Warn,
)
from botschool.errors import BotschoolError
from botschool.rl.folder import RunFolder, find_runs

POST_EVALUATED, TRAINING_EPISODES = GENERATION_BEST, GENERATION_AVERAGE
"""Meaning of these columns of a stat file in the curve of a training."""


def has_trainings(folder: Path) -> bool:
    """Return whether a folder is or holds a training; a folder of evolutionary runs is none."""
    return folder.is_dir() and not any(folder.glob("stat*.npy")) and bool(find_runs(folder))


def read_trainings(
    folder: Path, count_evaluations: bool, warn: Warn
) -> dict[Path, dict[int, np.ndarray]]:
    """Return the curves of all trainings below a folder: group -> number of the run -> (n, 6).

    A group is a path that exists only as a name, `FOLDER/ppo Acrobot-v1`, with the values changed
    by --params. Columns as in `read_curve`. A damaged training is left out after a call of `warn`;
    it is an error if it was named itself. Return {} if there is no training.
    """
    groups: dict[Path, dict[int, np.ndarray]] = {}
    runs = find_runs(folder)
    for run in runs:
        try:
            curve = read_curve(run, count_evaluations)
            curves = groups.setdefault(_group(run), {})
        except BotschoolError as error:
            if run.path == folder:
                raise
            warn(f"skipped: {error}")
            continue
        curves[run.number] = curve
    if runs and not groups:
        raise BotschoolError(f"no training in {folder} can be read: train again.")
    return groups


def _group(run: RunFolder) -> Path:
    settings = run.settings()
    words = [settings.algo, settings.env.replace("/", "-"), settings.variant.replace("/", "-")]
    return run.path.resolve().parent.parent / " ".join(words).strip()


def read_curve(run: RunFolder, count_evaluations: bool = False) -> np.ndarray:
    """Return the learning curve of a training in the shape of a stat file, (evaluations, 6).

    The columns are: steps of training (with `count_evaluations` including post-evaluations, as in
    evolution); the best post-evaluation so far; POST_EVALUATED, the mean return of this one;
    TRAINING_EPISODES, the mean return of the training's latest episodes. Other columns are NaN.
    Raises BotschoolError.
    """
    found = run.evaluations()
    curve = np.full((len(found.steps), 6), np.nan)
    curve[:, STEPS] = found.steps
    if count_evaluations:
        curve[:, STEPS] += found.lengths.sum(axis=1).cumsum()
    curve[:, POST_EVALUATED] = found.returns.mean(axis=1)
    curve[:, BEST_POST] = np.maximum.accumulate(curve[:, POST_EVALUATED])
    curve[:, TRAINING_EPISODES] = _training_episodes(run, found.steps)
    return curve


def _training_episodes(run: RunFolder, steps: np.ndarray) -> np.ndarray:
    try:
        log = run.log()
        means = log["rollout/ep_rew_mean"]
    except (BotschoolError, KeyError):
        return np.full(len(steps), np.nan)
    if len(log["steps"]) != len(means):  # the column of the steps is missing
        return np.full(len(steps), np.nan)
    known = np.isfinite(means) & np.isfinite(log["steps"])
    if not known.any():
        return np.full(len(steps), np.nan)
    return np.interp(steps, log["steps"][known], means[known], left=np.nan)
