"""Hold a robot for races in space: tables of numbers, which a file beside a run keeps."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from botschool import _core
from botschool.errors import ANEW, BotschoolError
from botschool.output import save_npz
from botschool.wrappers import keywords

FAST = 0.1
"""A motor that turns a link further than this in a substep from rest is told, rad or m."""
LIGHT = 1e-4
"""A joint that moves less than this share of the robot's mass is told."""
LINK = {
    name: number
    for number, name in enumerate(
        """
        parent x y z axis_x axis_y axis_z low high torque damping stiffness armature motor mass
        centre_x centre_y centre_z xx yy zz xy xz yz servo still up down pull drag least most rest
        dry slides
        """.split()  # noqa: SIM905
    )
}
"""Columns of the table of links."""
DATA = "data:"
"""Beginning of a robot's name that holds its tables."""
TABLES = (
    "names", "links", "shapes", "shape_names", "pairs", "pose", "controls", "looks", "ease",
    "facts",
)  # fmt: skip


@dataclass
class Robot:
    """Tables of a robot: rows as `_core.Race.declare` takes them.

    pose: quaternion and angles at the start. controls: of each motor what an action of -1, 0 and 1
    is in its file's units. looks: what is drawn, of each bar its link, ends and radius. ease: the
    acceleration of each link's joint for a torque of 1. facts: height of the root at the start,
    friction, N/m of the ground for it, whether its root is fixed.
    """

    path: str
    names: list[str]
    links: np.ndarray
    shapes: np.ndarray
    shape_names: list[str]
    pairs: np.ndarray
    pose: np.ndarray
    controls: np.ndarray
    looks: np.ndarray
    ease: np.ndarray
    facts: np.ndarray
    notes: list[str] = field(default_factory=list)

    @property
    def fixed(self) -> bool:
        """Return whether its root stays where it is."""
        return bool(self.facts[3])

    @property
    def observations(self) -> int:
        """Return how many numbers a policy sees."""
        return 2 * len(self.names) + (-2 if self.fixed else 9)

    @property
    def motors(self) -> int:
        """Return how many actions it takes."""
        return int(self.links[:, LINK["motor"]].max()) + 1

    @property
    def digest(self) -> str:
        """Return a text that differs for robots that differ in any number."""
        found = hashlib.sha256()
        for name in TABLES:
            found.update(np.asarray(getattr(self, name)).tobytes())
        return found.hexdigest()[:16]

    def save(self, path: Path) -> None:
        """Write the tables to a .npz file."""
        save_npz(path, {name: np.asarray(getattr(self, name)) for name in TABLES})

    def carried(self, options: str) -> str:
        """Return a problem's options with the tables themselves in place of the robot's file."""
        buffer = BytesIO()
        np.savez_compressed(buffer, **{name: np.asarray(getattr(self, name)) for name in TABLES})
        given = keywords(options)
        given.pop("urdf", None)
        given["robot"] = DATA + base64.b64encode(buffer.getvalue()).decode()
        return ", ".join(f"{name}={value!r}" for name, value in given.items())

    def keep(self, path: Path, resumed: bool) -> None:
        """Write the tables beside a run. Raises BotschoolError if the run has another robot."""
        if resumed and path.exists() and load(path).digest != self.digest:
            raise BotschoolError(
                f"{self.path} is another robot than that of the run, {path}: restore its file (or "
                "MuJoCo's version)",
                *ANEW,
            )
        self.save(path)

    def declare(self, race: Any, **course: Any) -> None:
        """Put the robot into a race. Raises BotschoolError."""
        height, friction, stiffness, _ = self.facts
        pairs = [(int(a), int(b)) for a, b in self.pairs]
        firm = _core.Firmness(friction, stiffness, stiffness / 50)
        tables = self.names, self.links, self.shapes, self.shape_names, pairs, self.pose.tolist()
        try:
            race.declare(*tables, firm, fixed=self.fixed, height=height, **course)
        except ValueError as error:
            raise BotschoolError(f"{self.path}: {error}") from None

    def doubts(self, substep: float) -> Iterator[str]:
        """Yield a sentence for each thing that evolution would exploit."""
        yield from self.notes
        drives = np.abs(self.links[:, LINK["least"] : LINK["rest"]])
        force = np.where(drives < 1e6, drives, 0).max(axis=1)
        force = np.maximum(np.abs(self.links[:, LINK["torque"]]), force)
        way = force * self.ease * substep**2
        if way.max() > FAST:
            i = int(way.argmax())
            yield (
                f"{self.path}: the motor of '{self.names[i]}' has up to {force[i]:g} N m, which "
                f"moves it by {way[i]:.2g} rad in a substep of {substep:g} s: give its true "
                "effort, or evolution lives on the error."
            )
        below = self.links[:, LINK["mass"]].copy()
        for i in range(len(below) - 1, 0, -1):
            below[int(self.links[i, 0])] += below[i]
        i = int(below.argmin())
        if below[i] < LIGHT * below[0]:
            yield f"{self.path}: '{self.names[i]}' moves only {below[i]:.1g} kg: give its mass."


def load(path: str | Path | BytesIO) -> Robot:
    """Return the robot of a .npz file. Raises BotschoolError."""
    try:
        with np.load(path, allow_pickle=False) as file:
            tables = {name: file[name] for name in TABLES}
        robot = Robot("its robot" if isinstance(path, BytesIO) else str(path), **tables)
        robot.names, robot.shape_names = tables["names"].tolist(), tables["shape_names"].tolist()
        return robot
    except OSError as error:
        raise BotschoolError(f"{path} cannot be read: {error.strerror or error}.") from None
    except Exception:  # a damaged file can fail in any way
        raise BotschoolError(f"{path} is no robot that a run of botschool saved.") from None
