"""Define the common rules of predator and prey (ErPredprey), and make one side a Gymnasium
environment with a fixed opponent: botschool/Predator-v0 and botschool/Prey-v0.
"""

from __future__ import annotations

import os
from dataclasses import replace
from typing import ClassVar

import gymnasium
import numpy as np
from gymnasium import spaces

from botschool import config
from botschool.config import PolicyConfig
from botschool.envs.simulation import RENDER_MODES, Simulation
from botschool.errors import BotschoolError, said
from botschool.npy import NotNumbers, read_numbers
from botschool.policies.policy import Interface, Policy
from botschool.problems.native import INFOS

PROBLEM = "ErPredprey"
ROBOTS = ("predator", "prey")
FPS = round(1 / INFOS[PROBLEM]["seconds"])
_SEES, _WHEELS = INFOS[PROBLEM]["observations"], INFOS[PROBLEM]["outputs"]

POLICY = PolicyConfig(nhiddens=25, bias=1, architecture=3)
"""Default network of the opponent, as in predprey.ini."""


def observation_space() -> spaces.Box:
    """Return the space of one robot's observation: infrared, camera, ground, elapsed time, 1."""
    return spaces.Box(0.0, 1.0, (_SEES,), np.float32)


def action_space() -> spaces.Box:
    """Return the space of one robot's left and right wheel."""
    return spaces.Box(-1.0, 1.0, (_WHEELS,), np.float32)


def wheels(robot: str, action) -> np.ndarray:
    """Return a robot's action. Raises BotschoolError unless it has two numbers."""
    given = np.asarray(action)
    if given.shape != (_WHEELS,) or given.dtype.kind not in "fiub":
        raise BotschoolError(
            f"An action of the {robot} has {_WHEELS} numbers, but this one is {given.tolist()}."
        )
    return given


class PredpreySimulation(Simulation):
    """Both robots. The returns of predator and prey add up to 1."""

    def __init__(self, max_steps: int | None, render_mode: str | None) -> None:
        super().__init__(PROBLEM, render_mode, max_steps)

    def views(self) -> list[np.ndarray]:
        """Return the predator's and the prey's observation, float32."""
        return np.split(self.observation.astype(np.float32), 2)

    def act(self, predator: np.ndarray, prey: np.ndarray) -> tuple[tuple[float, float], bool]:
        """Let both act; return (the predator's and the prey's reward, whether the episode is over).

        The predator gets 1 - step / max_steps when it catches the prey, else 0; in the last step,
        the prey gets 1 minus the predator's return. When time runs out, the episode terminates and
        is not truncated, because the robots observe the remaining time and this step brings the
        prey its reward.
        """
        caught, ended = self.step(np.concatenate([predator, prey]))
        over = ended or self.steps >= self.limit
        return (caught, 1.0 - caught if over else 0.0), over


class OneSide(gymnasium.Env):
    """One of the two robots against an opponent that does not learn.

    side: "predator" or "prey". opponent: its genotype as a run saves it (float64 array, or the path
    of a .npy file) with the network of one side or of both (then the opponent's counts); None means
    a random initial network, always the same. experiment: the .ini file whose [POLICY] the genotype
    evolved with, None for data/experiments/predprey.ini. max_steps: longest episode, None for the
    problem's own. PredpreySimulation.act defines the rewards. Raises BotschoolError.
    """

    metadata: ClassVar[dict] = {"render_modes": RENDER_MODES, "render_fps": FPS}

    def __init__(
        self,
        side: str,
        opponent: str | os.PathLike[str] | np.ndarray | None = None,
        experiment: str | os.PathLike[str] | None = None,
        max_steps: int | None = None,
        render_mode: str | None = None,
    ) -> None:
        self.render_mode = render_mode
        self.observation_space, self.action_space = observation_space(), action_space()
        self._side = ROBOTS.index(side)
        self._policy = _policy(experiment)
        self._policy.load(*_network(self._policy, opponent, 1 - self._side))
        self._simulation = PredpreySimulation(max_steps, render_mode)

    def reset(self, *, seed: int | None = None, options: dict | None = None):
        super().reset(seed=seed)
        self._policy.reset(self._simulation.start(self.np_random), 0)
        self._simulation.show()
        return self._simulation.views()[self._side], {}

    def step(self, action: np.ndarray):
        own = wheels(ROBOTS[self._side], action)
        theirs = self._policy.act(self._simulation.views()[1 - self._side])
        pair = (own, theirs) if self._side == 0 else (theirs, own)
        rewards, over = self._simulation.act(*pair)
        self._simulation.show()
        return self._simulation.views()[self._side], rewards[self._side], over, False, {}

    def render(self) -> np.ndarray | None:
        return self._simulation.render()

    def close(self) -> None:
        self._simulation.close()


def _policy(experiment: str | os.PathLike[str] | None) -> Policy:
    """Return the opponent's policy as the policy of a single robot."""
    chosen = POLICY if experiment is None else config.load(experiment).policy
    alone = replace(chosen, nrobots=1, heterogeneous=0)
    return Policy(PROBLEM, Interface(_SEES, _WHEELS, discrete=False), alone)


def _network(policy: Policy, opponent, robot: int) -> tuple[np.ndarray, np.ndarray | None]:
    """Return (parameters, normalisation) of that robot's network."""
    if opponent is None:
        return policy.initial(1), np.repeat([0.0, 1.0], _SEES) if policy.spec.normalize else None
    saved = opponent if isinstance(opponent, np.ndarray) else _saved(opponent)
    one = policy.genotype_size
    vectors = 2 * _SEES if policy.spec.normalize else 0
    if saved.shape == (2 * one + vectors,):
        own = saved[robot * one : (robot + 1) * one]
        saved = np.concatenate([own, saved[2 * one :]])
    return policy.split(saved)


def _saved(path: str | os.PathLike[str]) -> np.ndarray:
    try:
        return read_numbers(path)
    except FileNotFoundError:
        raise BotschoolError(f"There is no opponent's genotype {path}.") from None
    except (OSError, NotNumbers) as error:
        raise BotschoolError(f"{path} is not a genotype: {said(error)}.") from None
