"""Read a robot from a URDF file, as tables of links for a race in space."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from botschool import _core
from botschool.errors import BotschoolError

DENSITY = 1000.0
"""Of links without <inertial>, kg/m^3."""
ARMATURE, TORQUE = 0.01, 10.0
"""Of a hinge whose motor the file does not describe, kg m^2 and N m."""
TURNING = ("revolute", "continuous")
FREE = 1e3
"""Limits of a hinge without limits, rad."""


@dataclass
class _Link:
    name: str
    parent: int
    turn: np.ndarray
    place: np.ndarray  # of its origin, against the root's
    hinge: list[float] = field(default_factory=lambda: [0.0] * 6)
    axis: np.ndarray = field(default_factory=lambda: np.zeros(3))
    parts: list[tuple[float, np.ndarray, np.ndarray]] = field(default_factory=list)


class Urdf:
    """A robot from a file: `names`, `links`, `shapes` as `_core.Race.declare` takes them, `height`.

    Raises BotschoolError for a file that cannot be read or that names what races do not have.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = path
        try:
            root = ElementTree.parse(path).getroot()
        except OSError as error:
            raise BotschoolError(f"{path} cannot be read: {error.strerror}.") from None
        except ElementTree.ParseError as error:
            raise BotschoolError(f"{path} is no XML file: {error}.") from None
        self._elements = {e.get("name", ""): e for e in root.iter("link")}
        joints = [e for e in root.iter("joint") if e.find("parent") is not None]
        self._children: dict[str, list[ElementTree.Element]] = {}
        for joint in joints:
            self._children.setdefault(self._end(joint, "parent"), []).append(joint)
        tops = set(self._elements) - {self._end(joint, "child") for joint in joints}
        if root.tag != "robot" or len(tops) != 1:
            raise self._error(f"has {len(tops)} links without a parent, but a robot has one")
        self._links: list[_Link] = []
        self._forms: list[list[float]] = []
        (top,) = tops
        self._links.append(_Link(top, -1, np.eye(3), np.zeros(3)))
        self._walk(top, 0, np.eye(3), np.zeros(3), set())
        self._make_tables()

    def _error(self, what: str) -> BotschoolError:
        return BotschoolError(f"{self.path} {what}.")

    def _end(self, joint: ElementTree.Element, end: str) -> str:
        found = joint.find(end)
        name = "" if found is None else found.get("link", "")
        if name not in self._elements:
            raise self._error(
                f"has a joint '{joint.get('name')}' to a link '{name}' that is missing"
            )
        return name

    def _walk(
        self, name: str, link: int, turn: np.ndarray, place: np.ndarray, seen: set[str]
    ) -> None:
        """Enter what hangs on the element `name`, which is part of a link and lies at `place`."""
        if name in seen:
            raise self._error(f"has a loop of joints at link '{name}'")
        self._enter(self._elements[name], link, turn, place)
        for joint in self._children.get(name, ()):
            xyz, rpy = self._origin(joint)
            at, towards = place + turn @ xyz, turn @ rpy
            child, kind = self._end(joint, "child"), joint.get("type", "")
            of = link
            if kind in TURNING:
                self._links.append(_Link(joint.get("name", ""), link, towards, at))
                of = len(self._links) - 1
                self._turn(joint, self._links[of], kind)
            elif kind != "fixed":
                raise self._error(
                    f"has a joint '{joint.get('name')}' of type {kind or 'none'}: a race in space "
                    f"has {', '.join(TURNING)} and fixed"
                )
            self._walk(child, of, towards, at, seen | {name})

    def _turn(self, joint: ElementTree.Element, link: _Link, kind: str) -> None:
        axis = self._numbers(joint.find("axis"), "xyz", 3, (1, 0, 0))
        length = float(np.linalg.norm(axis))
        if not length:
            raise self._error(f"has a joint '{joint.get('name')}' with an axis of length 0")
        link.axis = link.turn @ axis / length
        limit, dynamics = joint.find("limit"), joint.find("dynamics")
        low, high = (self._number(limit, key, 0.0) for key in ("lower", "upper"))
        if kind == "continuous":
            low, high = -FREE, FREE
        elif not low < high:
            raise self._error(
                f"has a joint '{joint.get('name')}' whose lower limit, {low:g}, is not below its "
                f"upper limit, {high:g}"
            )
        torque = self._number(limit, "effort", TORQUE)
        link.hinge = [low, high, torque, self._number(dynamics, "damping", 0.1), 0.0, ARMATURE]

    def _enter(self, element: Any, link: int, turn: np.ndarray, place: np.ndarray) -> None:
        """Enter shapes and mass of an element."""
        own, solid = self._links[link], []
        for each in element.findall("collision") or element.findall("visual"):
            xyz, rpy = self._origin(each)
            at, towards = place + turn @ xyz - own.place, turn @ rpy
            solid += self._shapes(each.find("geometry"), at, towards, element.get("name"), link)
        inertial = element.find("inertial")
        if inertial is None:
            own.parts += solid
            return
        xyz, rpy = self._origin(inertial)
        mass = self._number(inertial.find("mass"), "value", 0.0)
        form = inertial.find("inertia")
        xx, yy, zz, xy, xz, yz = (
            self._number(form, key, 0.0) for key in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
        )
        towards = turn @ rpy
        inertia = towards @ np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) @ towards.T
        own.parts.append((mass, place + turn @ xyz - own.place, inertia))

    def _shapes(
        self, geometry: Any, at: np.ndarray, turn: np.ndarray, name: str, link: int
    ) -> list:
        """Enter a geometry; return its mass, centre and inertia for water's density."""
        for kind in () if geometry is None else geometry:
            if kind.tag == "box":
                x, y, z = size = self._numbers(kind, "size", 3, None)
                for sx in (-0.5, 0.5):
                    for sy in (-0.5, 0.5):
                        edge = at + turn @ np.array([sx * x, sy * y, 0])
                        self._forms.append([link, *edge, *(turn @ [0, 0, z / 2]), 0.0])
                mass = DENSITY * x * y * z
                second = mass / 12 * np.diag((size**2).sum() - size**2)
            elif kind.tag in ("sphere", "cylinder", "capsule"):
                r = self._number(kind, "radius", None)
                length = 0.0 if kind.tag == "sphere" else self._number(kind, "length", None)
                inner = max(0.0, length - 2 * r) if kind.tag == "cylinder" else length
                self._forms.append([link, *at, *(turn @ [0, 0, inner / 2]), r])
                tube = DENSITY * math.pi * r**2 * length
                ball = 0.0 if kind.tag == "cylinder" else DENSITY * math.pi * r**3 * 4 / 3
                mass = tube + ball
                across = tube * (r * r / 4 + length**2 / 12) + ball * (
                    0.4 * r * r + length**2 / 4 + 3 / 8 * length * r
                )
                second = np.diag([across, across, tube * r * r / 2 + ball * 0.4 * r * r])
            else:
                raise self._error(
                    f"has a {kind.tag} at link '{name}': a race in space has box, sphere, cylinder "
                    "and capsule"
                )
            return [(mass, at, turn @ second @ turn.T)]
        return []

    def _make_tables(self) -> None:
        rows = []
        motor = 0
        for i, link in enumerate(self._links):
            mass = sum(part[0] for part in link.parts)
            if not mass > 0:
                raise self._error(
                    f"has a link at '{link.name}' without a mass: give it an <inertial>"
                )
            centre = sum((m * c for m, c, _ in link.parts), np.zeros(3)) / mass
            inertia = np.zeros((3, 3))
            for m, c, own in link.parts:
                r = c - centre
                inertia += own + m * (r @ r * np.eye(3) - np.outer(r, r))
            six = inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
            moves = i > 0 and link.hinge[2] > 0
            above = self._links[link.parent].place if i else link.place
            number = motor if moves else -1
            rows.append(
                [link.parent, *(link.place - above), *link.axis, *link.hinge]  # noqa: RUF005
                + [number, mass, *centre, *six, 0.0]
            )
            motor += moves
        if not motor:
            raise self._error("has no joint with a motor: give one a <limit effort=...> above 0")
        if not self._forms:
            raise self._error("has no shape that touches the ground: give a link a <collision>")
        self.names = [link.name for link in self._links]
        self.links, self.shapes = np.array(rows), np.array(self._forms)
        places = np.array([self._links[int(s[0])].place for s in self.shapes]) + self.shapes[:, 1:4]
        lowest = places[:, 2] - np.abs(self.shapes[:, 6]) - self.shapes[:, 7]
        self.height = -float(lowest.min())
        """Of the root's origin where the robot stands on the ground, m."""

    def declare(self, race: _core.Race, **course: Any) -> None:
        """Put the robot into a race. Raises BotschoolError."""
        try:
            race.declare(self.names, self.links, self.shapes, _core.Firmness(), **course)
        except ValueError as error:
            raise BotschoolError(f"{self.path}: {error}") from None

    def _origin(self, element: Any) -> tuple[np.ndarray, np.ndarray]:
        """Return place and turn of an <origin>."""
        origin = element.find("origin")
        roll, pitch, yaw = self._numbers(origin, "rpy", 3, (0, 0, 0))
        cr, cp, cy = np.cos([roll, pitch, yaw])
        sr, sp, sy = np.sin([roll, pitch, yaw])
        turn = np.array(
            [
                [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
                [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
                [-sp, cp * sr, cp * cr],
            ]
        )
        return self._numbers(origin, "xyz", 3, (0, 0, 0)), turn

    def _numbers(self, element: Any, key: str, count: int, default: Any) -> np.ndarray:
        text = None if element is None else element.get(key)
        if text is None and default is not None:
            return np.array(default, float)
        try:
            found = np.array([float(word) for word in (text or "").split()])
        except ValueError:
            found = np.zeros(0)
        if found.shape != (count,) or not np.isfinite(found).all():
            raise self._error(f'has {key}="{text}" where {count} numbers are needed')
        return found

    def _number(self, element: Any, key: str, default: float | None) -> float:
        return float(self._numbers(element, key, 1, None if default is None else (default,))[0])
