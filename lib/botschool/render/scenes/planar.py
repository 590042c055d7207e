"""Draw PlanarHopper, PlanarWalker2D and PlanarHalfCheetah: running bodies, seen from the side."""

from __future__ import annotations

from functools import partial
from math import atan, cos, hypot, pi, sin

import numpy as np

from botschool import _core
from botschool.problems.native import INFOS
from botschool.render.scene import Scene, draws
from botschool.render.shapes import arc, arrow, rectangle


class PlanarScene(Scene):
    """A body of segments, and the ground's force at each contact point as an arrow.

    The picture follows the body; lines on the ground, a metre apart, show how it moves.
    """

    scale = 150.0
    HALF_WIDTH, BELOW, ABOVE = 2.0, 0.35, 2.05
    FULL_FORCE = 5.0
    """Force at which an arrow has full length, in units of the body's weight."""

    def __init__(self, problem: str, body: str, far: int, robots: tuple = ()) -> None:
        """Make the picture; body: as in `_core.PlanarBody`; far: metres of ground with marks."""
        super().__init__()
        info, table = INFOS[problem], _core.PlanarBody(body).table
        self.state_size, self.fps = info["states"], 1 / info["seconds"]
        self.view = (-self.HALF_WIDTH, -self.BELOW, self.HALF_WIDTH, self.ABOVE)
        self._segments, self._contacts = table["segments"], table["contacts"]
        self._weight = 9.81 * table["masses"][:, 0].sum()
        self._first_load = self.state_size - len(self._contacts)
        self._add_ground(far)
        poses = [self.pose() for _ in self._segments]
        # draw the left parts behind the right ones
        order = sorted(range(len(poses)), key=lambda i: not self._hidden(i))
        for i in order:
            self._add_segment(i, poses[i])
        for _ in self._contacts:
            self.add("polygon", arrow(0.5, 0.1), "force", pose=self.pose(), size=self.value())
        self._feet = [i for i, s in enumerate(self._segments) if s["name"].endswith("foot")]
        self.charted = (("feet", tuple(self.value() for _ in self._feet)),)

    def body(self) -> dict:
        """Return `_numbers`' data about the body, ready for JSON, for the twin in scenes.js."""
        return {
            "segments": [[s["parent"], s["x"], s["z"]] for s in self._segments],
            "contacts": [list(contact) for contact in self._contacts],
            "weight": self._weight,
            "feet": self._feet,
            "firstLoad": self._first_load,
        }

    def _add_ground(self, far: int) -> None:
        left, _, right, _ = self.view
        self.add("polygon", rectangle(left, -3.0, right, 0.0), "ground")
        self.add("line", [(left, 0.0), (right, 0.0)], "muted", radius=0.006)
        way = self.pose()
        for five in range(-10, far, 5):
            comb = []
            for x in range(five, five + 5):
                depth = 0.14 if x == five else 0.07
                comb += [(x, 0.0), (x, -depth), (x, 0.0)]
            self.add("line", comb, "muted", radius=0.006, pose=way)
            self.add("text", [(five, -0.22)], "ink", text=f"{five} m", pose=way)

    def _hidden(self, i: int) -> bool:
        return self._segments[i]["name"].startswith(("left", "rear"))

    def _add_segment(self, i: int, pose: int) -> None:
        colour = "pole" if i == 0 else "short pole" if self._hidden(i) else "axle"
        for x, z, angle, half, radius in self._segments[i]["capsules"]:
            dx, dz = half * cos(angle), half * sin(angle)
            ends = [(x - dx, z - dz), (x + dx, z + dz)]
            self.add("line", ends, colour, radius=radius, pose=pose)
            for end in ends:
                self.add("disc", [end], colour, radius=radius, pose=pose)

    def _numbers(self, state, action, observation, reward) -> list[float]:
        camera = float(state[0])
        numbers = [-camera, 0.0, 0.0]
        places = []
        for i, segment in enumerate(self._segments):
            x, z = 0.0, float(state[1])
            if i:
                dx, dz = _turned(segment["x"], segment["z"], places[segment["parent"]][2])
                x, z = places[segment["parent"]][0] + dx, places[segment["parent"]][1] + dz
            places.append((x, z, float(state[2 + i])))
            numbers += places[-1]
        loads = state[self._first_load :] / self._weight
        for (i, x, z, radius), load in zip(self._contacts, loads, strict=True):
            dx, dz = _turned(x, z, places[i][2])
            low = places[i][1] + dz - radius
            numbers += [places[i][0] + dx, low, pi / 2, min(load / self.FULL_FORCE, 1.5)]
        on_ground = {c[0] for c, load in zip(self._contacts, loads, strict=True) if load > 0}
        return [*numbers, *(float(foot in on_ground) for foot in self._feet)]


def _turned(x: float, z: float, angle: float) -> tuple[float, float]:
    return x * cos(angle) - z * sin(angle), x * sin(angle) + z * cos(angle)


for _name, _body, _far in (
    ("PlanarHopper", "hopper", 60),
    ("PlanarWalker2D", "walker2d", 60),
    ("PlanarHalfCheetah", "halfcheetah", 700),
):
    for _version in (0, 5):
        _problem = f"{_name}-v{_version}"
        draws(_problem)(partial(PlanarScene, _problem, _body, _far))


# --- PlanarBodyBrain: a chain of rods on rough ground, seen from the side.


NAME = "PlanarBodyBrain-v0"
RODS = 11
GRAVITY = 10.0
PIECE, PIECES, FLAT = 14 / 30, 200, 40
"""Width of a piece of ground in metres, number of pieces, and number of flat pieces."""
START = PIECE * FLAT / 2


class ChainState:
    """The parts of a native state (lib/arena/problems/planarbodybrain.hpp)."""

    def __init__(self, state: np.ndarray) -> None:
        sizes = [RODS + 2, RODS + 2, 2 * RODS, RODS, RODS, RODS - 1, RODS - 1, RODS, RODS]
        (
            self.position, self.speed, self.load,
            self.lengths, self.thicknesses, self.low, self.high, self.angles, self.densities,
            self.heights,
        ) = np.split(state, np.cumsum(sizes))  # fmt: skip

    def rears(self) -> np.ndarray:
        """Return the rear ends of the rods, then the tip of the last, (12, 2)."""
        headings = self.position[2:]
        along = self.lengths[:, None] * np.stack([np.cos(headings), np.sin(headings)], axis=1)
        return self.position[:2] + np.concatenate([np.zeros((1, 2)), np.cumsum(along, axis=0)])

    def ground(self, x: np.ndarray | float) -> np.ndarray:
        """Return the height of the ground."""
        places = PIECE * (FLAT + np.arange(len(self.heights)))
        return np.interp(x, places, self.heights)

    def weight(self) -> float:
        """Return the weight of the whole chain in N."""
        return GRAVITY * float(self.densities @ (self.lengths * self.thicknesses))


class ChainScene(Scene):
    """Rods, the ground's force on their ends as arrows, and a piece of the ground.

    The picture follows the body; signs on the ground show the metres from the start.
    """

    scale, BELOW, ABOVE, HALF_WIDTH = 30.0, 2.5, 7.5, 10.0
    DEEP = 12.0
    """Depth of the drawn ground, in widths of a piece."""
    SIGN_EVERY = 5
    FULL_FORCE = 2.0
    """Force at which an arrow has full length, in units of the body's weight."""

    def __init__(self, robots: tuple = ()) -> None:
        super().__init__()
        info = INFOS[NAME]
        self.state_size, self.fps = info["states"], 1 / info["seconds"]
        self.view = (-self.HALF_WIDTH, -self.BELOW, self.HALF_WIDTH, self.ABOVE)
        self._pieces = round(2 * self.HALF_WIDTH / PIECE) + 2
        self._signs = range(-self.SIGN_EVERY, int(PIECE * PIECES - START) + 1, self.SIGN_EVERY)
        for _ in range(self._pieces):
            # wider below, so that no gap opens between pieces with different slopes
            slab = [(0.0, 0.0), (1.0, 0.0), (3.0, -self.DEEP), (-2.0, -self.DEEP)]
            pose, length = self.pose(), self.value()
            self.add("polygon", slab, "ground", pose=pose, size=length)
            self.add("line", [(0.0, 0.0), (1.0, 0.0)], "muted", radius=0.03, pose=pose, size=length)
        for metres in self._signs:
            pose = self.pose()
            self.add("line", [(0.0, 0.0), (0.0, -0.3)], "muted", radius=0.03, pose=pose)
            self.add("text", [(0.0, -0.7)], "ink", text=f"{metres} m", pose=pose)
        for i in reversed(range(RODS)):
            self._add_rod(i)
        for _ in range(2 * RODS):
            self.add("polygon", arrow(1.5, 0.4), "force", pose=self.pose(), size=self.value())
        self.charted = (("ground", tuple(self.value() for _ in range(RODS))),)

    def _add_rod(self, i: int) -> None:
        colour = "pole" if i == 0 else "axle" if i % 2 else "short pole"
        pose, length, thickness = self.pose(), self.value(), self.value()
        end, radius = self.pose(), self.value()
        self.add(
            "polygon", rectangle(0.0, -0.5, 1.0, 0.5), colour,
            pose=pose, size=length, height=thickness,
        )  # fmt: skip
        for place in (pose, end):
            self.add("polygon", arc(0, 2 * pi, 1.0, 16), colour, pose=place, size=radius)
        self.add("disc", [(0.0, 0.0)], "ink", radius=0.04, pose=pose)

    def _numbers(self, state, action, observation, reward) -> list[float]:
        parts = ChainState(state)
        rears = parts.rears()
        middle = float(rears[:, 0].mean())
        around = np.linspace(middle - self.HALF_WIDTH, middle + self.HALF_WIDTH, 21)
        camera = np.array([middle, float(parts.ground(around).mean())])
        numbers: list[float] = []
        first = int((middle - self.HALF_WIDTH) // PIECE)
        for slot in range(self._pieces):
            # a piece keeps its shape until it is out of sight
            place = PIECE * (first + (slot - first) % self._pieces)
            here, there = parts.ground(np.array([place, place + PIECE]))
            numbers += [place - camera[0], here - camera[1]]
            numbers += [atan((there - here) / PIECE), hypot(there - here, PIECE)]
        for metres in self._signs:
            place = START + metres
            numbers += [place - camera[0], float(parts.ground(place)) - camera[1], 0.0]
        ends = rears - camera
        for i in reversed(range(RODS)):
            angle = float(parts.position[2 + i])
            numbers += [*ends[i], angle, parts.lengths[i], parts.thicknesses[i]]
            numbers += [*ends[i + 1], angle, parts.thicknesses[i] / 2]
        shares = parts.load / (self.FULL_FORCE * parts.weight())
        for c, share in enumerate(shares):
            x, y = ends[c // 2 + c % 2]
            numbers += [x, y - parts.thicknesses[c // 2] / 2, pi / 2, min(float(share), 1.5)]
        touching = parts.load.reshape(RODS, 2).sum(axis=1) > 0
        return [*map(float, numbers), *map(float, touching)]


draws(NAME)(ChainScene)
