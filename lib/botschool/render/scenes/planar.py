"""PlanarHopper, PlanarWalker2D and PlanarHalfCheetah: bodies that run ahead, seen from the side."""

from __future__ import annotations

from functools import partial
from math import cos, pi, sin

from botschool import _core
from botschool.problems.native import INFOS
from botschool.render.scene import Scene, draws
from botschool.render.shapes import arrow, rectangle


class PlanarScene(Scene):
    """A body of segments, and the ground's force at each contact point as an arrow.

    The picture goes along with the body; lines on the ground, a metre apart, show how it moves.
    """

    scale = 150.0
    HALF_WIDTH, BELOW, ABOVE = 2.0, 0.35, 2.05
    FULL_FORCE = 5.0
    """Arrows have full length at so many times the body's weight."""

    def __init__(self, problem: str, body: str, far: int, robots: tuple = ()) -> None:
        """body: as in `_core.PlanarBody`; far: metres up to which the way is marked."""
        super().__init__()
        info, table = INFOS[problem], _core.PlanarBody(body).table
        self.state_size, self.fps = info["states"], 1 / info["seconds"]
        self.view = (-self.HALF_WIDTH, -self.BELOW, self.HALF_WIDTH, self.ABOVE)
        self._segments, self._contacts = table["segments"], table["contacts"]
        self._weight = 9.81 * table["masses"][:, 0].sum()
        self._first_load = self.state_size - len(self._contacts)
        self._add_ground(far)
        poses = [self.pose() for _ in self._segments]
        # what is called left is behind what is not
        order = sorted(range(len(poses)), key=lambda i: not self._hidden(i))
        for i in order:
            self._add_segment(i, poses[i])
        for _ in self._contacts:
            self.add("polygon", arrow(0.5, 0.1), "force", pose=self.pose(), size=self.value())
        self._feet = [i for i, s in enumerate(self._segments) if s["name"].endswith("foot")]
        self.charted = (("feet", tuple(self.value() for _ in self._feet)),)

    def body(self) -> dict:
        """What `_numbers` knows of the body, ready for JSON, for the twin in scenes.js."""
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
