"""Wrappers around environments, to be named by `wrappers` in an experiment file."""

from __future__ import annotations

import gymnasium


class AliveBonus(gymnasium.Wrapper):
    """Adds `bonus` to the reward of each step that does not terminate the episode.

    A robot that loses reward at every step learns to fall early, which ends the loss; with the
    bonus it learns to stay up first, and then, if progress earns more than standing, to go.
    """

    def __init__(self, env: gymnasium.Env, bonus: float = 1.0) -> None:
        super().__init__(env)
        self.bonus = float(bonus)

    def step(self, action):
        """One step, whose reward may have the bonus in it."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        if not terminated:
            reward += self.bonus
        return observation, reward, terminated, truncated, info
