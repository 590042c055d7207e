"""Offer predator and prey (ErPredprey) to PettingZoo: two agents that act at the same time."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from gymnasium import spaces
from gymnasium.utils import seeding

from botschool.envs.predprey_sides import (
    FPS,
    ROBOTS,
    PredpreySimulation,
    action_space,
    observation_space,
    wheels,
)
from botschool.envs.simulation import RENDER_MODES
from botschool.errors import BotschoolError

try:
    from pettingzoo import ParallelEnv
except ImportError:
    raise BotschoolError(
        "botschool.envs.predprey needs pettingzoo: install it with "
        "`pip install 'botschool[pettingzoo]'`."
    ) from None


class PredPrey(ParallelEnv):
    """Agents `predator` and `prey`; see parallel_env."""

    metadata: ClassVar[dict] = {
        "render_modes": RENDER_MODES,
        "render_fps": FPS,
        "name": "predprey_v0",
        "is_parallelizable": True,
    }

    def __init__(self, max_steps: int | None = None, render_mode: str | None = None) -> None:
        self.render_mode = render_mode
        self.possible_agents = list(ROBOTS)
        self.agents: list[str] = []
        self.observation_spaces = {agent: observation_space() for agent in ROBOTS}
        self.action_spaces = {agent: action_space() for agent in ROBOTS}
        self._simulation = PredpreySimulation(max_steps, render_mode)
        self._random: np.random.Generator | None = None

    def observation_space(self, agent: str) -> spaces.Box:
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> spaces.Box:
        return self.action_spaces[agent]

    def reset(self, seed: int | None = None, options: dict | None = None):
        if seed is not None or self._random is None:
            self._random, _ = seeding.np_random(seed)
        self._simulation.start(self._random)
        self.agents = list(ROBOTS)
        self._simulation.show()
        return _each(self._simulation.views()), {agent: {} for agent in ROBOTS}

    def step(self, actions: dict[str, np.ndarray]):
        if not self.agents:
            raise BotschoolError("The episode has ended: start another one with reset().")
        for agent in ROBOTS:
            if agent not in actions:
                raise BotschoolError(f"Both robots act in a step, but the {agent} has no action.")
        rewards, over = self._simulation.act(*(wheels(agent, actions[agent]) for agent in ROBOTS))
        self._simulation.show()
        if over:
            self.agents = []
        return (
            _each(self._simulation.views()),
            _each(rewards),
            dict.fromkeys(ROBOTS, over),
            dict.fromkeys(ROBOTS, False),
            {agent: {} for agent in ROBOTS},
        )

    def state(self) -> np.ndarray:
        """Return x, y and heading of predator and prey, then the steps done; float64."""
        return self._simulation.state

    def render(self) -> np.ndarray | None:
        return self._simulation.render()

    def close(self) -> None:
        self._simulation.close()


def _each(values) -> dict:
    return dict(zip(ROBOTS, values, strict=True))


def parallel_env(max_steps: int | None = None, render_mode: str | None = None) -> PredPrey:
    """Return the environment. max_steps: longest episode, None for the problem's own 2000.

    Observations are float32 (24,), actions (2,) from -1 to 1; PredpreySimulation.act defines the
    rewards.
    """
    return PredPrey(max_steps, render_mode)
