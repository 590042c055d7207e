"""Define wrappers around environments, for `wrappers` in an experiment file."""

from __future__ import annotations

import gymnasium


class AliveBonus(gymnasium.Wrapper):
    """Adds `bonus` to the reward of each step that does not terminate the episode.

    A robot that loses reward at every step learns to fall early, which ends the loss. With the
    bonus it first learns to stay up, and then, if progress earns more than standing, to walk.
    """

    def __init__(self, env: gymnasium.Env, bonus: float = 1.0) -> None:
        super().__init__(env)
        self.bonus = float(bonus)

    def step(self, action):
        """Make one step, and add the bonus unless it terminates the episode."""
        observation, reward, terminated, truncated, info = self.env.step(action)
        if not terminated:
            reward += self.bonus
        return observation, reward, terminated, truncated, info


class LimbsApart(gymnasium.Wrapper):
    """Lets the parts of a robot of MuJoCo touch the ground only, and not each other."""

    def __init__(self, env: gymnasium.Env) -> None:
        """Let parts collide only with what collides with everything: geom 0, the ground."""
        super().__init__(env)
        self.unwrapped.model.geom_conaffinity[1:] = 0
