"""The pictures of the native problems, one file each; importing this registers all of them."""

from __future__ import annotations

import pkgutil
from collections.abc import Iterator
from importlib import import_module
from typing import Any

import gymnasium
import numpy as np

from botschool.arenas.plan import Plan
from botschool.arenas.robots import RobotModel, cast
from botschool.errors import BotschoolError
from botschool.problems import Problem
from botschool.problems.native import INFOS, NATIVE
from botschool.problems.transition import Transition
from botschool.render.scene import SCENES, Scene
from botschool.render.scenes.meters import MeterScene
from botschool.render.scenes.spatial import SpatialScene

for _module in pkgutil.iter_modules(__path__):
    import_module(f"{__name__}.{_module.name}")


def make_scene(name: str, robots: tuple[RobotModel, ...] = (), plan: Plan | None = None) -> Scene:
    """Return the scene of a native problem: its own, or meters if it has none.

    robots: its wheeled robots, () for its own. plan: a declared arena. Raises BotschoolError for
    another problem.
    """
    if name not in NATIVE:
        raise BotschoolError(f"there are no pictures of {name}: choose one of {', '.join(NATIVE)}.")
    info = INFOS[NATIVE[name][0]]
    if info["name"] not in SCENES:
        return MeterScene(info)
    if "plan" in info and not robots:
        robots = cast(name, info["plan"])
    return SCENES[info["name"]](robots, plan) if plan else SCENES[info["name"]](robots)


def scene_of(problem: Any) -> Scene | None:
    """Return the scene of a problem's steps; None if they bring their own pictures."""
    if not problem.native or drawn_by_gymnasium(problem):
        return None
    if problem.robot is not None:
        scene = SpatialScene(problem.race, 1 / problem.fps, 0.0, looks=problem.robot.looks)
        return scene.stand_on(problem.race.ground)
    scene = make_scene(problem.dynamics, problem.robots, problem.plan)
    if problem.race and isinstance(scene, SpatialScene):
        scene.stand_on(problem.race.ground)
    return scene


def drawn_by_gymnasium(problem: Problem) -> bool:
    """Return whether Gymnasium has a picture of a native problem without a picture of our own.

    It is usable if the environment keeps its state in `state`, as classic control does.
    """
    if not problem.native or problem.dynamics in SCENES:
        return False
    if problem.dynamics not in gymnasium.registry:
        return False
    spec = gymnasium.spec(problem.dynamics)
    creator = gymnasium.envs.registration.load_env_creator(spec.entry_point)
    if creator.__module__.startswith("botschool."):  # our own face of it
        return False
    return "rgb_array" in getattr(creator, "metadata", {}).get("render_modes", [])


def with_frames(problem: Problem, play: Iterator[Transition]) -> Iterator[Transition]:
    """Yield the steps of an episode, with Gymnasium's pictures if it draws the problem."""
    if not drawn_by_gymnasium(problem):
        yield from play
        return
    env = gymnasium.make(problem.dynamics, render_mode="rgb_array", disable_env_checker=True)
    try:
        env.reset(seed=0)
        size = len(np.ravel(env.unwrapped.state))
        for transition in play:
            env.unwrapped.state = np.asarray(transition.state[:size])
            transition.frame = np.asarray(env.render())
            yield transition
    finally:
        env.close()
