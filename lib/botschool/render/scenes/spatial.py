"""Draw SpatialAnt, SpatialHumanoid and SpatialHumanoidStandup: bodies in space, in perspective."""

from __future__ import annotations

from functools import partial
from math import cos, sin

import numpy as np

from botschool import _core
from botschool.problems.native import INFOS
from botschool.render.scene import Scene, draws
from botschool.render.space import Space, SpacePainter

WEST, STEEP = 0.42, 0.3
"""Direction of the camera: radians from the right side to the front, and up from the ground."""


class SpatialScene(Scene):
    """A body of capsules and balls on chequered ground, and a camera that follows.

    The numbers of a step are the body's coordinates, and whether each of its ends is on the ground.
    """

    scale = 150.0
    view = (-2.4, -1.2, 2.4, 1.52)
    """In metres at the distance of the robot; (0, 0) is what the camera looks at."""
    FRAMED = 0.5
    """Height of what the camera looks at, in heights of the body."""

    def __init__(self, problem: str, body: str, height: float, robots: tuple = ()) -> None:
        """Make the picture; body: as in `_core.SpatialBody`; height: of the body in metres."""
        super().__init__()
        info, self._body = INFOS[problem], _core.SpatialBody(body)
        table = self._body.table
        self.state_size, self.fps = info["states"], 1 / info["seconds"]
        parents = {link["parent"] for link in table["links"]}
        ends = [i for i in range(len(table["links"])) if i not in parents]
        self._touching = [[ball[0] == end for ball in table["balls"]] for end in ends]
        self._coordinates = self._body.coordinates
        self.count = self._coordinates + len(ends)
        self.charted = (("ground", tuple(range(self._coordinates, self.count))),)
        self.memory = round(self.fps)
        self.space = Space(
            links=tuple((link["parent"], *link["place"], *link["axis"]) for link in table["links"]),
            limbs=tuple(_limbs(table)),
            height=self.FRAMED * height,
            **dict(zip(("right", "up", "back"), _axes(), strict=True)),
            memory=self.memory,
            seconds=info["seconds"],
        )

    def body(self) -> dict:
        """Return `_numbers`' data about the body, ready for JSON, for the twin in scenes.js."""
        return {"coordinates": self._coordinates, "touching": self._touching}

    def painter(self) -> SpacePainter:
        """Return what paints the frames."""
        return SpacePainter(self.space, self._body.places, self.view, self.scale)

    def _numbers(self, state, action, observation, reward) -> list[float]:
        loads = state[-len(self._touching[0]) :]
        touching = [float(loads[balls].sum() > 0) for balls in self._touching]
        return [*state[: self._coordinates].tolist(), *touching]

    def _follows(self, state: np.ndarray) -> bool:
        """Return whether the robot is where it was, nearly."""
        return bool(self._past) and np.abs(self._past[-1][:3] - state[:3]).max() < 0.5


def _axes() -> tuple[tuple[float, float, float], ...]:
    """Return the directions right, up and back of the camera."""
    back = (sin(WEST) * cos(STEEP), -cos(WEST) * cos(STEEP), sin(STEEP))
    right = (cos(WEST), sin(WEST), 0.0)
    return right, tuple(np.cross(back, right).tolist()), back


def _limbs(table: dict):
    """Yield each shape: link, one end, the other end, radius, colour."""
    balls = [(link, np.array(place), radius) for link, place, _, radius in table["shapes"]]
    for link, place, half, radius in table["shapes"]:
        ends = [np.array(place) - half, np.array(place) + half]
        for i, (a, b) in enumerate((ends, ends[::-1])):
            for other, centre, larger in balls:
                if other == link and larger > radius and np.abs(a - centre).max() < 1e-9:
                    # begin at the surface of the ball that the end is in
                    way = (b - a) / np.linalg.norm(b - a)
                    ends[i] = a + way * min(larger, float(np.linalg.norm(b - a)))
        yield (link, *ends[0].tolist(), *ends[1].tolist(), radius, _colour(table["links"], link))


def _colour(links: list[dict], link: int) -> str:
    """Return the colour of a limb: its side can be seen, and the trunk."""
    name = links[link]["name"]
    while link and not name.startswith(("left", "right")):
        place = links[link]["place"]
        if place[1]:
            name = "left" if place[1] > 0 else "right"
        link = links[link]["parent"]
    return {"left": "short pole", "righ": "axle"}.get(name[:4], "pole")


for _name, _body, _height in (
    ("SpatialAnt-v0", "ant", 0.75),
    ("SpatialAnt-v5", "ant", 0.75),
    ("SpatialHumanoid-v0", "humanoid", 1.6),
    ("SpatialHumanoid-v5", "humanoid", 1.6),
    ("SpatialHumanoidStandup-v0", "humanoidstandup", 1.2),
):
    draws(_name)(partial(SpatialScene, _name, _body, _height))
