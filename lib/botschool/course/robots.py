"""Give exercise 10 the robot, its package, and pictures of balance."""

from __future__ import annotations

import inspect
from pathlib import Path
from types import ModuleType

import numpy as np

from botschool.course.files import robot_file

_HEADER = '''"""The balancing robot."""

import os
import time
from pathlib import Path

import gymnasium
import numpy as np
import pybullet
import pybullet_data

PLANE = os.path.join(pybullet_data.getDataPath(), "plane.urdf")
FASTEST, TIME_STEP, LOWEST = 24.6, 0.01, 0.15


def robot_file(name):
    return Path(__file__).with_name(name)
'''


def write_package(folder: str | Path, files: dict[str, str], parts: list) -> None:
    """Write an installable package of the balancing robot.

    files: path -> text. parts: the functions and classes that make up balance_bot/env.py.
    """
    folder = Path(folder)
    source = "\n\n".join([_HEADER, *(inspect.getsource(part) for part in parts)])
    robot = robot_file("balance_bot.urdf").read_text(encoding="utf-8")
    own = {"balance_bot/env.py": source, "balance_bot/balance_bot.urdf": robot}
    for path, text in (files | own).items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    print(f"package: {folder}  (install it with: pip install -e {folder.resolve()})")


def use_robot(module: ModuleType, urdf: str) -> None:
    """Write a robot's file, and have a submission's module take it for the course's own.

    This is for a grader. A path that the module has kept since it was loaded changes, too.
    """
    own = Path("balance_bot.urdf").absolute()
    own.write_text(urdf, encoding="utf-8")
    module.robot_file = lambda name: own  # type: ignore[attr-defined]
    for name, value in list(vars(module).items()):
        if isinstance(value, (str, Path)) and Path(value).name == own.name:
            setattr(module, name, type(value)(own))


def draw_balance(file: str | Path, panels: dict[str, list[np.ndarray]]) -> None:
    """Draw how far the robot leans in some episodes of each controller.

    panels: title -> inclinations (rad) at every hundredth of a second, an array for each episode.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.2 * len(panels), 4), layout="constrained")
    row = figure.subplots(1, len(panels), sharey=True, squeeze=False)[0]
    for (title, episodes), axes in zip(panels.items(), row, strict=True):
        for inclinations in episodes:
            seconds = 0.01 * np.arange(len(inclinations))
            colour = "#c1272d" if abs(inclinations[-1]) > 1 else "#0072b2"
            axes.plot(seconds, np.degrees(inclinations), linewidth=1, color=colour)
        axes.set(xlabel="seconds", title=title, xlim=(0, 5), ylim=(-95, 95))
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
    row[0].set_ylabel("inclination (degrees)")
    row[0].set_yticks([-90, -45, 0, 45, 90])
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def film_balance(file: str | Path, env, act, seeds: list[int], every: int = 4) -> None:
    """Film an episode for each seed, in real time; every 4th step is a picture.

    env: made with render_mode="rgb_array". act(observation) returns the action.
    """
    from botschool.render.video import write_video

    write_video(Path(file), _pictures(env, act, seeds, every), env.metadata["render_fps"] / every)
    print(f"film: {file}")


def _pictures(env, act, seeds: list[int], every: int):
    from botschool.problems.transition import Transition
    from botschool.render.panel import with_caption

    for number, seed in enumerate(seeds, 1):
        observation, _ = env.reset(seed=seed)
        step, total, ended = 0, 0.0, False
        while not ended:
            action = act(observation)
            observation, reward, terminated, truncated, _ = env.step(action)
            step, total, ended = step + 1, total + reward, terminated or truncated
            if step % every == 0 or ended:
                transition = Transition(step, reward, total, observation, action, np.zeros(0))
                yield with_caption(env.render(), number, transition)
