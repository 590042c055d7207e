"""Give exercise 10 robots, its package, pictures of balance, and drivers of its grader."""

from __future__ import annotations

import inspect
from pathlib import Path

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


def _vector(rng: np.random.Generator, name: str) -> str:
    """Return an element with three numbers, which is often left out."""
    numbers = " ".join(map(str, rng.integers(-50, 50, 3) / 100))
    return f'<{name} xyz="{numbers}"/>' if rng.random() < 0.75 else ""


def random_robot(rng: np.random.Generator, nlinks: int, star: bool) -> str:
    """Return the description of a robot that nobody has seen, for a grader.

    star: all links hang on the first one, before all joints, which are in reverse order.
    """
    names = [f"part_{letter}" for letter in rng.permutation(list("abcdefgh"))[:nlinks]]
    links, joints = [], []
    for i, name in enumerate(names):
        visual = '<visual><origin xyz="9 9 9"/></visual>'
        inside = f'{_vector(rng, "origin")}<mass value="{rng.integers(1, 400) / 100}"/>'
        links.append(f'<link name="{name}">{visual}<inertial>{inside}</inertial></link>')
        kind = rng.choice(["continuous", "revolute", "prismatic"])
        head = f'<joint type="{kind}" name="joint_{nlinks - i}">'
        above = names[0 if star or i == 0 else rng.integers(i)]
        inside = f'<parent link="{above}"/><child link="{name}"/>{_vector(rng, "origin")}'
        joints.append(f"{head}{inside}{_vector(rng, 'axis')}</joint>")
    pairs = [part for pair in zip(links[1:], joints[1:], strict=True) for part in pair]
    rest = links[1:] + joints[:0:-1] if star else pairs
    return f"<robot>{links[0]}{''.join(rest)}</robot>"


def registered(module, what, seed, gains):
    """{0} of gymnasium.make("BalanceBotBulletEnv-v0") with seed {1}"""
    import warnings

    import gymnasium
    import numpy
    from gymnasium.utils.env_checker import check_env

    from botschool.course.bullet import pybullet

    warnings.simplefilter("ignore")
    if "beside" not in vars(pybullet):  # an empty simulation has the number 0
        vars(pybullet)["beside"] = pybullet.connect(pybullet.DIRECT)
    gymnasium.registry.pop("BalanceBotBulletEnv-v0", None)
    module.register_robot()
    point = getattr(gymnasium.registry.get("BalanceBotBulletEnv-v0"), "entry_point", ":")
    if not callable(point) and ":" not in str(point):
        raise TypeError(f"entry_point should be the class itself, not {point!s:.40}")
    env = gymnasium.make("BalanceBotBulletEnv-v0", render_mode="rgb_array")
    found = {"render_mode": env.unwrapped.render_mode}
    env.unwrapped.render_mode = None  # pictures take long
    if what == "check_env":
        other = gymnasium.make("BalanceBotBulletEnv-v0")
        found["the same object again"] = again = other.unwrapped is env.unwrapped
        module.register_robot()  # once more, as in a notebook
        if not again:
            other.close()
            check_env(env.unwrapped, skip_render_check=True)
    observation, ends = env.reset(seed=seed)[0], [False, False]
    seen = [observation]
    while len(seen) <= 600 and not any(ends):
        action = numpy.clip([numpy.dot(gains, observation)], -1, 1).astype(numpy.float32)
        observation, _, *ends, _ = env.step(action)
        seen.append(observation)
    env.close()
    found |= {"the number of steps": len(seen) - 1, "terminated, truncated": [*map(bool, ends)]}
    return found | {"the first observations": seen[:70]}


def imported(module):
    """import balance_bot (without its module env, which only gymnasium.make should need)"""
    import sys
    import types
    from unittest import mock

    import gymnasium

    gymnasium.registry.pop("BalanceBotBulletEnv-v0", None)
    package = types.ModuleType("balance_bot")
    package.__path__ = []
    with mock.patch.dict(sys.modules, {"balance_bot": package}):
        sys.modules.pop("balance_bot.env", None)
        exec(module.package_files()["balance_bot/__init__.py"], vars(package))
    spec = gymnasium.registry.get("BalanceBotBulletEnv-v0")
    return {name: str(getattr(spec, name, None)) for name in ("entry_point", "max_episode_steps")}


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
    from botschool.render.panel import lively
    from botschool.render.video import write_video

    fps = env.metadata["render_fps"] / every
    write_video(Path(file), lively(_pictures(env, act, seeds, every), fps), fps)
    print(f"film: {file}")


def _pictures(env, act, seeds: list[int], every: int):
    from botschool.problems.transition import Transition

    for number, seed in enumerate(seeds, 1):
        observation, _ = env.reset(seed=seed)
        step, total, ended = 0, 0.0, False
        while not ended:
            action = act(observation)
            observation, reward, terminated, truncated, _ = env.step(action)
            step, total, ended = step + 1, total + reward, terminated or truncated
            if step % every == 0 or ended:
                transition = Transition(step, reward, total, observation, action, np.zeros(0))
                yield env.render(), number, transition
