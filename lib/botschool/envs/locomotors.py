"""Simulate Hopper, HalfCheetah, Ant, Walker2D and Humanoid by PyBullet: robots that learn to run.

Version 0 equals pybullet_envs_gymnasium 0.6: the same robots, physics, observations, rewards and
ends. Version 5 is for evolution: its reward is almost only progress, because a robot that is
rewarded for standing learns to stand (Pagliuca, Milano and Nolfi, 2020).

An episode depends only on its seed and actions. pybullet_envs_gymnasium measures the start of its
very first episode without the floor, and of all others with it, which changes the first step's
progress by up to 0.15. Here every episode is like its second and later ones.
"""

from __future__ import annotations

import math
import time
import weakref
from typing import Any, ClassVar

import gymnasium
import numpy as np
from gymnasium import spaces

from botschool.envs import bullet
from botschool.envs.locomotor_bodies import BODIES, Measured
from botschool.errors import BotschoolError

STEP = 0.0165
"""Seconds of a step, simulated in four parts."""
TARGET = 1000.0
"""Position on the x axis that a robot runs to, in metres from the start."""
AT_LIMIT = 0.99
"""Share of a joint's range, on either side, beyond which the joint is at its limit."""
BELOW_GROUND = -1.0
"""Height in metres below which a robot has fallen through the floor."""
ALOFT = 50.0
"""Height in metres at which a robot touches nothing."""
STEPS_OF_PICTURE = 2
"""Steps per picture: drawing is slow without a graphics card, and a film needs only 30 a second."""
COLOURS = {
    "torso": (0.35, 0.4, 0.5, 1),
    "foot": (0.15, 0.15, 0.2, 1),
    "left": (0.25, 0.6, 0.75, 1),
    "": (0.9, 0.55, 0.15, 1),
}
"""Word in the name of a part -> its colour: red, green, blue, opacity."""
UNREAL = 1e4
"""Sum of an observation's unclipped values that only a broken simulation reaches."""


class Locomotor(gymnasium.Env):
    """One of BODIES on an endless plane, to run along the x axis.

    Observation, float32 in [-5, 5]: torso height relative to the start (m); sine and cosine of the
    angle to the target; 0.3 * velocity (m/s) ahead, sideways, up; roll and pitch (rad); for each
    joint its position, -1 and 1 at the limits, and a tenth of its speed (rad/s); for each of
    `feet`, 1 if it touched the floor after the previous step. Action: a torque for each joint, full
    at -1 and 1.

    `info` holds the components of the reward in both versions, {"v0": {...}, "v5": {...}}; the
    reward is the sum of its own version's components. When numbers are no longer finite or the
    robot has fallen through the floor, the episode ends (terminated) with a reward of 0 and the
    last valid observation, and `info` is {"exploded": True}.
    """

    metadata: ClassVar[dict[str, Any]] = {
        "render_modes": ["human", "rgb_array"],
        "render_fps": 60,
    }

    def __init__(self, body: str, version: int = 0, render_mode: str | None = None) -> None:
        """Make the environment. Raises BotschoolError without PyBullet or its models."""
        self.body = BODIES[body]
        self.version = version
        self.render_mode = render_mode
        self._noise = self.body.evolved_noise if version == 5 else 0.1
        self._ends = not (body == "HalfCheetah" and version == 0)
        self._bullet = bullet.import_pybullet()
        self._client = bullet.connect(window=render_mode == "human")
        self._end = weakref.finalize(self, bullet.disconnect, self._client)
        self._build()
        n = len(self._joints)
        self.action_space = spaces.Box(-1.0, 1.0, (n,), np.float32)
        size = 8 + 2 * n + len(self._feet)
        self.observation_space = spaces.Box(-5.0, 5.0, (size,), np.float32)
        self._full = self.action_space.low, self.action_space.high
        self._seen = self.observation_space.low, self.observation_space.high
        self._next_frame = 0.0
        self._place = (0.0, 0.0, 1.0)
        self._steps = self._drawn = 0
        self._picture: np.ndarray | None = None

    def _build(self) -> None:
        """Make the world anew, with which every episode starts."""
        world = {"physicsClientId": self._client}
        self._bullet.resetSimulation(**world)
        self._bullet.setGravity(0, 0, -9.8, **world)
        self._bullet.setDefaultContactERP(0.9, **world)
        self._bullet.setPhysicsEngineParameter(
            fixedTimeStep=STEP,
            numSolverIterations=5,
            numSubSteps=4,
            deterministicOverlappingPairs=1,
            **world,
        )
        folder = bullet.data_folder()
        self._floor = bullet.load_floor(self._client, folder / "plane_stadium.sdf")
        path = folder / "mjcf" / f"{self.body.model}.xml"
        self._robot = bullet.load_model(self._client, path, bullet.SELF_COLLISION)
        self._find_parts(path)
        self._start = self._bullet.saveState(**world)
        self._exploded = False

    def _find_parts(self, path) -> None:
        world = {"physicsClientId": self._client}
        count = self._bullet.getNumJoints(self._robot, **world)
        infos = [self._bullet.getJointInfo(self._robot, i, **world) for i in range(count)]
        parts = {info[12].decode(): info[0] for info in infos}
        free = [info for info in infos if not info[1].startswith((b"ignore", b"jointfix"))]
        names = [info[1].decode() for info in free]
        if not free or any(foot not in parts for foot in self.body.feet):
            raise BotschoolError(
                f"{path} is not the model that comes with PyBullet: install pybullet again."
            )
        self._bullet.setJointMotorControlArray(
            self._robot,
            range(count),
            self._bullet.POSITION_CONTROL,
            forces=[0.0] * count,
            **world,
        )
        for name, link in {"torso": -1, **parts}.items():
            colour = next(colour for word, colour in COLOURS.items() if word in name)
            self._bullet.changeVisualShape(self._robot, link, rgbaColor=colour, **world)
        self._links = list(range(count))
        self._torso = parts.get("torso", -1)
        self._parts = count + 1 + (self._torso < 0)  # the floor is one of them
        self._feet = [parts[foot] for foot in self.body.feet]
        self._shins = [i for i, foot in enumerate(self.body.feet) if "foot" not in foot]
        self._joints = [info[0] for info in free]
        self._ranges = [(info[8], info[9] - info[8]) for info in free]
        strengths = [self.body.power * self.body.strength.get(name, 100.0) for name in names]
        self._gains = np.array(strengths, dtype=self.body.gains)
        self._positions = slice(8, 8 + 2 * len(free), 2)
        self._speeds = slice(9, 9 + 2 * len(free), 2)

    def reset(self, *, seed: int | None = None, options: dict | None = None):
        """Start an episode, with the joints a little away from their rest position."""
        super().reset(seed=seed)
        world = {"physicsClientId": self._client}
        if self._exploded:
            self._build()
        else:
            self._forget_contacts()
            self._bullet.restoreState(self._start, **world)
        positions = self.np_random.uniform(-self._noise, self._noise, len(self._joints))
        for joint, position in zip(self._joints, positions.tolist(), strict=True):
            self._bullet.resetJointState(self._robot, joint, position, 0.0, **world)
        self._contacts = [0.0] * len(self._feet)
        self._touching = 0.0
        self._height = self.body.start_height
        self._observation = self._observe()
        self._distance = self._to_target
        self._steps, self._picture = 0, None
        self._show()
        return self._observation.clip(*self._seen), {}

    def _forget_contacts(self) -> None:
        """Clear contact points, by lifting the robot high above the floor.

        Restoring a state keeps the contact points of the last episode, which changes the last
        digits of one episode in hundreds.
        """
        world = {"physicsClientId": self._client}
        self._bullet.resetBasePositionAndOrientation(
            self._robot, (0.0, 0.0, ALOFT), (0.0, 0.0, 0.0, 1.0), **world
        )
        self._bullet.performCollisionDetection(**world)

    def step(self, action: np.ndarray):
        """Simulate one step. Raises BotschoolError if a number in the action is not finite."""
        action = np.asarray(action)
        torques = (self._gains * action.clip(*self._full)).tolist()
        if not math.isfinite(sum(torques)):
            raise BotschoolError(f"{action.tolist()} is not an action: it holds NaN.")
        world, robot = self._client, self._robot
        self._bullet.setJointMotorControlArray(
            robot, self._joints, self._bullet.TORQUE_CONTROL, forces=torques, physicsClientId=world
        )
        self._bullet.stepSimulation(physicsClientId=world)
        self._steps += 1
        observation = self._observe()
        if self._exploded:
            return self._observation.clip(*self._seen), 0.0, True, False, {"exploded": True}
        self._observation = observation
        observed = observation.clip(*self._seen)
        alive = self.body.alive(float(observed[0]) + self._height, self._pitch, self._contacts)
        measured = self._measure(action, alive, observation)
        self._touching = max([self._contacts[i] for i in self._shins], default=0.0)
        touching = self._bullet.getContactPoints(robot, self._floor, physicsClientId=world)
        links = {contact[3] for contact in touching}
        self._contacts = [1.0 if foot in links else 0.0 for foot in self._feet]
        info = {"v0": self._standard(measured), "v5": self.body.evolved(measured)}
        reward = math.fsum(info["v5" if self.version == 5 else "v0"].values())
        self._show()
        return observed, reward, alive < 0 and self._ends, False, info

    def _observe(self) -> np.ndarray:
        """Return the observation before clipping, and detect an explosion."""
        query, world, robot = self._bullet, self._client, self._robot
        torso = self._torso
        links = query.getLinkStates(
            robot, self._links, computeLinkVelocity=torso >= 0, physicsClientId=world
        )
        xs, ys, _ = zip(*[link[0] for link in links], strict=True)
        x, y = sum(xs), sum(ys)
        if torso >= 0:
            link = links[torso]
            place, turn, velocity = link[0], link[1], link[6]
        else:
            place, turn = query.getBasePositionAndOrientation(robot, physicsClientId=world)
            velocity, _ = query.getBaseVelocity(robot, physicsClientId=world)
            x, y = x + place[0], y + place[1]
        x, y, z = x / self._parts, y / self._parts, place[2]
        if self._height is None:
            self._height = z
        roll, pitch, yaw = query.getEulerFromQuaternion(turn)
        self._to_target = math.hypot(TARGET - x, y)
        self._heading = math.atan2(-y, TARGET - x) - yaw
        self._place, self._pitch = place, pitch
        cosine, sine = math.cos(yaw), math.sin(yaw)
        values = [
            z - self._height,
            math.sin(self._heading),
            math.cos(self._heading),
            0.3 * (cosine * velocity[0] + sine * velocity[1]),
            0.3 * (cosine * velocity[1] - sine * velocity[0]),
            0.3 * velocity[2],
            roll,
            pitch,
        ]
        joints = query.getJointStates(robot, self._joints, physicsClientId=world)
        for joint, (low, span) in zip(joints, self._ranges, strict=True):
            values.append(2.0 * (joint[0] - low) / span - 1.0)
            values.append(0.1 * joint[1])
        values += self._contacts
        observation = np.array(values, dtype=np.float32)
        self._exploded = not abs(sum(values)) < UNREAL or z < BELOW_GROUND
        return observation

    def _measure(self, action: np.ndarray, alive: float, observation: np.ndarray) -> Measured:
        progress = (self._distance - self._to_target) / STEP
        self._distance = self._to_target
        positions, n = observation[self._positions], len(self._joints)
        return Measured(
            progress,
            alive,
            float(np.add.reduce(np.abs(action * observation[self._speeds])) / n),
            float(np.add.reduce(action * action) / n),
            sum([abs(position) > AT_LIMIT for position in positions.tolist()]),
            positions,
            self._heading,
        )

    def _standard(self, step: Measured) -> dict[str, float]:
        """Return the reward of version 0."""
        return {
            "progress": step.progress,
            "alive": step.alive,
            "electricity": -self.body.electricity * (2.0 * step.work + 0.1 * step.effort),
            "joints_at_limit": -0.1 * step.at_limit,
        }

    def measured(self) -> dict[str, Any]:
        """Return measurements after the last step: metres to the target; height (m), angles (rad).

        "positions" and "speeds" are the joints', as observed but without limits. "touching" is 1.0
        if a part of a HalfCheetah other than its feet was on the floor after the step before the
        last one; its alive bonus depends on this.
        """
        return {
            "distance": self._to_target,
            "height": self._place[2],
            "pitch": self._pitch,
            "heading": self._heading,
            "touching": self._touching,
            "positions": self._observation[self._positions],
            "speeds": self._observation[self._speeds],
        }

    def render(self) -> np.ndarray | None:
        """Return a picture, (300, 400, 3) uint8, new at every second step, with 'rgb_array'."""
        if self.render_mode != "rgb_array":
            return None
        if self._picture is None or self._steps >= self._drawn + STEPS_OF_PICTURE:
            self._picture = bullet.picture(self._client, self._place, 3.0, 20.0)
            self._drawn = self._steps
        return self._picture

    def _show(self) -> None:
        """Keep the window's camera on the robot, and the window in real time."""
        if self.render_mode != "human":
            return
        self._bullet.resetDebugVisualizerCamera(
            3.0, 20.0, -20.0, self._place, physicsClientId=self._client
        )
        time.sleep(max(self._next_frame - time.monotonic(), 0.0))
        self._next_frame = time.monotonic() + STEP

    def close(self) -> None:
        """End the physics world."""
        self._end()
