"""Define callbacks for training: post-evaluate, save, log more indicators, stop."""

from __future__ import annotations

import sys
import time
from collections import deque
from collections.abc import Callable

import numpy as np
from gymnasium import spaces
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.on_policy_algorithm import OnPolicyAlgorithm

from botschool.problems.base import Interrupted
from botschool.rl.agent import Agent, play, save_model
from botschool.rl.environments import LONGEST_EPISODE, endless, make
from botschool.rl.folder import Evaluations, RunFolder
from botschool.rl.settings import Settings
from botschool.seeds import POST_EVALUATION_SEED

SAVE_SECONDS = 60.0
"""Seconds between two saves of the last model; each post-evaluation saves it, too."""

PATIENCE = 0.5
"""Seconds that a post-evaluation may still take when the user stops the training."""

REPORT_SECONDS = 0.2
RECENT = 100
"""Number of recent episodes (and of steps of each environment) that the indicators cover."""

Report = Callable[[int, Evaluations], None]
"""A function that is called with the steps and the evaluations so far."""


class Stopped(Exception):
    """Raised to end a training whose algorithm ignores what callbacks return."""


class PostEvaluation(BaseCallback):
    """Measure the policy on fixed fresh seeds, keep the best one, and save the last one.

    The episodes have the seeds of an evolutionary run with the same seed: seed + 100000 + t.
    Neither post-evaluating nor saving changes what is learned.
    """

    def __init__(
        self,
        run: RunFolder,
        settings: Settings,
        report: Report,
        stopping: Callable[[], bool],
        hurrying: Callable[[], bool],
    ) -> None:
        """Prepare the episodes; hurrying: whether the user waits for the end of the training."""
        super().__init__()
        self._hurrying, self._asked, self._looked = hurrying, 0.0, 0.0
        self.run, self.settings = run, settings
        self.report, self.stopping = report, stopping
        self.found: Evaluations | None = None
        first = settings.seed + POST_EVALUATION_SEED
        self._seeds = list(range(first, first + settings.episodes))
        self._envs = [make(settings.env, settings.wrappers, **settings.own) for _ in self._seeds]
        self._every = max(1, settings.steps // max(1, settings.evaluations))
        self._saved = self._reported = time.monotonic()

    def _on_training_start(self) -> None:
        self._evaluate()

    def _on_step(self) -> bool:
        steps, now = self.num_timesteps, time.monotonic()
        if self.found is None:
            raise Stopped
        due = steps // self._every > self.found.steps[-1] // self._every
        if due and steps < self.settings.steps:
            self._evaluate()
        elif now - self._saved > SAVE_SECONDS:
            self.save()
        elif now - self._reported > REPORT_SECONDS:
            self.report(steps, self.found)
            self._reported = now
        if self.stopping() and self.settings.algo == "ars":
            raise Stopped
        return not self.stopping()

    def _on_training_end(self) -> None:
        self._evaluate()
        self.logger.dump(self.num_timesteps)

    def save(self) -> None:
        """Save the last model."""
        save_model(self.model, self.run.last)
        self._saved = time.monotonic()

    def close(self) -> None:
        """Close the environments."""
        for env in self._envs:
            env.close()

    def _evaluate(self) -> None:
        scaling = self.model.get_vec_normalize_env()
        agent = Agent(self.model, None if scaling is None else scaling.normalize_obs)
        try:
            returns, lengths = play(agent, self._envs, self._seeds, self._late)
        except Interrupted:  # these episodes do not count
            self.save()
            return
        if self.found is None and endless(self._envs[0]) and lengths.max() == LONGEST_EPISODE:
            print(
                f"note: {self.settings.env} sets no limit to its episodes: they are cut "
                f"after {LONGEST_EPISODE} steps. Another limit: "
                '--wrapper "TimeLimit(max_episode_steps=N)"',
                file=sys.stderr,
            )
        best = -np.inf if self.found is None else self.found.best
        self.found = Evaluations.after(self.found, self.num_timesteps, returns, lengths)
        if returns.mean() >= best:  # of two equal ones, keep the one that was trained longer
            save_model(self.model, self.run.best)
        self.save()
        self.run.save_evaluations(self.found)
        self.logger.record("eval/mean_reward", float(returns.mean()))
        self.logger.record("eval/mean_ep_length", float(lengths.mean()))
        self.logger.record("time/total_timesteps", self.num_timesteps, exclude="tensorboard")
        self.report(self.num_timesteps, self.found)

    def _late(self) -> bool:
        """Return whether the user has waited for PATIENCE seconds."""
        now = time.monotonic()
        if now < self._looked + 0.05:
            return False
        self._looked = now
        if not self._hurrying():
            self._asked = now
        return now > self._asked + PATIENCE


class Patience(BaseCallback):
    """Let hindsight experience replay begin to learn once an episode has ended, not before."""

    ended = False

    def _on_step(self) -> bool:
        if not self.ended:
            self.model.learning_starts = max(self.model.learning_starts, self.num_timesteps)
            self.ended = bool(np.any(self.locals["dones"]))
        return True

    def _on_training_end(self) -> None:
        if not self.ended:
            print(
                f"note: no episode ended within {self.num_timesteps} steps, so her has learned "
                "nothing: give it more --steps, or end episodes earlier",
                file=sys.stderr,
            )


class Indicators(BaseCallback):
    """Log what Stable-Baselines3 does not: discounted return, advantages, chosen actions.

    `rollout/discounted_return` is the mean over the last episodes, without normalisation.
    `rollout/advantage` and `actions/...` are histograms over the last rollout, with mean and
    standard deviation. A discrete action is logged as the frequency of each choice.
    """

    def _on_training_start(self) -> None:
        n = self.training_env.num_envs
        self._total, self._discount = np.zeros(n), np.ones(n)
        self._episodes: deque[float] = deque(maxlen=RECENT)
        on_policy = isinstance(self.model, OnPolicyAlgorithm)
        self._window = self.model.n_steps if on_policy else RECENT
        self._actions: deque[np.ndarray] = deque(maxlen=self._window)
        self._calls = 0

    def _on_step(self) -> bool:
        scaling = self.model.get_vec_normalize_env()
        rewards = self.locals["rewards"] if scaling is None else scaling.get_original_reward()
        self._total += self._discount * rewards
        self._discount *= self.model.gamma
        ended = np.asarray(self.locals["dones"], dtype=bool)
        self._episodes.extend(self._total[ended].tolist())
        self._total[ended], self._discount[ended] = 0.0, 1.0
        self._actions.append(np.array(self.locals["actions"]))
        self._calls += 1
        if self._calls % self._window == 0:
            self._record_actions()
            if self._episodes:
                self.logger.record("rollout/discounted_return", float(np.mean(self._episodes)))
        return True

    def _on_rollout_end(self) -> None:
        if isinstance(self.model, OnPolicyAlgorithm):
            self._record("rollout/advantage", self.model.rollout_buffer.advantages)

    def _record_actions(self) -> None:
        actions, space = np.concatenate(self._actions), self.model.action_space
        if isinstance(space, spaces.Discrete):
            counts = np.bincount(actions.ravel().astype(int), minlength=int(space.n))
            for action, frequency in enumerate(counts / counts.sum()):
                self.logger.record(f"actions/frequency_{action}", float(frequency))
            self.logger.record("actions/chosen", actions.ravel(), exclude="csv")
            return
        for i, values in enumerate(actions.reshape(len(actions), -1).T):
            self._record(f"actions/{i}", values)

    def _record(self, name: str, values: np.ndarray) -> None:
        self.logger.record(name, np.asarray(values, dtype=np.float64).ravel(), exclude="csv")
        self.logger.record(f"{name}_mean", float(np.mean(values)))
        self.logger.record(f"{name}_std", float(np.std(values)))
