"""Use PyBullet without its output: worlds of their own, models, pictures."""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import ModuleType

import numpy as np

from botschool.errors import BotschoolError

SELF_COLLISION = ("USE_SELF_COLLISION", "USE_SELF_COLLISION_EXCLUDE_ALL_PARENTS")
FORMATS = (".urdf", ".xml", ".mjcf")

FIELD_OF_VIEW = 45.0
"""Vertical angle of a picture in degrees."""
MARGIN = 1.05
"""Factor on the smallest distance from which a camera sees all."""

_one_at_a_time = threading.RLock()


@contextmanager
def hushed() -> Iterator[None]:
    """Hide the output of C code during the block, standard output and error."""
    with _one_at_a_time:
        _flush()
        kept = {}
        nowhere = os.open(os.devnull, os.O_WRONLY)
        try:
            for stream in (1, 2):
                with suppress(OSError):  # it may be closed
                    kept[stream] = os.dup(stream)
                    os.dup2(nowhere, stream)
            yield
        finally:
            _flush()
            for stream, copy in kept.items():
                os.dup2(copy, stream)
                os.close(copy)
            os.close(nowhere)


def _flush() -> None:
    for stream in (sys.stdout, sys.stderr):
        with suppress(Exception):  # it may be missing, closed, or full
            stream.flush()
    with suppress(Exception):  # C's own buffers; Windows names them otherwise
        ctypes.CDLL(None).fflush(None)


def import_pybullet() -> ModuleType:
    """Import PyBullet without its greeting. Raises BotschoolError if it is not installed."""
    if sys.modules.get("pybullet"):
        return sys.modules["pybullet"]
    try:
        with hushed():
            import pybullet
    except ImportError:
        raise BotschoolError(
            "robots in 3D need PyBullet: install it with `pip install 'botschool[pybullet]'`."
        ) from None
    return pybullet


def data_folder() -> Path:
    """Return the folder of PyBullet's models."""
    import_pybullet()
    import pybullet_data

    return Path(pybullet_data.getDataPath())


def connect(window: bool = False) -> int:
    """Start a physics world and return its client. Raises BotschoolError if no window can open."""
    bullet = import_pybullet()
    if window and sys.platform == "linux" and not os.environ.get("DISPLAY"):
        raise BotschoolError(
            "there is no display for a window: make a film or a picture instead (in a "
            "command with --video FILE.mp4 or --sheet FILE.png, in Python with "
            "render_mode='rgb_array')."
        )
    with hushed():
        client = bullet.connect(bullet.GUI if window else bullet.DIRECT)
    if client < 0:
        raise BotschoolError(
            "PyBullet gives no further physics world: close() environments that you no longer need."
        )
    if window:
        bullet.configureDebugVisualizer(bullet.COV_ENABLE_GUI, 0, physicsClientId=client)
    return client


def disconnect(client: int) -> None:
    """End a physics world, unless it has ended already."""
    bullet = sys.modules.get("pybullet")
    if bullet is not None:
        with suppress(bullet.error), hushed():
            bullet.disconnect(physicsClientId=client)


def load_model(client: int, path: Path, flags: tuple[str, ...] = (), **options) -> int:
    """Load a robot from a .urdf file, or from a MuJoCo .xml file; return its body.

    flags: names of PyBullet's URDF_ flags; options go to loadURDF. If an .xml file holds several
    bodies, the robot is the one with most joints. Raises BotschoolError if the file is missing or
    unreadable.
    """
    bullet = import_pybullet()
    if not path.is_file():
        raise BotschoolError(
            f"There is no model file {path}: give the path of a .urdf or .xml file."
        )
    if path.suffix.lower() not in FORMATS:
        raise BotschoolError(f"{path} is not a robot model: its name must end in .urdf or .xml.")
    bits = sum(getattr(bullet, f"URDF_{name}") for name in flags)
    try:
        with hushed():
            if path.suffix.lower() == ".urdf":
                return bullet.loadURDF(str(path), flags=bits, physicsClientId=client, **options)
            bodies = bullet.loadMJCF(str(path), flags=bits, physicsClientId=client)
        return max(bodies, key=lambda body: bullet.getNumJoints(body, physicsClientId=client))
    except (bullet.error, ValueError):
        raise BotschoolError(
            f"{path} cannot be read as a robot model: it is damaged, or lacks a file that it names."
        ) from None


def check_model(path: Path) -> None:
    """Load a model in a process of its own: PyBullet crashes on some damaged files.

    Raises BotschoolError if it does.
    """
    code = "import sys; from botschool.envs import bullet; from pathlib import Path; "
    code += "bullet.load_model(bullet.connect(), Path(sys.argv[1]))"
    done = subprocess.run([sys.executable, "-c", code, str(path)], capture_output=True)
    if done.returncode < 0:
        raise BotschoolError(
            f"{path} cannot be read as a robot model: PyBullet crashes on it. Check that each "
            "joint names its parent and its child, and that both are links of the file."
        )


def load_floor(client: int, path: Path) -> int:
    """Load the endless plane of pybullet_envs_gymnasium, with its friction; return its body."""
    bullet = import_pybullet()
    try:
        with hushed():
            (floor,) = bullet.loadSDF(str(path), physicsClientId=client)
    except (bullet.error, ValueError):
        raise BotschoolError(
            f"{path} cannot be read: install pybullet again, which it comes with."
        ) from None
    bullet.changeDynamics(floor, -1, lateralFriction=0.8, restitution=0.5, physicsClientId=client)
    return floor


def picture(
    client: int,
    target: tuple[float, float, float],
    distance: float,
    yaw: float,
    pitch: float = -20.0,
    size: tuple[int, int] = (400, 300),
) -> np.ndarray:
    """Return the picture of a camera, (height, width, 3) uint8, drawn without a display.

    The camera looks at `target` from `distance` metres; yaw and pitch are in degrees; size is width
    and height.
    """
    bullet = import_pybullet()
    width, height = size
    view = bullet.computeViewMatrixFromYawPitchRoll(target, distance, yaw, pitch, 0, 2)
    lens = bullet.computeProjectionMatrixFOV(FIELD_OF_VIEW, width / height, 0.1, 100)
    pixels = bullet.getCameraImage(
        width,
        height,
        view,
        lens,
        shadow=1,
        lightDirection=(-3, -4, 10),
        renderer=bullet.ER_TINY_RENDERER,
        flags=bullet.ER_NO_SEGMENTATION_MASK,
        physicsClientId=client,
    )[2]
    return np.ascontiguousarray(np.reshape(pixels, (height, width, 4))[:, :, :3].astype(np.uint8))


def fitting_camera(
    points: np.ndarray, yaw: float, pitch: float, aspect: float = 1.25
) -> tuple[tuple[float, float, float], float]:
    """Return the target and distance of a camera of `picture` that sees all points, shape (n, 3).

    aspect: width of the picture / height.
    """
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    view = import_pybullet().computeViewMatrixFromYawPitchRoll(middle, 1, yaw, pitch, 0, 2)
    rotation = np.reshape(view, (4, 4)).T[:3, :3]
    seen = (points - middle) @ rotation.T  # to the right, up, towards the camera
    shift = (seen.min(axis=0) + seen.max(axis=0)) / 2
    seen -= shift
    half = np.tan(np.radians(FIELD_OF_VIEW / 2))
    distance = seen[:, 2] + np.abs(seen[:, :2] / (half * aspect, half)).max(axis=1)
    target = middle + shift @ rotation
    return tuple(target.tolist()), MARGIN * max(float(distance.max()), 0.1)
