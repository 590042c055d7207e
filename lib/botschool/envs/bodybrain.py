"""Simulate body and brain: a chain of segments that crawls or walks over rough ground (Box2D)."""

from __future__ import annotations

from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium import spaces

from botschool.envs.morphology import (
    JOINTS,
    MORPHOLOGY_SIZE,
    SEGMENTS,
    START_X,
    TERRAIN_END,
    TERRAIN_HEIGHT,
    TERRAIN_STEP,
    Morphology,
    decode,
    terrain,
)

try:
    from Box2D import (
        b2ChainShape,
        b2ContactListener,
        b2FixtureDef,
        b2PolygonShape,
        b2RevoluteJoint,
        b2World,
    )
except ImportError as error:
    raise gymnasium.error.DependencyNotInstalled(
        "Box2D, which `pip install 'botschool[box2d]'` installs"
    ) from error

FPS = 50
VELOCITY_ITERATIONS, POSITION_ITERATIONS = 180, 60
GRAVITY = -10.0
FRICTION = 2.5
GROUND, ROBOT = 0x0001, 0x0002
"""Collision categories: segments touch the ground only."""

CLEARANCE = 0.1
"""Metres between the robot's lowest corner and the ground at the start."""

MOTOR_SPEED, MOTOR_TORQUE = 5.0, 90.0
LOST = -100.0
"""Reward for leaving the ground at its left end, and for an exploding robot."""


def _add_shape(body, shape, **options) -> None:
    body.CreateFixture(b2FixtureDef(shape=shape, friction=FRICTION, **options))
    shape.thisown = True  # the definition takes it over, but never frees it


class Touch(b2ContactListener):
    """Counts the contacts of each segment with the ground."""

    def __init__(self) -> None:
        super().__init__()
        self.counts = [0] * SEGMENTS

    def BeginContact(self, contact) -> None:  # noqa: N802
        self.counts[contact.fixtureB.body.userData] += 1

    def EndContact(self, contact) -> None:  # noqa: N802
        self.counts[contact.fixtureB.body.userData] -= 1


class BodyBrain(gymnasium.Env):
    """A torso and ten more segments in a chain, with a motor in each joint.

    64 parameters describe the body (botschool.envs.morphology): an argument of the constructor, or
    of `set_morphology`. Action (10): speed and torque of the motors. Observation (35): torso angle,
    angular velocity, horizontal and vertical velocity and contact; angle (relative to the default
    angle) and speed of each joint; contact of each other segment. Reward: metres forward, 130 / 30
    each, minus 5 for each radian that the torso turns away from the horizontal. `info["distance"]`
    is the torso's progress in metres.

    docs/specification.md, "Bodies", has the exact rules. The torso is the rear end, and the chain
    begins to its right. The body starts with the middle of its extent above the middle of the flat
    part, its lowest corner 0.1 m above the ground. Gravity is 10 m/s^2; ground and segments have
    the same friction. Every episode has a world of its own, so it is a pure function of body, seed
    and actions.
    """

    metadata: ClassVar[dict] = {"render_modes": ["human", "rgb_array"], "render_fps": FPS}
    morphology_size = MORPHOLOGY_SIZE
    """Number of parameters of the body, at the end of a genotype."""

    def __init__(self, render_mode: str | None = None, morphology: np.ndarray | None = None):
        self.render_mode = render_mode
        self.action_space = spaces.Box(-1.0, 1.0, (JOINTS,), np.float32)
        self.observation_space = spaces.Box(-np.inf, np.inf, (5 + 3 * JOINTS,), np.float32)
        self.set_morphology(np.zeros(MORPHOLOGY_SIZE) if morphology is None else morphology)
        self.exploded = False
        self._view: Any = None
        self._world: Any = None

    def set_morphology(self, parameters: np.ndarray) -> None:
        """Set the body of all episodes from the next reset on; 64 numbers. Raises ValueError."""
        self.body: Morphology = decode(parameters)

    def reset(self, *, seed: int | None = None, options: dict | None = None):
        super().reset(seed=seed)
        self.exploded = False
        self.heights = terrain(self.np_random)
        self._touch = Touch()
        self._world = b2World(gravity=(0, GRAVITY), contactListener=self._touch)
        self._make_ground()
        self._make_robot()
        self._start_x = float(self.segments[0].position.x)
        self._potential = self._evaluate_pose()
        if self.render_mode == "human":
            self.render()
        return self._observe(), {"distance": 0.0}

    def _make_ground(self) -> None:
        points = [(TERRAIN_STEP * i, height) for i, height in enumerate(self.heights)]
        ground = self._world.CreateStaticBody()
        _add_shape(ground, b2ChainShape(vertices_chain=points), categoryBits=GROUND)

    def _make_robot(self) -> None:
        body = self.body
        centres, headings = body.pose()
        corners = body.corners()
        left, right = corners[:, :, 0].min(), corners[:, :, 0].max()
        lowest = corners[:, :, 1].min()
        shift = (START_X - (left + right) / 2, TERRAIN_HEIGHT + CLEARANCE - lowest)
        self.segments, self.joints = [], []
        for i in range(SEGMENTS):
            half = (float(body.lengths[i]) / 2, float(body.thicknesses[i]) / 2)
            segment = self._world.CreateDynamicBody(
                position=tuple(map(float, centres[i] + shift)),
                angle=float(headings[i]),
                userData=i,
            )
            density = float(body.densities[i])
            box = b2PolygonShape(box=half)
            _add_shape(segment, box, density=density, categoryBits=ROBOT, maskBits=GROUND)
            if self.segments:
                self.joints.append(self._hinge(i, segment))
            self.segments.append(segment)

    def _hinge(self, i: int, segment) -> b2RevoluteJoint:
        lower, upper = map(float, self.body.limits[i - 1])
        return self._world.CreateRevoluteJoint(
            bodyA=self.segments[-1],
            bodyB=segment,
            localAnchorA=(float(self.body.lengths[i - 1]) / 2, 0),
            localAnchorB=(-float(self.body.lengths[i]) / 2, 0),
            referenceAngle=float(self.body.angles[i]),
            enableLimit=True,
            lowerAngle=lower,
            upperAngle=upper,
            enableMotor=True,
        )

    def step(self, action: np.ndarray):
        if self._world is None or self.exploded:
            raise gymnasium.error.ResetNeeded("call reset before step.")
        action = np.asarray(action, dtype=np.float64)
        if np.isnan(action).any():
            return self._explode()
        try:
            self._advance(action)
        except AssertionError:  # Box2D's own checks
            return self._explode()
        observation, potential = self._observe(), self._evaluate_pose()
        if not (np.isfinite(observation).all() and np.isfinite(potential)):
            return self._explode()
        x = self.segments[0].position.x
        reward, terminated = potential - self._potential, x > TERRAIN_END
        self._potential = potential
        if x < 0:
            reward, terminated = LOST, True
        if self.render_mode == "human":
            self.render()
        return observation, reward, terminated, False, {"distance": x - self._start_x}

    def _advance(self, action: np.ndarray) -> None:
        """Simulate a fiftieth of a second."""
        speeds, torques = MOTOR_SPEED * np.sign(action), MOTOR_TORQUE * np.minimum(abs(action), 1)
        for joint, speed, torque in zip(
            self.joints, speeds.tolist(), torques.tolist(), strict=True
        ):
            joint.motorSpeed = speed
            joint.maxMotorTorque = torque
        self._world.Step(1 / FPS, VELOCITY_ITERATIONS, POSITION_ITERATIONS)

    def _explode(self):
        """End an episode in which numbers have become NaN."""
        self.exploded = True
        nothing = np.zeros(self.observation_space.shape, np.float32)
        return nothing, LOST, True, False, {"distance": 0.0}

    def _evaluate_pose(self) -> float:
        torso = self.segments[0]
        return 130 * torso.position.x / 30 - 5 * abs(torso.angle)

    def _observe(self) -> np.ndarray:
        torso = self.segments[0]
        vx, vy = torso.linearVelocity
        contacts = [float(count > 0) for count in self._touch.counts]
        values = [torso.angle, 2 * torso.angularVelocity / FPS, 0.3 * vx, 0.12 * vy, contacts[0]]
        for joint in self.joints:
            values += [joint.angle, joint.speed / MOTOR_SPEED]
        return np.array(values + contacts[1:], dtype=np.float32)

    def render(self):
        """Return a picture, (400, 600, 3) uint8, or show the next one in the window."""
        if self.render_mode is None:
            gymnasium.logger.warn('make the environment with render_mode="rgb_array" to see it.')
            return None
        if self._view is None:
            from botschool.envs.bodybrain_view import View

            self._view = View(self.render_mode, FPS)
        return self._view.draw(self)

    def close(self) -> None:
        if self._view is not None:
            self._view.close()
            self._view = None
