"""Make Gymnasium environments with clear errors: known packages, wrappers, pictures."""

from __future__ import annotations

import ctypes
import difflib
import importlib
import os
import re
import sys
import warnings
from collections.abc import Collection, Sequence
from contextlib import suppress

import gymnasium

from botschool.errors import BotschoolError, said
from botschool.paths import look_here
from botschool.problems import faces  # noqa: F401  (registers our own)
from botschool.problems.native import CLASSIC, NATIVE, gym_id, own_name
from botschool.terminal import has_display
from botschool.wrappers import Wrapper

PACKAGES = {"BalanceBotBulletEnv-v0": "balance_bot"}
"""Environments of the course in packages of their own; importing such a package registers them."""

FAMILIES = (
    (r"ALE/.*|.*(NoFrameskip|Deterministic)-v\d+", "ale_py", "ale-py", "'botschool[atari]'"),
    (r"(MiniGrid|BabyAI)-.*", "minigrid", "minigrid", "minigrid"),
    (r"(Fetch|HandReach|HandManipulate|AdroitHand|PointMaze_|AntMaze_|FrankaKitchen-).*",
     "gymnasium_robotics", "gymnasium-robotics", "gymnasium-robotics"),
)  # fmt: skip
"""Ids of well-known packages: pattern, module that registers them, package, what to install."""

DRAWING = (("egl", "libEGL.so.1"), ("osmesa", "libOSMesa.so"), ("osmesa", "libOSMesa.so.8"))
"""Ways for MuJoCo to draw without a display: value of MUJOCO_GL -> library that it needs."""


def make_env(name: str, wrappers: Sequence[Wrapper] = (), /, **options) -> gymnasium.Env:
    """Return the environment of that id, inside the wrappers, the first one innermost.

    A `module:` before the id may lie in the current folder. Options go to gymnasium.make. Raises
    BotschoolError.
    """
    env = _make(name, **(skipping(name, wrappers) | options))
    for wrapper in wrappers:
        env = wrapper.around(env, name)
    return env


def is_ours(name: str) -> bool:
    """Return whether botschool has the environment itself, native or in Python."""
    spec = gymnasium.registry.get(_registered(name).rpartition(":")[2])
    entry = "" if spec is None else str(spec.entry_point)
    return own_name(name) in NATIVE or name in PACKAGES or entry.startswith("botschool.")


def skipping(name: str, wrappers: Sequence[Wrapper]) -> dict[str, int]:
    """Return an Atari game's options for these wrappers; AtariPreprocessing skips frames itself."""
    preprocessed = any(wrapper.name == "AtariPreprocessing" for wrapper in wrappers)
    return {"frameskip": 1} if preprocessed and re.fullmatch(FAMILIES[0][0], name) else {}


def _make(name: str, /, **options) -> gymnasium.Env:
    if ":" in name:
        look_here(name.partition(":")[0])
    elif name not in gymnasium.registry:
        _import_package(name)
    if options.get("render_mode") == "rgb_array":
        _choose_drawing(name)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # errors report it in a sentence
            return gymnasium.make(_registered(name, options), disable_env_checker=True, **options)
    except (gymnasium.error.DependencyNotInstalled, ModuleNotFoundError) as error:
        raise BotschoolError(
            f"{name} needs a package that is not installed: {said(error)}."
        ) from None
    except gymnasium.error.UnregisteredEnv:
        module, colon, own = name.rpartition(":")
        known = [*NATIVE, *PACKAGES, *gymnasium.registry]
        near = difflib.get_close_matches(own, known, n=1, cutoff=0.65)
        hint = "is the package that has it installed?"
        if near:
            hint = f"did you mean {module}{colon}{near[0]}?"
        raise BotschoolError(f"There is no environment '{name}'; {hint}") from None
    except (Exception, SystemExit) as error:
        raise BotschoolError(f"{name} cannot be made: {said(error)}.") from error


OWN = {"reward", "ends", "physics"}
"""Options that only native problems take."""


def _registered(name: str, options: Collection[str] = ()) -> str:
    """Return the id under which Gymnasium knows it; another package may own the plain id."""
    name = gym_id(name)
    if name in NATIVE and name not in gymnasium.registry:
        name = NATIVE[name][0]
    if name.startswith(CLASSIC):  # Gymnasium has it, too, but with its own reward
        return f"botschool/{name}" if OWN & set(options) and name in NATIVE else name
    return f"botschool/{name}" if f"botschool/{name}" in gymnasium.registry else name


def _choose_drawing(name: str) -> None:
    """Tell MuJoCo to draw in memory if there is no display and the user has not chosen.

    Raises BotschoolError for an environment of MuJoCo that cannot be drawn.
    """
    if sys.platform != "linux" or has_display() or "MUJOCO_GL" in os.environ:
        return
    for value, library in DRAWING:
        with suppress(OSError):
            ctypes.CDLL(library)
            os.environ["MUJOCO_GL"] = value
            return
    spec = gymnasium.registry.get(name.rpartition(":")[2])
    if spec is not None and "mujoco" in str(spec.entry_point):
        raise BotschoolError(
            f"MuJoCo draws {name}, and without a display it needs EGL or OSMesa: install one "
            "(on Debian and Ubuntu libegl1 and libgl1-mesa-dri), or draw no pictures."
        )


def _import_package(name: str) -> None:
    """Import the package that registers this id, if it is a known one."""
    if name in PACKAGES:
        package = PACKAGES[name]
        remedy = (
            f"comes in a package of its own, which exercise 10 builds: install it with 'pip "
            f"install -e envs/{package}', or the one that you have built yourself."
        )
    else:
        found = [row for row in FAMILIES if re.fullmatch(row[0], name)]
        if not found:
            return
        _, package, called, install = found[0]
        remedy = f"comes with the package {called}: install it with pip install {install}."
    try:
        module = importlib.import_module(package)
        if package == "ale_py":  # ale_py greets every process and every game
            module.ALEInterface.setLoggerMode(module.LoggerMode.Error)
    except ModuleNotFoundError as error:
        if error.name != package:
            raise BotschoolError(f"{name} cannot be made: {said(error)}.") from None
        raise BotschoolError(f"{name} {remedy}") from None
