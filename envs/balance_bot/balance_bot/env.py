"""The balancing robot: two motorised wheels on one axis, and a body that must stay upright."""

from __future__ import annotations

import time
from typing import ClassVar

import gymnasium
import numpy as np

from balance_bot.world import PLANE, connect, picture, pybullet, robot_file

FASTEST = 24.6
"""rad/s: what the motors can do, 235 turns a minute."""
TIME_STEP = 0.01
"""Seconds."""
LOWEST = 0.15
"""Metres: with the centre of its body below, the robot has fallen."""


class BalanceBotEnv(gymnasium.Env):
    """A robot on two wheels, which falls over unless its wheels keep rolling under its body.

    Observation, float32, shape (3,): inclination of the body (rad, 0 is upright), its angular
    velocity around the wheels' axis (rad/s), target speed of the wheels (rad/s).
    Action, shape (1,): what is added to the target speed (rad/s), between -1 and 1; the target
    stays between -24.6 and 24.6. A positive speed drives towards +y, a positive inclination leans
    towards -y.
    Reward of a step: 1 - 0.05 * |target speed|.
    Start: at rest, inclination uniform in [-0.3, 0.3].
    End: terminated when the centre of the body is lower than 0.15 m; truncated after 500 steps
    (by gymnasium.make). A step takes 0.01 s.
    """

    metadata: ClassVar[dict] = {"render_modes": ["human", "rgb_array"], "render_fps": 100}

    def __init__(self, render_mode: str | None = None) -> None:
        """render_mode: "human" (PyBullet's window), "rgb_array" (pictures) or None."""
        self.render_mode = render_mode
        self.client = connect(render_mode)
        self.robot = None
        self.speed = 0.0
        limits = np.array([np.pi, np.inf, FASTEST], dtype=np.float32)
        self.observation_space = gymnasium.spaces.Box(-limits, limits)
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, shape=(1,))

    def observe(self) -> np.ndarray:
        """Inclination (rad), angular velocity (rad/s) and target speed of the wheels (rad/s)."""
        _, orientation = pybullet.getBasePositionAndOrientation(self.robot, self.client)
        inclination, _, _ = pybullet.getEulerFromQuaternion(orientation)
        _, turning = pybullet.getBaseVelocity(self.robot, self.client)
        return np.array([inclination, turning[0], self.speed], dtype=np.float32)

    def reset(self, *, seed: int | None = None, options: dict | None = None) -> tuple:
        """The robot at rest, inclined at random; options are not used."""
        super().reset(seed=seed)
        inclination = self.np_random.uniform(-0.3, 0.3)
        pybullet.resetSimulation(physicsClientId=self.client)
        pybullet.setGravity(0, 0, -10, physicsClientId=self.client)
        pybullet.setTimeStep(TIME_STEP, physicsClientId=self.client)
        pybullet.loadURDF(PLANE, physicsClientId=self.client)
        self.robot = pybullet.loadURDF(
            str(robot_file("balance_bot.urdf")),
            [0, 0, 0.001],
            pybullet.getQuaternionFromEuler([inclination, 0, 0]),
            flags=pybullet.URDF_USE_INERTIA_FROM_FILE,
            physicsClientId=self.client,
        )
        self.speed = 0.0
        return self.observe(), {}

    def drive(self, action: np.ndarray) -> None:
        """Changes the target speed of the wheels by the action, and hands it to both motors."""
        change = np.clip(float(action[0]), -1.0, 1.0)
        self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
        for wheel, target in ((0, self.speed), (1, -self.speed)):
            pybullet.setJointMotorControl2(
                self.robot,
                wheel,
                pybullet.VELOCITY_CONTROL,
                targetVelocity=target,
                physicsClientId=self.client,
            )

    def reward(self) -> float:
        """1 for a step, less 0.05 for each rad/s of target speed."""
        return 1.0 - 0.05 * abs(self.speed)

    def fallen(self) -> bool:
        """Whether the centre of the body is lower than 0.15 m."""
        position, _ = pybullet.getBasePositionAndOrientation(self.robot, self.client)
        return position[2] < LOWEST

    def step(self, action: np.ndarray) -> tuple:
        """One hundredth of a second: observation, reward, terminated, truncated, info."""
        self.drive(action)
        pybullet.stepSimulation(self.client)
        if self.render_mode == "human":
            self.render()
        return self.observe(), self.reward(), self.fallen(), False, {}

    def render(self) -> np.ndarray | None:
        """The picture, uint8 of shape (360, 480, 3); in a window, waits for the next one."""
        if self.render_mode == "rgb_array":
            return picture(self.client, self.robot)
        if self.render_mode == "human":
            time.sleep(TIME_STEP)
        return None

    def close(self) -> None:
        """Ends the physics client, and closes its window."""
        if self.client is not None:
            pybullet.disconnect(self.client)
            self.client = None
