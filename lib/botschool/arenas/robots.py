"""Describe the kinds of wheeled robots, and choose the robots of a task.

Their table is in lib/arena/robots/plan.hpp (docs/specification.md, "Wheeled robots").
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from botschool import _core
from botschool.errors import BotschoolError
from botschool.inifile import nearest


@dataclass(frozen=True)
class RobotModel:
    """Properties of a kind of robot; lengths in mm."""

    name: str
    radius: float
    axle: float
    """Distance between the wheels."""
    speed: float
    """Speed of a wheel at an action of 1, in mm/s."""
    directions: tuple[float, ...]
    """Directions of the infrared sensors, degrees counter-clockwise from the heading."""
    range: float
    """Range of the infrared sensors from the robot's edge."""


MODELS: dict[str, RobotModel] = {
    model["name"]: RobotModel(**(model | {"directions": tuple(model["directions"])}))
    for model in _core.robot_models()
}


def find(name: str) -> RobotModel:
    """Return the model with this name, in any case. Raises BotschoolError."""
    for known, model in MODELS.items():
        if known.lower() == name.lower():
            return model
    near = nearest(name, MODELS)
    raise BotschoolError(f"There is no robot '{name}': {near}{'' if near.endswith('?') else '.'}")


def cast(problem: str, plan: dict, names: Sequence[str] = ()) -> tuple[RobotModel, ...]:
    """Return the robots of a task: its own, or others by their names (one for all, or one each).

    plan: as in `_core.native_problems()`. A task may drive its own robots at another speed than
    the model's. Raises BotschoolError.
    """
    roles = plan["roles"]
    if len(names) not in (0, 1, len(roles)):
        raise BotschoolError(
            f"{problem} has {len(roles)} robots: name one kind for all, or {len(roles)}, "
            f"not {len(names)}."
        )
    chosen = list(names) * (len(roles) if len(names) == 1 else 1)
    models = []
    for role, name in zip(roles, chosen or [role["model"] for role in roles], strict=True):
        model = find(name)
        own = model.name == role["model"] and role["speed"] > 0
        models.append(replace(model, speed=role["speed"]) if own else model)
    return tuple(models)
