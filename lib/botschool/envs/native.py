"""Make native problems of one robot Gymnasium environments: botschool/Discrim-v0 and others."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium import spaces

from botschool import config
from botschool.arenas.plan import PROBLEM, Plan
from botschool.envs.simulation import RENDER_MODES, Simulation
from botschool.errors import BotschoolError
from botschool.problems.native import INFOS
from botschool.wrappers import bare, spelled


class NativeEnv(gymnasium.Env):
    """A native problem with one robot; the same world as in evolution, in double precision.

    Observations are float32, as evolution's policies get them. Actions are one number per actuator
    within the problem's range, or the index of a discrete problem's action. The problem can end an
    episode early; gymnasium.make adds the TimeLimit that truncates it. The seed of reset()
    determines everything random.

    problem: its name in experiment files, such as ErDiscrim. noise: standard deviation of an
    arena's infrared readings; None means the problem's own. robots: kinds of its wheeled robots, ()
    means the problem's own. morphology: parameters of an evolved body, None for zeros. arena: for
    ErArena, a botschool.arena.Plan with one robot, or an experiment file with a section [ARENA];
    None means the default plan. reward, ends: expressions in place of the problem's own reward and
    end of episodes; physics: numbers of a runner's world. Others are options of the problem, as
    files take them: slope=0.1. Raises BotschoolError.
    """

    metadata: ClassVar[dict] = {"render_modes": RENDER_MODES}

    def __init__(
        self,
        problem: str,
        render_mode: str | None = None,
        noise: float | None = None,
        robots: Sequence[str] = (),
        morphology: np.ndarray | None = None,
        arena: Plan | str | os.PathLike[str] | None = None,
        options: str = "",
        reward: str = "",
        ends: str = "",
        physics: str = "",
        **named: Any,
    ) -> None:
        self.render_mode = render_mode
        if noise is not None and "plan" not in INFOS[problem] and problem != PROBLEM:
            named["noise"], noise = noise, None
        if named:
            written = {name: repr(bare(value)) for name, value in named.items()}
            options = ", ".join(filter(None, [options, spelled(written)]))
        plan = arena if isinstance(arena, Plan) or arena is None else config.load(arena).plan
        if plan is None and arena is not None:
            raise BotschoolError(f"{arena} has no section [ARENA].")
        self._simulation = Simulation(
            problem,
            render_mode,
            noise=noise,
            robots=robots,
            plan=plan,
            options=options,
            reward=reward,
            ends=ends,
            physics=physics,
        )
        if self._simulation.interface.robots > 1:
            raise BotschoolError(
                f"A Gymnasium environment has one robot, but this arena has {len(plan.robots)}."
            )
        info, interface = self._simulation.info, self._simulation.interface
        own: Any = self  # each environment has its own
        own.metadata = self.metadata | {"render_fps": round(1 / info["seconds"])}
        far = np.finfo(np.float32).max
        low, high = np.clip(self._simulation.bounds, -far, far).astype(np.float32)
        self.observation_space = spaces.Box(low, high)
        if info["discrete"]:
            self.action_space = spaces.Discrete(info["outputs"])
        else:
            shape = (interface.outputs,)
            self.action_space = spaces.Box(info["low"], info["high"], shape, np.float32)

        self.morphology_size = info["body"]
        if morphology is not None:
            self.set_morphology(morphology)

    def set_morphology(self, parameters: np.ndarray) -> None:
        """Set the body of all episodes from the next reset on, `morphology_size` finite numbers."""
        p = np.asarray(parameters)
        if (
            p.shape != (self.morphology_size,)
            or p.dtype.kind not in "fiu"
            or not np.isfinite(p).all()
        ):
            raise BotschoolError(
                f"A morphology here is {self.morphology_size} finite numbers, not {p.tolist()!r}."
            )
        self._simulation.set_body(p)

    def reset(self, *, seed: int | None = None, options: dict | None = None):
        super().reset(seed=seed)
        self._simulation.start(self.np_random)
        self._simulation.show()
        return self._observation(), {}

    def step(self, action: np.ndarray):
        action = np.asarray(action)
        space = self.action_space
        if action.shape != space.shape or action.dtype.kind not in "fiub":
            wanted = "is one whole number" if space.shape == () else f"has {space.shape[0]} numbers"
            raise BotschoolError(f"An action {wanted}, but this one is {action.tolist()}.")
        if isinstance(space, spaces.Discrete) and action not in range(space.n):
            raise BotschoolError(f"An action is 0 to {space.n - 1}, not {action.tolist()}.")
        reward, ended = self._simulation.step(np.ravel(action))
        self._simulation.show()
        return self._observation(), reward, ended, False, {}

    def render(self) -> np.ndarray | None:
        return self._simulation.render()

    def close(self) -> None:
        self._simulation.close()

    def _observation(self) -> np.ndarray:
        return self._simulation.observation.astype(np.float32)
