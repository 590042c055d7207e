"""The pictures of the wheeled robots' arenas: lengths in mm, y upwards."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, pi, radians

import numpy as np

from botschool.render.scene import Scene
from botschool.render.shapes import arc, arrow, rectangle, ring

CAMERA_SECTORS = 8


@dataclass(frozen=True)
class Body:
    """How a robot looks. Its observation starts with the infrared, then the camera readings."""

    name: str
    colour: str
    radius: float
    axle: float
    infrared: tuple[float, ...]
    """Directions of the sensors, degrees from the heading, counter-clockwise."""
    reach: float
    """How far from the surface the infrared sensors see."""
    observations: int
    camera: bool = False


KHEPERA = Body(
    "robot", "blue", 27.5, 53.0,
    (290.9, 318.1, 351.6, 15.7, 44.1, 74.1, 168.6, 193.9), 45.0, observations=8,
)  # fmt: skip
MARXBOT = (85.0, 104.0, (202.5, 247.5, 292.5, 337.5, 22.5, 67.5, 112.5, 157.5), 105.0, 24, True)
PREDATOR = Body("predator", "orange", *MARXBOT)
PREY = Body("prey", "blue", *MARXBOT)


class ArenaScene(Scene):
    """A square arena with walls and robots: trails, infrared, camera and wheels.

    An infrared reading glows as a wedge that grows with it; a camera sector is a piece of a ring
    around the robot. The state starts with x, y and heading of every robot and ends with the
    number of steps; the observation is all robots', the action two wheels a robot.
    """

    fps = 10.0
    side: float
    bodies: tuple[Body, ...]
    trail: int
    """Steps that trails last."""
    scale_bar: float

    def __init__(self) -> None:
        super().__init__()
        self._step = 0.0
        margin = 0.04 * self.side
        self.view = (-margin, -2.6 * margin, self.side + margin, self.side + margin)
        self.scale = 600 / (self.side + 2 * margin)
        self.add("polygon", rectangle(0.0, 0.0, self.side, self.side), "floor")
        self._add_ground()
        self._add_walls(0.2 * margin)
        self._add_scale_bar(-1.2 * margin)
        poses = [self.pose() for _ in self.bodies]
        for body, pose in zip(self.bodies, poses, strict=True):
            self.add(
                "trail", (), body.colour, radius=0.08 * body.radius, pose=pose, steps=self.trail
            )
        self._add_objects(poses)
        for body, pose in zip(self.bodies, poses, strict=True):
            self._add_infrared(body, pose)
            if body.camera:
                self._add_camera(body, pose)
        for body, pose in zip(self.bodies, poses, strict=True):
            self._add_robot(body, pose)
        self.closeups = tuple(
            (body.name, pose, 10 * body.radius)
            for body, pose in zip(self.bodies, poses, strict=True)
        )

    def _add_ground(self) -> None:
        """What the floor looks like."""

    def _add_objects(self, poses: list[int]) -> None:
        """What stands in the arena; `poses` are the robots'."""

    def _add_walls(self, half: float) -> None:
        end = self.side + half
        corners = rectangle(-half, -half, end, end)
        self.add("line", [*corners, corners[0], corners[1]], "wall", radius=half)

    def _add_scale_bar(self, y: float) -> None:
        start, length, tick = 0.0, self.scale_bar, 0.01 * self.side
        self.add("line", [(start, y), (start + length, y)], "muted", radius=0.15 * tick)
        for x in (start, start + length):
            self.add("line", [(x, y - tick / 2), (x, y + tick / 2)], "muted", radius=0.15 * tick)
        where = (start + length / 2, y - 0.035 * self.side)
        self.add("text", [where], "muted", text=f"{length:g} mm")
        for place, body in enumerate(self.bodies):
            x = self.side * (0.55 + 0.25 * place)
            self.add("disc", [(x, y)], body.colour, radius=0.012 * self.side)
            self.add("text", [(x, y - 0.035 * self.side)], "muted", text=body.name)

    def _add_infrared(self, body: Body, pose: int) -> None:
        for degrees in body.infrared:
            angle, half = radians(degrees), radians(11.0)
            size, level = self.value(), self.value()
            wedge = [(0.0, 0.0), *arc(angle - half, angle + half, 1.0)]
            self.add("polygon", wedge, "infrared", pose=pose, size=size, level=level, opacity=0.75)

    def _add_camera(self, body: Body, pose: int) -> None:
        inner, outer = 1.55 * body.radius, 1.85 * body.radius
        width = 2 * pi / CAMERA_SECTORS
        for sector in range(CAMERA_SECTORS):
            piece = ring((sector + 0.03) * width, (sector + 0.97) * width, inner, outer)
            self.add("polygon", piece, "muted", pose=pose, opacity=0.14)
            self.add("polygon", piece, "camera", pose=pose, level=self.value())

    def _add_robot(self, body: Body, pose: int) -> None:
        radius = body.radius
        self.add("disc", [(0.0, 0.0)], body.colour, radius=radius, pose=pose)
        self.add("disc", [(0.0, 0.0)], "white", radius=0.86 * radius, pose=pose, opacity=0.22)
        wheel = rectangle(-0.36 * radius, -0.09 * radius, 0.36 * radius, 0.09 * radius)
        nose = [(0.92 * radius, 0.0), (0.5 * radius, 0.3 * radius), (0.5 * radius, -0.3 * radius)]
        for side in (1, -1):  # left, right
            y = side * min(body.axle / 2, 0.72 * radius)
            corners = [(x, across + y) for x, across in wheel]
            self.add("polygon", corners, "wheel", pose=pose)
            drive = arrow(0.6 * radius, 0.3 * radius)
            self.add("polygon", drive, "white", at=(0.0, y), pose=pose, size=self.value())
        self.add("polygon", nose, "white", pose=pose)
        for degrees in body.infrared:
            direction = np.exp(1j * radians(degrees)) * 0.93 * radius
            dot = (float(direction.real), float(direction.imag))
            self.add("disc", [dot], "white", radius=0.05 * radius, pose=pose, opacity=0.8)

    def _follows(self, state: np.ndarray) -> bool:
        before, self._step = self._step, float(state[-1])
        return self._step > before

    def _numbers(self, state, action, observation, reward) -> list[float]:
        seen = sum(body.observations for body in self.bodies)
        if observation is None:
            observation = np.zeros(seen)
        if len(observation) != seen:
            raise ValueError(f"an observation of {len(observation)} values where {seen} are drawn")
        wheels = 2 * len(self.bodies)
        if len(action) not in (0, wheels):
            raise ValueError(f"an action of {len(action)} values where {wheels} are drawn")
        action = np.clip(action, -1.0, 1.0) if len(action) else np.zeros(wheels)
        numbers = list(state[: 3 * len(self.bodies)]) + self._objects(state, reward)
        first = 0
        for body in self.bodies:
            readings = np.clip(observation[first : first + body.observations], 0.0, 1.0)
            nrays = len(body.infrared)
            for reading in readings[:nrays]:
                numbers += [body.radius + body.reach * reading, reading]
            if body.camera:
                numbers += list(readings[nrays : nrays + CAMERA_SECTORS])
            first += body.observations
        return [*numbers, *action]

    def _objects(self, state: np.ndarray, reward: float) -> list[float]:
        """The numbers of what `_add_objects` added."""
        return []


class DiscrimScene(ArenaScene):
    """ErDiscrim: the cylinder, and around it the zone in which the robot is rewarded."""

    state_size, side, trail, scale_bar = 6, 400.0, 120, 100.0
    bodies = (KHEPERA,)
    CYLINDER, ZONE = 12.5, 100.0

    def _add_objects(self, poses: list[int]) -> None:
        cylinder, near = self.pose(), self.value()
        self.add("disc", [(0.0, 0.0)], "goal", radius=self.ZONE, pose=cylinder, opacity=0.08)
        self.add(
            "disc", [(0.0, 0.0)], "goal",
            radius=self.ZONE, pose=cylinder, opacity=0.16, level=near,
        )  # fmt: skip
        self.add("disc", [(0.0, 0.0)], "object", radius=self.CYLINDER, pose=cylinder)

    def _objects(self, state: np.ndarray, reward: float) -> list[float]:
        x, y, _, cylinder_x, cylinder_y, _ = state
        near = hypot(x - cylinder_x, y - cylinder_y) < self.ZONE
        return [cylinder_x, cylinder_y, 0.0, float(near)]


class PredpreyScene(ArenaScene):
    """ErPredprey: the floor darkens away from the centre, as the ground sensors read it.

    A ring marks where the predator caught the prey, which a reward other than 0 tells.
    """

    state_size, side, trail, scale_bar = 7, 3000.0, 80, 500.0
    bodies = (PREDATOR, PREY)
    robots = ("predator", "prey")

    def _add_ground(self) -> None:
        middle = (self.side / 2, self.side / 2)
        self.add("polygon", rectangle(0.0, 0.0, self.side, self.side), "shade", opacity=0.6)
        for share in np.linspace(1.0, 0.1, 10):
            radius = share * self.side / 2
            self.add("disc", [middle], "floor", radius=float(radius), opacity=0.18)

    def _add_objects(self, poses: list[int]) -> None:
        self._caught, caught = self.pose(), self.value()
        for radius, opacity in ((330.0, 0.18), (250.0, 0.25)):
            self.add(
                "disc", [(0.0, 0.0)], "force",
                radius=radius, pose=self._caught, opacity=opacity, level=caught,
            )  # fmt: skip

    def _objects(self, state: np.ndarray, reward: float) -> list[float]:
        x, y = (state[0] + state[3]) / 2, (state[1] + state[4]) / 2
        return [x, y, 0.0, float(reward != 0.0)]
