"""Step the arenas of wheeled robots by hand: `make("discrim")`, `make("predprey")`, or a declared
one, `make(Plan(...))` (botschool.arenas.plan).

    arena = make("discrim")
    arena.reset(seed=1)
    arena.action = [0.8, 1.0]           # left and right wheel, shares of the greatest speed
    while not arena.done:
        reward = arena.step()

Lengths are in mm, angles in radians, counter-clockwise from the x axis, and a step lasts 0.1 s.
Evolution runs whole episodes in C++ (botschool.problems) with the same steps. The world itself is
in lib/arena/robots (docs/specification.md, "Wheeled robots").
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from numbers import Integral, Real
from typing import Any

import numpy as np

from botschool import _core
from botschool.arenas import robots, samples
from botschool.arenas.plan import PROBLEM, Cylinder, Light, Plan, Robot, Wall, Zone
from botschool.errors import BotschoolError
from botschool.inifile import nearest, shown

__all__ = ["Arena", "Cylinder", "Light", "Plan", "Robot", "Wall", "Zone", "make"]

_TASKS = {
    info["name"].removeprefix("Er").lower(): info
    for info in _core.native_problems()
    if "plan" in info
}


class Arena:
    """An arena with its robots; call `make` to get one.

    The arrays belong to the arena and stay the same objects: write into them, or assign to them,
    which copies. Using an impossible state, such as a robot inside a wall, raises BotschoolError.
    """

    def __init__(
        self, name: str, max_steps: int | None, noise, wall_table, round_table, models, plan=None
    ) -> None:
        info = _TASKS[name]
        self.name = name
        self.problem: str = info["name"]
        """Name of the problem in experiment files."""
        self.plan: Plan | None = plan
        """The plan of a declared arena, else None."""
        own_limit = plan.steps if plan else info["limit"]
        self.max_steps = _max_steps(own_limit if max_steps is None else max_steps)
        self.models = plan.models if plan else robots.cast(name, info["plan"], models)
        """The model of each robot (arenas.robots.RobotModel)."""
        self.width: float = plan.width if plan else info["plan"]["width"]
        self.height: float = plan.height if plan else info["plan"]["height"]
        self.cylinders: int = len(plan.cylinders) if plan else info["plan"]["cylinders"]
        """Number of rows of `objects` that are cylinders; the others are walls."""
        self.steps = 0
        """Steps done in this episode."""
        self.done = False
        """Whether the episode has ended."""
        self.terminated = False
        """Whether the episode has ended for another reason than `max_steps`."""
        self._stepper = _core.make_stepper(self.problem)
        tables = [None if t is None else samples.load(t).core() for t in (wall_table, round_table)]
        chosen = [model.name for model in self.models]
        core = plan.core if plan else None
        options = _core.ArenaOptions(chosen, _noise(noise), *tables, core)
        self._stepper.set(self.max_steps, options)
        self._seed, self._episode = 0, -1
        self._state = self._stepper.state
        # indices in the state where cylinders, lights and zones begin
        self._first = plan.firsts if plan else {"cylinder": 3 * len(self.models)}
        self._robots = np.zeros((len(self.models), 3))
        self._lights = np.zeros((len(plan.lights) if plan else 0, 2))
        self._zones = np.zeros((len(plan.zones) if plan else 0, 2))
        self._objects = self._stepper.objects
        self._observation = np.zeros(len(self._stepper.observation))
        self._action = np.zeros(len(self.models) * info["outputs"])
        self.reset(seed=0)

    @property
    def observation(self) -> np.ndarray:
        """Return the robots' observations, one robot after another, float64.

        A robot has 8 values in "discrim", 24 in "predprey", 32 in "staybehind"; in a declared
        arena, its sensors determine the number. reset(), step() and sense() update the array.
        """
        return self._observation

    @property
    def action(self) -> np.ndarray:
        """Return the wheels' speeds, one robot after another, float64, shape (2 * robots,).

        Left and right are shares of the greatest speed, usually -1 to 1. In "staybehind" the two
        numbers are speed and direction. step() reads the array and does not change it.
        """
        return self._action

    @action.setter
    def action(self, values) -> None:
        self._action[:] = _matching("The action", values, self._action)

    @property
    def robots(self) -> np.ndarray:
        """Return the poses, float64, (robots, 3): x, y, heading. Write here to move a robot."""
        return self._robots

    @robots.setter
    def robots(self, poses) -> None:
        self._robots[:] = _matching("robots", poses, self._robots)

    @property
    def objects(self) -> np.ndarray:
        """Return cylinders, then walls, float64, shape (objects, 5): rows x, y, x2, y2, radius.

        A cylinder's x2 and y2 are 0, and so is a wall's radius. reset() places the cylinders anew;
        the rest keeps your values.
        """
        return self._objects

    @objects.setter
    def objects(self, rows) -> None:
        self._objects[:] = _matching("objects", rows, self._objects)

    @property
    def lights(self) -> np.ndarray:
        """Return the positions of a declared arena's lights, float64, shape (lights, 2). Write here
        to move a light; reset() places all anew.
        """
        return self._lights

    @lights.setter
    def lights(self, places) -> None:
        self._lights[:] = _matching("lights", places, self._lights)

    @property
    def zones(self) -> np.ndarray:
        """Return the positions of the zones; see lights."""
        return self._zones

    @zones.setter
    def zones(self, places) -> None:
        self._zones[:] = _matching("zones", places, self._zones)

    @property
    def state(self) -> np.ndarray:
        """Return the state that scenes draw: x, y, heading of robots, x, y of cylinders, steps.

        In "staybehind" it also holds, before the steps, which robot is blocked.
        docs/specification.md, "Declared arenas", describes the state of a declared arena.
        """
        state = self._state.copy()
        for first, values in self._parts():
            state[first : first + values.size] = values.ravel()
        state[-1] = self.steps
        return state

    def _parts(self) -> list[tuple[int, np.ndarray]]:
        """Return the arrays that a user can move: index in the state, and positions."""
        parts = [(0, self._robots), (self._first["cylinder"], self._objects[: self.cylinders, :2])]
        if self.plan:
            parts += [(self._first["light"], self._lights), (self._first["zone"], self._zones)]
        return parts

    def reset(self, seed: int | None = None, episode: int = 0) -> np.ndarray:
        """Start an episode and return the observation.

        Seed and episode determine everything random in it, as in evolution. Without a seed, the
        next episode of the previous seed starts.
        """
        if seed is None:
            seed, episode = self._seed, self._episode + 1
        for name, value, most in (("seed", seed, 2**64), ("episode", episode, 2**32)):
            if not isinstance(value, Integral) or not 0 <= value < most:
                raise BotschoolError(
                    f"The {name} is a whole number from 0 to {most - 1}, not {shown(value)}."
                )
        self._seed, self._episode = int(seed), int(episode)
        self._stepper.start(self._seed, self._episode)
        self._take(self._stepper.state)
        self.done = self.terminated = False
        return self.sense()

    def sense(self) -> np.ndarray:
        """Update and return the observation from the present poses; nothing moves."""
        self._place()
        self._observation[:] = self._stepper.observation
        return self._observation

    def step(self) -> float:
        """Move the robots by `action` from their present poses, and return the reward.

        In "predprey" it is the predator's reward, otherwise the reward of all robots. The sensors'
        noise depends on seed, episode and step. You can also call it after the episode's end;
        `done` stays True until reset().
        """
        _finite("action", self._action)
        self._place()
        reward, ended = self._stepper.step(self._action)
        self._take(self._stepper.state)
        self.terminated |= ended
        self.done = self.terminated or self.steps >= self.max_steps
        self._observation[:] = self._stepper.observation
        return reward

    def _take(self, state: np.ndarray) -> None:
        self._state = state
        for first, values in self._parts():
            values[:] = state[first : first + values.size].reshape(values.shape)
        self.steps = int(state[-1])

    def _place(self) -> None:
        """Put robots and objects where the arrays say. Raises BotschoolError if they do not fit."""
        _finite("robots", self._robots)
        _finite("lights", self._lights)
        _finite("zones", self._zones)
        self._check_objects()
        self._stepper.objects = self._objects
        self._stepper.state = self.state
        robot = self._stepper.blocked()
        if robot >= 0:
            x, y, _ = self._robots[robot]
            raise BotschoolError(
                f"Robot {robot}, of radius {self.models[robot].radius:g} mm, cannot be at "
                f"({x:.1f}, {y:.1f}): it would overlap a wall, a cylinder or another robot."
            )

    def _check_objects(self) -> None:
        _finite("objects", self._objects)
        for row, (_, _, x2, y2, radius) in enumerate(self._objects):
            if row >= self.cylinders:
                if radius != 0:
                    raise BotschoolError(
                        f"Row {row} of objects is a wall, whose radius is 0, not {radius:g}."
                    )
            elif radius <= 0:
                raise BotschoolError(
                    f"Row {row} of objects is a cylinder: its radius must be above 0 mm, "
                    f"not {radius:g}."
                )
            elif x2 != 0 or y2 != 0:
                raise BotschoolError(
                    f"Row {row} of objects is a cylinder: its x2 and y2 must be 0, "
                    f"not {x2:g} and {y2:g}."
                )


def make(
    name: str | Plan,
    max_steps: int | None = None,
    noise: float | None = None,
    wall_table: str | os.PathLike[str] | None = None,
    round_table: str | os.PathLike[str] | None = None,
    models: Sequence[str] = (),
) -> Arena:
    """Return the arena of a task, at the start of episode 0 of seed 0.

    "discrim": a Khepera, a cylinder. "predprey": two marXbots, the predator first. "staybehind":
    two marXbots, the follower first. A Plan (botschool.arenas.plan): the arena that it declares;
    `config.load(FILE).plan` is the plan of a file.

    max_steps: longest episode; None means the task's own (500, 2000, 500). noise: standard
    deviation of the infrared readings; None means the task's own (0.03, 0, 0). wall_table,
    round_table: `.sample` files (botschool.arenas.samples) with measured readings of walls and of
    round objects; None means the fitted model. models: names of other robots ("e-puck"), one for
    all or one each; () means the task's own. Raises BotschoolError.
    """
    if isinstance(name, Plan):
        if models:
            raise BotschoolError(
                "A declared arena takes its robots from its plan: leave out `models`."
            )
        return Arena("arena", max_steps, noise, wall_table, round_table, (), name)
    if not isinstance(name, str) or name not in _TASKS:
        near = nearest(str(name), _TASKS)
        raise BotschoolError(
            f"There is no arena '{shown(name)}': {near}{'' if near.endswith('?') else '.'}"
        )
    if isinstance(models, str):
        models = (models,)
    plan = Plan() if _TASKS[name]["name"] == PROBLEM else None
    if plan and models:
        named: Any = tuple(models)
        plan = Plan(robots=named)
        models = ()
    return Arena(name, max_steps, noise, wall_table, round_table, tuple(models), plan)


def _max_steps(value) -> int:
    if not isinstance(value, Integral) or not 1 <= int(value) < 2**31:
        raise BotschoolError(f"max_steps is a whole number of at least 1, not {shown(value)}.")
    return int(value)


def _noise(value) -> float | None:
    if value is None:
        return None
    if not isinstance(value, Real) or not 0 <= float(value) < np.inf:
        raise BotschoolError(f"noise is a standard deviation of at least 0, not {shown(value)}.")
    return float(value)


def _matching(what: str, values, array: np.ndarray) -> np.ndarray:
    """Return the values as numbers of the array's shape."""
    try:
        given = np.asarray(values)
    except ValueError:
        given = np.zeros(0)
    if given.dtype.kind not in "fiub" or given.shape != array.shape:
        raise BotschoolError(
            f"{what} needs {' x '.join(map(str, array.shape))} numbers, "
            f"but was given {shown(' '.join(str(values).split()))}."
        )
    return given


def _finite(name: str, array: np.ndarray) -> None:
    if not np.isfinite(array).all():
        place = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        index = ", ".join(map(str, place))
        raise BotschoolError(f"{name}[{index}] is {array[place]}, but must be a finite number.")
