"""Run a native training in a folder: post-evaluations, models, indicators, checkpoint.

best_model.npz, last_model.npz    weights by Stable-Baselines3's names (files.py)
checkpoint.npz                    the state from which --resume continues

rl/folder.py describes config.yaml, evaluations.npz, progress.csv and events.out.*.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from botschool.errors import BotschoolError
from botschool.rl.folder import Evaluations, RunFolder, next_folder
from botschool.rl.native import files
from botschool.rl.native.log import Log
from botschool.rl.settings import Settings
from botschool.seeds import POST_EVALUATION_SEED

SAVE_SECONDS = 60.0
"""Seconds between two checkpoints; each post-evaluation writes one, too."""

REPORT_SECONDS = 0.2

Report = Callable[[int, Evaluations], None]


def learn(
    settings: Settings,
    folder: Path,
    report: Report,
    started: Callable[[RunFolder], None] = lambda run: None,
    stopping: Callable[[], bool] = lambda: False,
    events: Path | None = None,
    threads: int = 1,
) -> tuple[RunFolder, Evaluations]:
    """Train in a new folder, as botschool.rl.training.learn does."""
    ppo = files.make(settings, threads)
    run = next_folder(folder, settings.algo, settings.env)
    settings.save(run.config)
    started(run)
    return run, _Watched(run, settings, ppo, report, stopping, events).learn()


def resume(
    run: RunFolder,
    report: Report,
    stopping: Callable[[], bool] = lambda: False,
    threads: int = 1,
) -> Evaluations:
    """Continue a training from its checkpoint, as if never interrupted."""
    settings = run.settings()
    arrays = files.load_checkpoint(run.path)
    watched = _Watched(run, settings, files.make(settings, threads), report, stopping, None, True)
    try:
        watched.restore(arrays)
    except (ValueError, KeyError, IndexError, TypeError) as error:
        raise BotschoolError(
            f"{run.path / files.CHECKPOINT} is not a checkpoint of this training: train again."
        ) from error
    return watched.learn()


class _Watched:
    """A training with its post-evaluations, log and files."""

    def __init__(
        self, run, settings, ppo, report, stopping, events: Path | None, resumed: bool = False
    ) -> None:
        self.run, self.settings, self.ppo = run, settings, ppo
        self.report, self.stopping = report, stopping
        self.log = Log(run.path, ppo, events, resumed)
        self.found: Evaluations | None = None
        self._every = max(1, settings.steps // max(1, settings.evaluations))
        self._saved = self._reported = time.monotonic()

    def learn(self) -> Evaluations:
        if self.found is None:
            self._evaluate()
            self._save()
        while self.ppo.steps < self.settings.steps and not self.stopping():
            self._advance()
        if self.found.steps[-1] < self.ppo.steps and self.ppo.steps < self.settings.steps:
            self._save()  # the user stopped it
        return self.found

    def restore(self, arrays: dict[str, np.ndarray]) -> None:
        """Restore the training. Raises ValueError, KeyError, IndexError or TypeError before it
        changes a file.
        """
        steps, returns, lengths = (arrays[name] for name in ("steps", "returns", "lengths"))
        if returns.ndim != 2 or not returns.size or returns.shape != lengths.shape:
            raise ValueError("these are no post-evaluations")
        if steps.shape != returns.shape[:1]:
            raise ValueError("these are no post-evaluations")
        self.found = Evaluations(steps, returns, lengths)
        self.ppo.restore({n[4:]: each for n, each in arrays.items() if n.startswith("ppo_")})
        self.log.restore(arrays)

    def _advance(self) -> None:
        ppo = self.ppo
        ppo.collect()
        try:
            found = ppo.update()
        except BotschoolError as error:
            raise BotschoolError(f"{str(error).rstrip('.')} ({self.run.path}).") from error
        named = self.log.indicators(found)
        now, end = time.monotonic(), ppo.steps >= self.settings.steps
        due = ppo.steps // self._every > self.found.steps[-1] // self._every
        if due or end:
            returns, lengths = self._evaluate()
            named["eval/mean_reward"] = float(returns.mean())
            named["eval/mean_ep_length"] = float(lengths.mean())
        self.log.add(named)
        if due or end or now - self._saved > SAVE_SECONDS:
            self._save()
        elif now - self._reported > REPORT_SECONDS:
            self.report(ppo.steps, self.found)
            self._reported = now

    def _evaluate(self) -> tuple[np.ndarray, np.ndarray]:
        """Play the post-evaluation episodes of an evolutionary run with this seed."""
        episodes = np.arange(self.settings.episodes, dtype=np.uint32)
        seeds = np.full(len(episodes), self.settings.seed + POST_EVALUATION_SEED, dtype=np.uint64)
        returns, lengths = self.ppo.core.play(seeds, episodes)
        best = -np.inf if self.found is None else self.found.best
        self.found = Evaluations.after(self.found, self.ppo.steps, returns, lengths)
        if returns.mean() >= best:  # of two equal ones, keep the one that was trained longer
            files.save_model(self.ppo, self.run.path / "best_model.npz")
        self.run.save_evaluations(self.found)
        self.report(self.ppo.steps, self.found)
        return returns, lengths

    def _save(self) -> None:
        files.save_model(self.ppo, self.run.path / "last_model.npz")
        found = self.found
        arrays = {"steps": found.steps, "returns": found.returns, "lengths": found.lengths}
        arrays |= {f"ppo_{name}": each for name, each in self.ppo.state().items()}
        files.save_checkpoint(self.run.path, arrays | self.log.state())
        self._saved = time.monotonic()
