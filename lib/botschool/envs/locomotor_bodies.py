"""Define what distinguishes the five locomotors, and the rewards of version 5."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np


@dataclass(slots=True)
class Measured:
    """Quantities of one step from which rewards are computed."""

    progress: float
    """Metres gained towards the target, divided by the step's 0.0165 s."""
    alive: float
    """The alive bonus: above 0, or -1 once the robot has fallen."""
    work: float
    """Mean |action * joint speed|; speeds as in the observation, a tenth of radians per second."""
    effort: float
    """Mean squared action."""
    at_limit: int
    """Joints at their limit."""
    positions: np.ndarray
    """float32, (joints,): joint positions, -1 and 1 at their limits."""
    heading: float
    """Angle to the target in radians, 0 when the robot faces it."""


Alive = Callable[[float, float, list[float]], float]
Components = Callable[[Measured], dict[str, float]]


def _stands(height: float, pitch: float, contacts: list[float]) -> float:
    return 1.0 if height > 0.8 and abs(pitch) < 1.0 else -1.0


def _on_feet_alone(height: float, pitch: float, contacts: list[float]) -> float:
    _, front_shin, front_thigh, _, back_shin, back_thigh = contacts
    fallen = front_shin or front_thigh or back_shin or back_thigh or not abs(pitch) < 1.0
    return -1.0 if fallen else 1.0


def _torso_up(height: float, pitch: float, contacts: list[float]) -> float:
    return 1.0 if height > 0.26 else -1.0


def _humanoid_stands(height: float, pitch: float, contacts: list[float]) -> float:
    return 2.0 if height > 0.78 else -1.0


def _progress(step: Measured) -> dict[str, float]:
    return {"progress": step.progress}


def _progress_within_limits(step: Measured) -> dict[str, float]:
    return {"progress": step.progress, "joints_at_limit": -0.1 * step.at_limit}


def _ant(step: Measured) -> dict[str, float]:
    return {
        "progress": step.progress,
        "alive": 0.01,
        "effort": -0.01 * step.effort,
        "joints_at_limit": -0.1 * step.at_limit,
    }


def _humanoid(step: Measured) -> dict[str, float]:
    beyond = np.maximum(np.abs(step.positions) - 1.0, 0.0)
    return {
        "progress": step.progress,
        "alive": 1.0,
        "joints_at_limit": -0.1 * step.at_limit,
        "beyond_limits": -10.0 * float(beyond.sum()),
        "heading": -0.1 * step.heading**2,
    }


@dataclass(frozen=True)
class LocomotorBody:
    """Properties that distinguish one robot from the others."""

    model: str
    """Its model file, which comes with PyBullet."""
    feet: tuple[str, ...]
    """Parts whose contact with the floor is observed."""
    alive: Alive
    """(height, pitch, contacts of the step before) -> alive bonus."""
    evolved: Components
    """The reward of version 5."""
    power: float
    strength: dict[str, float] = field(default_factory=dict)
    """Joint -> its strength, if it is not 100; full torque is power * strength."""
    electricity: float = 1.0
    """Cost of electricity, relative to the other robots."""
    evolved_noise: float = 0.1
    """Version 5 starts with joints at most this far (radians) from their rest position."""
    start_height: float | None = None
    """Height in metres that is observed as 0; None: the height at the episode's start."""
    gains: type = np.float64
    """Precision of the torques."""


_HUMANOID_STRENGTH = {
    **{
        f"{side}_{joint}": 75.0
        for side in ("right", "left")
        for joint in ("shoulder1", "shoulder2")
    },
    **{f"{side}_elbow": 75.0 for side in ("right", "left")},
    **{f"{side}_hip_y": 300.0 for side in ("right", "left")},
    **{f"{side}_knee": 200.0 for side in ("right", "left")},
}

BODIES = {
    "Hopper": LocomotorBody("hopper", ("foot",), _stands, _progress, 0.75),
    "HalfCheetah": LocomotorBody(
        "half_cheetah",
        ("ffoot", "fshin", "fthigh", "bfoot", "bshin", "bthigh"),
        _on_feet_alone,
        _progress_within_limits,
        0.9,
        {"bthigh": 120, "bshin": 90, "bfoot": 60, "fthigh": 140, "fshin": 60, "ffoot": 30},
    ),
    "Ant": LocomotorBody(
        "ant",
        ("front_left_foot", "front_right_foot", "left_back_foot", "right_back_foot"),
        _torso_up,
        _ant,
        2.5,
    ),
    "Walker2D": LocomotorBody(
        "walker2d",
        ("foot", "foot_left"),
        _stands,
        _progress,
        0.4,
        {"foot_joint": 30, "foot_left_joint": 30},
    ),
    "Humanoid": LocomotorBody(
        "humanoid_symmetric",
        ("right_foot", "left_foot"),
        _humanoid_stands,
        _humanoid,
        0.41,
        _HUMANOID_STRENGTH,
        electricity=4.25,
        evolved_noise=0.03,
        start_height=0.8,
        gains=np.float32,
    ),
}
