"""Answer the calls of PyBullet that exercise 10 makes, where PyBullet is not installed.

The exercise's robot moves by the equations of bodies in space, as SpatialBalanceBot-v0 does. Names,
arguments and answers are PyBullet's. Robots do not touch each other, and pictures show the side.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from botschool import _core

error = type("error", (Exception,), {})
GUI, DIRECT, VELOCITY_CONTROL, URDF_USE_INERTIA_FROM_FILE = 1, 2, 0, 2
SERVO, SUBSTEP, FIRM = 1000.0, 0.002, _core.Firmness(friction=0.8)
"""Of motors that follow a speed, N m s/rad; seconds; friction of the wheels."""
HIGH = 1e3
"""Metres by which a world without ground is lifted."""
ROBOT = "balance_bot.urdf"
"""Of this file the tables are: a torso that touches the ground with the four edges of a box, and
two wheels, which do as balls."""
LINKS = ("torso", "left_axle", "right_axle")
ROWS = np.zeros((3, 35))
ROWS[:, 0], ROWS[1:, 1:4] = (-1, 0, 0), ((-0.12, 0, 0.1), (0.12, 0, 0.1))
ROWS[1:, 4], ROWS[:, 13], ROWS[1:, 24] = (-1, 1), (-1, 0, 1), SERVO
ROWS[:, 14], ROWS[0, 17], ROWS[:, 18:21] = (0.8, 0.1, 0.1), 0.3, ((1e-3,), (1e-4,), (1e-4,))
SHAPES = np.zeros((6, 8))
SHAPES[:4, 1:4] = [(x, y, 0.3) for x in (-0.1, 0.1) for y in (-0.025, 0.025)]
SHAPES[:4, 6], SHAPES[4:, 0], SHAPES[4:, 7] = 0.2, (1, 2), 0.1


def __getattr__(name: str) -> Any:
    raise AttributeError(
        f"PyBullet is not installed here, and what stands in for it has no '{name}', only what the "
        "text of exercise 10 names."
    )


class Robot:
    """The exercise's robot. The state is that of _core.SpatialBody."""

    def __init__(self, given_inertia: bool) -> None:
        rows, self.shapes = ROWS.copy(), SHAPES
        for i, row in enumerate(() if given_inertia else rows):  # of a box around the shapes
            own = self.shapes[self.shapes[:, 0] == i]
            size = 2 * (np.abs(own[:, 1:4] - own[:, 1:4].mean(0)) + abs(own[:, 4:7]) + own[:, 7:])
            row[18:21] = row[14] / 12 * ((size.max(0) ** 2).sum() - size.max(0) ** 2)
        self.centre, self.joints = rows[0, 15:18], len(rows) - 1
        self._race = _core.Race()
        self._race.declare(
            LINKS, rows, self.shapes, [""] * 6, [], [1, 0, 0, 0, 0, 0], FIRM, seconds=0.01,
            substeps=5, height=0.0, noise=0.0, low=0.0, high=1.0, alive=0.0, effort=0.0,
        )  # fmt: skip
        self.body = _core.SpatialBody(self._race)
        self.state = np.zeros(self.body.size)
        n = self.body.coordinates
        self.base, self.rates = slice(n, n + 6), slice(n + 6, n + self.body.speeds)
        self.motors = [(0.0, 1e5)] * self.joints
        """Target speed and largest torque of each."""

    def orientation(self) -> tuple[float, ...]:
        w, x, y, z = self.state[3:7].tolist()
        return x, y, z, w

    def turn(self) -> np.ndarray:
        """Return the rotation from the base to the world."""
        return np.reshape(getMatrixFromQuaternion(self.orientation()), (3, 3))

    def put(self, origin: Any, orientation: Any) -> None:
        x, y, z, w = np.array(orientation, float) / np.linalg.norm(orientation)
        self.state[:7] = *origin, w, x, y, z
        self.state[self.rates.stop :] = 0.0  # nothing is held by the ground

    def step(self, seconds: float, gravity: np.ndarray, ground: bool) -> None:
        target, torque = np.array(self.motors).T
        lag = target - self.state[self.rates]
        speeds = self.state[self.rates] + np.clip(lag, -torque / SERVO, torque / SERVO)
        self.state[self.base][:2] += seconds * gravity[:2]  # as all other parts
        lift, steps = 0.0 if ground else HIGH, max(1, round(seconds / SUBSTEP))
        self.state[2] += lift
        self.state = self.body.advance(
            self.state, speeds, seconds / steps, steps, -gravity[2], FIRM
        )
        self.state[2] -= lift


class World:
    """A simulation: its bodies (None is the ground) and rules."""

    def __init__(self) -> None:
        self.bodies: list[Robot | None] = []
        self.gravity, self.seconds = np.zeros(3), 1 / 240


_worlds: dict[int, World] = {}


def _world(number: int) -> World:
    if number not in _worlds:
        raise error("Not connected to physics server.")
    return _worlds[number]


def _robot(number: int, client: int, joint: int = 0) -> Robot:
    bodies = _world(client).bodies
    robot = bodies[number] if 0 <= number < len(bodies) else None
    if robot is None or not 0 <= joint < robot.joints:
        raise error(f"this simulation has no robot {number} with a joint {joint}.")
    return robot


def connect(method: int) -> int:
    number = next(i for i in range(len(_worlds) + 1) if i not in _worlds)
    _worlds[number] = World()
    return number


def disconnect(physicsClientId: int = 0) -> None:
    _world(physicsClientId)
    del _worlds[physicsClientId]


def resetSimulation(flags: int = 0, physicsClientId: int = 0) -> None:
    _world(physicsClientId).__init__()  # type: ignore[misc]


def setGravity(gravX: float, gravY: float, gravZ: float, physicsClientId: int = 0) -> None:
    _world(physicsClientId).gravity = np.array([gravX, gravY, gravZ], float)


def setTimeStep(timeStep: float, physicsClientId: int = 0) -> None:
    _world(physicsClientId).seconds = float(timeStep)


def stepSimulation(physicsClientId: int = 0) -> None:
    world = _world(physicsClientId)
    for robot in filter(None, world.bodies):
        robot.step(world.seconds, world.gravity, None in world.bodies)


def loadURDF(
    fileName: str,
    basePosition: Sequence[float] = (0, 0, 0),
    baseOrientation: Sequence[float] = (0, 0, 0, 1),
    flags: int = 0,
    physicsClientId: int = 0,
) -> int:
    bodies, robot = _world(physicsClientId).bodies, None
    if Path(fileName).name != "plane.urdf":
        if not Path(fileName).is_file():
            raise error("Cannot load URDF file.")
        if Path(fileName).name != ROBOT:
            raise error(f"what stands in for PyBullet has plane.urdf and {ROBOT} alone.")
        robot = Robot(bool(flags & URDF_USE_INERTIA_FROM_FILE))
        robot.put(basePosition, baseOrientation)
    bodies.append(robot)
    return len(bodies) - 1


def getNumBodies(physicsClientId: int = 0) -> int:
    return len(_world(physicsClientId).bodies)


def getNumJoints(bodyUniqueId: int, physicsClientId: int = 0) -> int:
    robot = dict(enumerate(_world(physicsClientId).bodies)).get(bodyUniqueId)
    return robot.joints if robot else 0


def getBasePositionAndOrientation(bodyUniqueId: int, physicsClientId: int = 0) -> tuple:
    robot = _robot(bodyUniqueId, physicsClientId)
    place = robot.state[:3] + robot.turn() @ robot.centre
    return tuple(place.tolist()), robot.orientation()


def resetBasePositionAndOrientation(
    bodyUniqueId: int, posObj: Any, ornObj: Any, physicsClientId: int = 0
) -> None:
    robot = _robot(bodyUniqueId, physicsClientId)
    robot.put((0, 0, 0), ornObj)
    robot.state[:3] = np.array(posObj, float) - robot.turn() @ robot.centre


def getBaseVelocity(bodyUniqueId: int, physicsClientId: int = 0) -> tuple:
    robot = _robot(bodyUniqueId, physicsClientId)
    turn, own = robot.turn(), robot.state[robot.base]
    turning = turn @ own[3:]
    velocity = own[:3] + np.cross(turning, turn @ robot.centre)
    return tuple(velocity.tolist()), tuple(turning.tolist())


def resetBaseVelocity(
    objectUniqueId: int,
    linearVelocity: Any = (0, 0, 0),
    angularVelocity: Any = (0, 0, 0),
    physicsClientId: int = 0,
) -> None:
    robot = _robot(objectUniqueId, physicsClientId)
    turn, turning = robot.turn(), np.array(angularVelocity, float)
    velocity = np.array(linearVelocity, float) - np.cross(turning, turn @ robot.centre)
    robot.state[robot.base] = *velocity, *(turn.T @ turning)


def getJointState(bodyUniqueId: int, jointIndex: int, physicsClientId: int = 0) -> tuple:
    robot = _robot(bodyUniqueId, physicsClientId, jointIndex)
    angle, rate = robot.state[7 + jointIndex], robot.state[robot.rates][jointIndex]
    return float(angle), float(rate), (0.0,) * 6, 0.0


def setJointMotorControl2(
    bodyUniqueId: int,
    jointIndex: int,
    controlMode: int,
    *,
    targetVelocity: float = 0.0,
    force: float = 1e5,
    physicsClientId: int = 0,
) -> None:
    robot = _robot(bodyUniqueId, physicsClientId, jointIndex)
    if controlMode != VELOCITY_CONTROL:
        raise error("what stands in for PyBullet has VELOCITY_CONTROL alone.")
    robot.motors[jointIndex] = float(targetVelocity), float(force)


def setJointMotorControlArray(
    bodyUniqueId: int,
    jointIndices: Sequence[int],
    controlMode: int,
    *,
    targetVelocities: Sequence[float],
    forces: Sequence[float] | None = None,
    physicsClientId: int = 0,
) -> None:
    for i, (joint, speed) in enumerate(zip(jointIndices, targetVelocities, strict=True)):
        force = 1e5 if forces is None else forces[i]
        own: dict[str, Any] = {"targetVelocity": speed, "physicsClientId": physicsClientId}
        setJointMotorControl2(bodyUniqueId, joint, controlMode, force=force, **own)


def getQuaternionFromEuler(eulerAngles: Sequence[float]) -> tuple[float, ...]:
    (a, b, c), (u, v, w) = ([f(x / 2) for x in eulerAngles] for f in (math.sin, math.cos))
    x, y = a * v * w - u * b * c, u * b * w + a * v * c
    return x, y, u * v * c - a * b * w, u * v * w + a * b * c


def getMatrixFromQuaternion(quaternion: Sequence[float]) -> tuple[float, ...]:
    x, y, z, w = quaternion
    return (
        1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
        2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
        2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y),
    )  # fmt: skip


def getEulerFromQuaternion(quaternion: Sequence[float]) -> tuple[float, float, float]:
    m = getMatrixFromQuaternion((np.array(quaternion) / np.linalg.norm(quaternion)).tolist())
    pitch = math.asin(min(max(-m[6], -1.0), 1.0))
    return math.atan2(m[7], m[8]), pitch, math.atan2(m[3], m[0])


def computeViewMatrixFromYawPitchRoll(cameraTargetPosition: Any, *_: Any, **__: Any) -> Any:
    return cameraTargetPosition


def computeProjectionMatrixFOV(*_: Any, **__: Any) -> None:
    return None


def getCameraImage(
    width: int, height: int, viewMatrix: Any, *_: Any, physicsClientId: int = 0, **__: Any
) -> tuple:
    """Draw the robots from the side, y to the right: balls as discs, other shapes as bars."""
    from PIL import Image, ImageDraw

    image = Image.new("RGBA", (width, height), "#eef2f5")
    draw, scale = ImageDraw.Draw(image), height / 0.8

    def seen(point: np.ndarray) -> tuple[float, float]:
        return width / 2 + scale * (point[1] - viewMatrix[1]), height * 0.8 - scale * point[2]

    floor = height * 0.8
    draw.rectangle((0, floor, width, height), fill="#c9d2d8")
    for tick in range(-5, 6):
        at = seen(np.array([0, round(viewMatrix[1] / 0.1) * 0.1 + 0.1 * tick, 0]))[0]
        draw.line((at, floor, at, floor + 6), fill="#5f6a72", width=2)
    for robot in filter(None, _world(physicsClientId).bodies):
        places = robot.body.places(robot.state[: robot.body.coordinates])
        for link, *form in robot.shapes:
            origin, axes = places[int(link)][0], places[int(link)][1:]
            x, y = seen(middle := origin + np.array(form[:3]) @ axes)
            half, r = np.array(form[3:6]) @ axes, scale * form[6]
            draw.line((*seen(middle - half), *seen(middle + half)), fill="#0072b2", width=26)
            draw.ellipse((x - r, y - r, x + r, y + r), fill="#404047")
            draw.line((x, y, *seen(middle + form[6] * axes[2])), fill="#eef2f5", width=3)
    return width, height, np.asarray(image).ravel(), (), ()


def getDataPath() -> str:
    """Stand for the function of pybullet_data."""
    return "pybullet_data"
