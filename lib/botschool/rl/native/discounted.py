"""Compute the discounted returns of episodes from the rollouts of a training."""

from __future__ import annotations

import numpy as np

from botschool.rl.native.ppo import PPO


class DiscountedReturns:
    """Sums gamma^k * reward over episodes that may last for several rollouts.

    A rollout with normalised rewards holds them divided by a running deviation. This class
    multiplies by it again, taking its change within a rollout as linear. In the first rollout it
    changes too fast: episodes that begin there are left out.
    """

    def __init__(self, ppo: PPO) -> None:
        self.carried = np.zeros((4, ppo.n_envs))
        """Of each environment's present episode: whether it is left out, steps, return, discounted
        return."""
        self._ppo = ppo
        gamma = ppo.hyperparameters.gamma
        self._powers = np.cumprod([1.0, *[gamma] * ppo.limit])
        self._deviation = self._deviation_now()

    def add(self, returns: np.ndarray) -> np.ndarray:
        """Return the discounted returns of episodes that ended in the last rollout.

        returns: their returns, as PPO.episodes gives them, in the same order.
        """
        rollout = self._ppo.rollout
        ended = rollout.ended != 0
        steps = np.arange(len(ended))[:, None]
        last = np.maximum.accumulate(np.where(ended, steps, -1), axis=0)
        last = np.vstack([np.full_like(last[:1], -1), last[:-1]])
        """Step at which the environment's episode before this one ended, -1: before the rollout."""
        first = self._ppo.normalize and self._ppo.steps <= ended.size
        known = ((last >= 0) | (self.carried[0] == 0)) & (not first)
        age = steps - last - 1 + np.where(last < 0, self.carried[1], 0).astype(int)
        # where time ran out, the reward has a prediction in it: the episode's return tells the rest
        rewards = np.where(rollout.ended == 2, 0.0, rollout.rewards) * self._scale(len(ended))
        weights = self._powers[age]
        sums = [
            _within(values, carried, last)
            for values, carried in zip((rewards, rewards * weights), self.carried[2:], strict=True)
        ]
        rest = np.where(rollout.ended == 2, weights, 0.0)[ended] * (returns - sums[0][ended])
        running = [each[-1] for each in (~known, age + 1, *sums)]
        self.carried = np.where(ended[-1], 0.0, running)
        return (sums[1][ended] + rest)[known[ended]]

    def _scale(self, n: int) -> np.ndarray | float:
        """Return what the rewards of each step were divided by, (n, 1)."""
        if not self._ppo.normalize:
            return 1.0
        before, self._deviation = self._deviation, self._deviation_now()
        return np.linspace(before, self._deviation, n + 1)[1:, None]

    def _deviation_now(self) -> float:
        """Return the running deviation that divides the rewards."""
        if not self._ppo.normalize:
            return 1.0
        return float(np.sqrt(self._ppo.state()["numbers"][3] + 1e-8))

    def restore(self, carried: np.ndarray) -> None:
        """Continue a training that the PPO has restored. Raises ValueError."""
        if carried.shape != self.carried.shape:
            raise ValueError("these are not the sums of such a training")
        self.carried, self._deviation = carried.astype(np.float64), self._deviation_now()


def _within(values: np.ndarray, carried: np.ndarray, last: np.ndarray) -> np.ndarray:
    """Return running sums from each episode's start; carried: the sums before the rollout."""
    total = values.cumsum(axis=0)
    before = np.take_along_axis(total, np.maximum(last, 0), axis=0)
    return total + np.where(last < 0, carried, -before)
