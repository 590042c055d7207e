"""Draw ErDiscrim, ErPredprey and ErStaybehind: wheeled robots; lengths in mm, y upwards."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, pi, radians

import numpy as np

from botschool.arenas.robots import RobotModel
from botschool.render.scene import Scene, draws
from botschool.render.shapes import arc, arrow, rectangle, ring

# --- The common part of all arenas with wheeled robots: lengths in mm, y upwards.


CAMERA_SECTORS = 8


@dataclass(frozen=True)
class Look:
    """The appearance of a robot. Its observation starts with infrared, then camera readings."""

    name: str
    colour: str
    observations: int
    camera: bool = False


class ArenaScene(Scene):
    """An arena with walls and robots: trails, infrared, camera and wheels.

    An infrared reading is a glowing wedge that grows with it. A camera sector is a piece of a ring
    around the robot. The state starts with x, y and heading of every robot and ends with the number
    of steps. The observation covers all robots; the action has two wheels per robot.
    """

    fps = 10.0
    side: float
    """The arena's width; also its height, unless `tall` is set."""
    tall: float = 0.0
    looks: tuple[Look, ...]
    trail: int
    """Steps that trails last."""
    scale_bar: float

    def __init__(self, robots: tuple[RobotModel, ...]) -> None:
        super().__init__()
        self.models = robots
        self._step = 0.0
        self.tall = self.tall or self.side
        longer = max(self.side, self.tall)
        margin = 0.04 * longer
        self.view = (-margin, -2.6 * margin, self.side + margin, self.tall + margin)
        self.scale = 600 / (longer + 2 * margin)
        self.add("polygon", rectangle(0.0, 0.0, self.side, self.tall), "floor")
        self._add_ground()
        self._add_walls(0.2 * margin)
        self._add_scale_bar(-1.2 * margin)
        poses = [self.pose() for _ in self.looks]
        cast = list(zip(self.looks, self.models, poses, strict=True))
        for look, model, pose in cast:
            self.add(
                "trail", (), look.colour, radius=0.08 * model.radius, pose=pose, steps=self.trail
            )
        self._add_objects(poses)
        for look, model, pose in cast:
            self._add_sensors(look, model, pose)
        for look, model, pose in cast:
            self._add_robot(look, model, pose)
        self.closeups = tuple((look.name, pose, 10 * model.radius) for look, model, pose in cast)

    def _add_ground(self) -> None:
        """Add the floor."""

    def _add_gradient(self) -> None:
        """Add a floor that darkens away from the centre, as ground sensors read it."""
        middle = (self.side / 2, self.side / 2)
        self.add("polygon", rectangle(0.0, 0.0, self.side, self.side), "shade", opacity=0.6)
        for share in np.linspace(1.0, 0.1, 10):
            radius = share * self.side / 2
            self.add("disc", [middle], "floor", radius=float(radius), opacity=0.18)

    def _add_objects(self, poses: list[int]) -> None:
        """Add the objects in the arena; `poses` are the robots'."""

    def _add_sensors(self, look: Look, model: RobotModel, pose: int) -> None:
        self._add_infrared(model, pose)
        if look.camera:
            self._add_camera(pose, 1.55 * model.radius, 1.85 * model.radius, "camera")

    def _sensed(self, look: Look, model: RobotModel, readings: np.ndarray) -> list[float]:
        """Return the numbers of the shapes of `_add_sensors`; readings: of this robot, 0 to 1."""
        nrays = len(model.directions)
        numbers = infrared_numbers(model, readings[:nrays])
        return numbers + list(readings[nrays : nrays + CAMERA_SECTORS] if look.camera else [])

    def _add_walls(self, half: float) -> None:
        corners = rectangle(-half, -half, self.side + half, self.tall + half)
        self.add("line", [*corners, corners[0], corners[1]], "wall", radius=half)

    def _add_scale_bar(self, y: float) -> None:
        start, length, tick = 0.0, self.scale_bar, 0.01 * self.side
        self.add("line", [(start, y), (start + length, y)], "muted", radius=0.15 * tick)
        for x in (start, start + length):
            self.add("line", [(x, y - tick / 2), (x, y + tick / 2)], "muted", radius=0.15 * tick)
        where = (start + length / 2, y - 0.035 * self.side)
        self.add("text", [where], "muted", text=f"{length:g} mm")
        first, apart = (0.55, 0.25) if len(self.looks) < 3 else (0.35, 0.19)
        for place, look in enumerate(self.looks):
            x = self.side * (first + apart * place)
            self.add("disc", [(x, y)], look.colour, radius=0.012 * self.side)
            self.add("text", [(x, y - 0.035 * self.side)], "muted", text=look.name)

    def _add_infrared(self, model: RobotModel, pose: int) -> None:
        for degrees in model.directions:
            angle, half = radians(degrees), radians(11.0)
            size, level = self.value(), self.value()
            wedge = [(0.0, 0.0), *arc(angle - half, angle + half, 1.0)]
            self.add("polygon", wedge, "infrared", pose=pose, size=size, level=level, opacity=0.75)

    def _add_camera(self, pose: int, inner: float, outer: float, colour: str) -> None:
        width = 2 * pi / CAMERA_SECTORS
        for sector in range(CAMERA_SECTORS):
            piece = ring((sector + 0.03) * width, (sector + 0.97) * width, inner, outer)
            self.add("polygon", piece, "muted", pose=pose, opacity=0.14)
            self.add("polygon", piece, colour, pose=pose, level=self.value())

    def _add_robot(self, look: Look, model: RobotModel, pose: int) -> None:
        radius = model.radius
        self.add("disc", [(0.0, 0.0)], look.colour, radius=radius, pose=pose)
        self.add("disc", [(0.0, 0.0)], "white", radius=0.86 * radius, pose=pose, opacity=0.22)
        wheel = rectangle(-0.36 * radius, -0.09 * radius, 0.36 * radius, 0.09 * radius)
        nose = [(0.92 * radius, 0.0), (0.5 * radius, 0.3 * radius), (0.5 * radius, -0.3 * radius)]
        for side in (1, -1):  # left, right
            y = side * min(model.axle / 2, 0.72 * radius)
            corners = [(x, across + y) for x, across in wheel]
            self.add("polygon", corners, "wheel", pose=pose)
            drive = arrow(0.6 * radius, 0.3 * radius)
            self.add("polygon", drive, "white", at=(0.0, y), pose=pose, size=self.value())
        self.add("polygon", nose, "white", pose=pose)
        for degrees in model.directions:
            direction = np.exp(1j * radians(degrees)) * 0.93 * radius
            dot = (float(direction.real), float(direction.imag))
            self.add("disc", [dot], "white", radius=0.05 * radius, pose=pose, opacity=0.8)

    def _follows(self, state: np.ndarray) -> bool:
        before, self._step = self._step, float(state[-1])
        return self._step > before

    def _numbers(self, state, action, observation, reward) -> list[float]:
        seen = sum(look.observations for look in self.looks)
        if observation is None:
            observation = np.zeros(seen)
        if len(observation) != seen:
            raise ValueError(f"an observation of {len(observation)} values where {seen} are drawn")
        wheels = 2 * len(self.looks)
        if len(action) not in (0, wheels):
            raise ValueError(f"an action of {len(action)} values where {wheels} are drawn")
        action = np.clip(action, -1.0, 1.0) if len(action) else np.zeros(wheels)
        numbers = list(state[: 3 * len(self.looks)]) + self._objects(state, reward)
        first = 0
        for look, model in zip(self.looks, self.models, strict=True):
            readings = np.clip(observation[first : first + look.observations], 0.0, 1.0)
            numbers += self._sensed(look, model, readings)
            first += look.observations
        return [*numbers, *action]

    def _objects(self, state: np.ndarray, reward: float) -> list[float]:
        """Return the numbers of the shapes of `_add_objects`."""
        return []


def infrared_numbers(model: RobotModel, readings: np.ndarray) -> list[float]:
    """Return the length and strength of each wedge."""
    return [n for reading in readings for n in (model.radius + model.range * reading, reading)]


# --- ErDiscrim.


@draws("ErDiscrim")
class DiscrimScene(ArenaScene):
    """ErDiscrim: the cylinder, and the zone around it in which the robot is rewarded."""

    state_size, side, trail, scale_bar = 6, 400.0, 120, 100.0
    looks = (Look("robot", "blue", observations=8),)
    CYLINDER = 12.5

    @property
    def zone(self) -> float:
        """Return the distance of the centres below which there is a reward."""
        return self.models[0].radius + self.CYLINDER + 60.0

    def _add_objects(self, poses: list[int]) -> None:
        cylinder, near = self.pose(), self.value()
        self.add("disc", [(0.0, 0.0)], "goal", radius=self.zone, pose=cylinder, opacity=0.08)
        self.add(
            "disc", [(0.0, 0.0)], "goal",
            radius=self.zone, pose=cylinder, opacity=0.16, level=near,
        )  # fmt: skip
        self.add("disc", [(0.0, 0.0)], "object", radius=self.CYLINDER, pose=cylinder)

    def _objects(self, state: np.ndarray, reward: float) -> list[float]:
        x, y, _, cylinder_x, cylinder_y, _ = state
        near = hypot(x - cylinder_x, y - cylinder_y) < self.zone
        return [cylinder_x, cylinder_y, 0.0, float(near)]


# --- ErPredprey.


@draws("ErPredprey")
class PredpreyScene(ArenaScene):
    """ErPredprey: the floor darkens away from the centre, as the ground sensors read it.

    A ring marks the place of a catch, known by a reward other than 0; then the robots touch.
    """

    state_size, side, trail, scale_bar = 7, 3000.0, 80, 500.0
    looks = (Look("predator", "orange", 24, camera=True), Look("prey", "blue", 24, camera=True))
    robots = ("predator", "prey")

    def _add_ground(self) -> None:
        self._add_gradient()

    def _add_objects(self, poses: list[int]) -> None:
        self._caught, caught = self.pose(), self.value()
        for radius, opacity in ((330.0, 0.18), (250.0, 0.25)):
            self.add(
                "disc", [(0.0, 0.0)], "force",
                radius=radius, pose=self._caught, opacity=opacity, level=caught,
            )  # fmt: skip

    def _numbers(self, state, action, observation, reward) -> list[float]:
        if reward:
            state = state.copy()
            state[:2] = touching(state[:2], state[3:5], sum(model.radius for model in self.models))
        return super()._numbers(state, action, observation, reward)

    def _objects(self, state: np.ndarray, reward: float) -> list[float]:
        x, y = (state[0] + state[3]) / 2, (state[1] + state[4]) / 2
        return [x, y, 0.0, float(reward != 0.0)]


def touching(predator: np.ndarray, prey: np.ndarray, apart: float) -> np.ndarray:
    """Return the position, x and y, at which to draw a predator that has caught the prey.

    The arena does not carry out a move that ends in a collision, so the last poses leave a gap.
    apart: distance of the centres of touching robots.
    """
    away = predator - prey
    return prey + away * (apart / np.linalg.norm(away))


# --- ErStaybehind.


NEAR, FAR = 340.0, 600.0
"""Distances of the centres between which the leader should be."""


@draws("ErStaybehind")
class StaybehindScene(ArenaScene):
    """ErStaybehind: a red disc and the word "blocked" mark a blocked robot.

    The piece of a ring ahead of the follower is where the leader should be; it is green in a
    rewarded step. The floor darkens away from the centre, as the ground sensors read it.
    """

    state_size, side, trail, scale_bar = 9, 3000.0, 80, 500.0
    looks = (
        Look("follower", "orange", 32, camera=True),
        Look("leader", "blue", 32, camera=True),
    )
    robots = ("follower", "leader")

    def _add_ground(self) -> None:
        self._add_gradient()

    def _add_objects(self, poses: list[int]) -> None:
        place = ring(radians(-45), radians(45), NEAR, FAR)
        self.add("polygon", place, "muted", pose=poses[0], opacity=0.12)
        self.add("polygon", place, "goal", pose=poses[0], opacity=0.45, level=self.value())
        for pose in poses:
            blocked, where = self.value(), self.pose()
            self.add(
                "disc", [(0.0, 0.0)], "force", radius=190.0, pose=pose, opacity=0.45, level=blocked
            )
            self.add("text", [(0.0, 0.0)], "force", pose=where, level=blocked, text="blocked")

    def _numbers(self, state, action, observation, reward) -> list[float]:
        action = np.concatenate([wheels(*pair) for pair in action.reshape(-1, 2)] or [action])
        return super()._numbers(state, action, observation, reward)

    def _objects(self, state: np.ndarray, reward: float) -> list[float]:
        numbers = [float(reward > 0)]
        for robot in range(2):
            x, y = state[3 * robot : 3 * robot + 2]
            numbers += [state[6 + robot], x, y + 260.0, 0.0]
        return numbers


def wheels(speed: float, turn: float) -> np.ndarray:
    """Return an action's shares of the greatest speed for the left and the right wheel."""
    forward, turn = (speed + 1) / 2, (turn + 1) / 2
    slower = forward * (1 - 2 * abs(turn - 0.5))
    return np.array([slower, forward] if turn < 0.5 else [forward, slower])
