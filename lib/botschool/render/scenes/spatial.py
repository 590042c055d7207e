"""Draw robots of races in space, and the one on two wheels, in perspective."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from botschool import _core
from botschool.problems.native import INFOS
from botschool.render.scene import Scene, draws
from botschool.render.space import Space, SpacePainter


class SpatialScene(Scene):
    """A body of capsules and balls on chequered ground, and a camera that follows.

    The numbers of a step are the body's coordinates, and whether each of its ends is on the ground.
    """

    scale = 150.0
    view = (-2.4, -1.2, 2.4, 1.52)
    """In metres at the distance of the robot; (0, 0) is what the camera looks at."""

    def __init__(
        self,
        body: Any,
        seconds: float,
        height: float,
        robots: tuple = (),
        states: int = 0,
        looks: Any = None,
    ) -> None:
        """Make the picture; body: of `_core.SpatialBody`; height: where the camera looks.

        At height 0 it looks at the middle of the body, from as near as the body is small.
        states: of the problem, 0 if it has those of its body only. looks: what is drawn, of each
        bar its link, ends and radius; None: the body's shapes.
        """
        super().__init__()
        self._body = _core.SpatialBody(body)
        table = self._body.table
        self.state_size, self.fps = states or self._body.size, 1 / seconds
        parents = {link["parent"] for link in table["links"]}
        ends = [i for i in range(len(table["links"])) if i not in parents]
        self._touching = [[ball[0] == end for ball in table["balls"]] for end in ends]
        self._coordinates = self._body.coordinates
        self._first_load = self._body.size - len(table["balls"])
        self.count = self._coordinates + len(ends)
        self.charted = (("ground", tuple(range(self._coordinates, self.count))),)
        self.memory = round(self.fps)
        self.space = Space(
            links=tuple(
                (link["parent"], *link["place"], *link["axis"], int(link["slides"]))
                for link in table["links"]
            ),
            limbs=tuple(_limbs(self._body) if looks is None else _bars(self._body, looks)),
            height=height,
            memory=self.memory,
            seconds=seconds,
        )
        if not height:
            self._come_near()

    def _come_near(self) -> None:
        places = self._body.places(np.eye(self._coordinates)[3])
        reach = [places[limb[0], 0] + limb[7] for limb in self.space.limbs]
        reach += [places[limb[0], 0] - limb[7] for limb in self.space.limbs]
        sizes = np.ptp(reach, axis=0)
        near = float(np.clip(sizes.max() / 1.6, 0.2, 4.0))
        left, bottom, right, top = self.view
        self.view = near * left, near * bottom, near * right, near * top
        self.scale /= near
        self.space = replace(self.space, height=sizes[2] / 2, distance=near * self.space.distance)

    def stand_on(self, ground: tuple[float, float, float]) -> SpatialScene:
        """Draw ground of this slope and step; the phases of its bumps are unknown here."""
        self.space = replace(self.space, slope=ground[0], step=ground[1])
        return self

    def body(self) -> dict:
        """Return `_numbers`' data about the body, ready for JSON, for the twin in scenes.js."""
        return {
            "coordinates": self._coordinates,
            "loads": self._first_load,
            "touching": self._touching,
        }

    def painter(self) -> SpacePainter:
        """Return what paints the frames."""
        return SpacePainter(self.space, self._body.places, self.view, self.scale)

    def _numbers(self, state, action, observation, reward) -> list[float]:
        loads = state[self._first_load :][: len(self._touching[0])]
        touching = [float((loads[balls] > 0).any()) for balls in self._touching]
        return [*state[: self._coordinates].tolist(), *touching]

    def _follows(self, state: np.ndarray) -> bool:
        """Return whether the robot is where it was, nearly."""
        return bool(self._past) and np.abs(self._past[-1][:3] - state[:3]).max() < 0.5


def _limbs(body: Any) -> Iterator[tuple]:
    """Yield each shape: link, one end, the other end, radius, colour."""
    shapes = body.table["shapes"]
    places = body.places(np.eye(body.coordinates)[3])
    balls = {(link, *np.round(place, 9)) for link, place, half, _ in shapes if not np.any(half)}
    for link, place, half, radius in shapes:
        ends = [np.array(place) - half, np.array(place) + half]
        for one in (0, 1):
            if np.any(half) and (link, *np.round(ends[one], 9)) in balls:
                ends[one] = ends[1 - one]  # the rest is inside the ball
        left = (places[link, 0] + np.array(place) @ places[link, 1:])[1]
        colour = "pole" if abs(left) < 0.03 else "short pole" if left > 0 else "axle"
        yield (link, *ends[0].tolist(), *ends[1].tolist(), radius, colour)


def _bars(body: Any, looks: Any) -> Iterator[tuple]:
    """Yield each bar of a robot of one's own: link, one end, the other end, radius, colour."""
    places = body.places(np.eye(body.coordinates)[3])
    for link, *ends, radius in looks:
        left = places[int(link), 0, 1]
        colour = "pole" if abs(left) < 0.03 else "short pole" if left > 0 else "axle"
        yield int(link), *map(float, ends), float(radius), colour


for _name, _body, _height in (
    ("SpatialAnt-v0", "ant", 0.35),
    ("SpatialAnt-v5", "ant", 0.35),
    ("SpatialBody-v0", "ant", 0.35),
    ("SpatialHumanoid-v0", "humanoid", 0.8),
    ("SpatialHumanoid-v5", "humanoid", 0.8),
    ("SpatialHumanoidStandup-v0", "humanoidstandup", 0.6),
    ("SpatialBalanceBot-v0", "balancebot", 0.0),
):
    if _name in INFOS:  # a core may be built of a few problems
        _info = INFOS[_name]
        draws(_name)(
            partial(SpatialScene, _body, _info["seconds"], _height, states=_info["states"])
        )
