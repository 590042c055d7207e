"""PyBullet without its chatter, and where the robot's description lies."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from gymnasium.logger import warn


@contextmanager
def _unheard() -> Iterator[None]:
    """Hides what C code writes to the standard error meanwhile."""
    sys.stderr.flush()
    kept = os.dup(2)
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        os.dup2(nowhere, 2)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
        os.close(nowhere)


try:
    with _unheard():
        import pybullet
        import pybullet_data
except ModuleNotFoundError:
    raise ModuleNotFoundError(
        "the balancing robot is simulated by PyBullet: install it with 'pip install pybullet'"
    ) from None

PLANE = os.path.join(pybullet_data.getDataPath(), "plane.urdf")


def robot_file(name: str) -> Path:
    """The file of a robot's description (URDF)."""
    return Path(__file__).with_name(name)


def connect(render_mode: str | None) -> int:
    """A physics client of its own, which shows a window if render_mode is "human".

    Without a display it warns, and shows none.
    """
    if render_mode not in (None, "human", "rgb_array"):
        raise ValueError(f"render_mode is human, rgb_array or None, not {render_mode!r}")
    if render_mode == "human" and _has_display():
        with _unheard():
            client = pybullet.connect(pybullet.GUI)
        if client < 0:
            raise RuntimeError("PyBullet opens one window at a time: close the other one first")
        return client
    if render_mode == "human":
        warn("no display for a window: use render_mode='rgb_array', which gives pictures")
    return pybullet.connect(pybullet.DIRECT)


def _has_display() -> bool:
    return not sys.platform.startswith("linux") or bool(os.environ.get("DISPLAY"))


def picture(client: int, robot: int, width: int = 480, height: int = 360) -> np.ndarray:
    """What a camera that follows the robot sees: uint8, shape (height, width, 3)."""
    (x, y, _), _ = pybullet.getBasePositionAndOrientation(robot, client)
    view = pybullet.computeViewMatrixFromYawPitchRoll([x, y, 0.22], 1.3, 60, -18, 0, 2)
    lens = pybullet.computeProjectionMatrixFOV(35, width / height, 0.1, 30)
    *_, pixels, _, _ = pybullet.getCameraImage(
        width,
        height,
        view,
        lens,
        shadow=0,
        lightDirection=[1, 1, 2],
        flags=pybullet.ER_NO_SEGMENTATION_MASK,
        renderer=pybullet.ER_TINY_RENDERER,
        physicsClientId=client,
    )
    return np.reshape(pixels, (height, width, 4))[..., :3].astype(np.uint8)
