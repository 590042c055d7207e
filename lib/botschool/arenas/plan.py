"""Declare an arena: robots, walls, cylinders, lights, zones, sensors and a reward by name.

    Plan(robots=[Robot("e-puck", x=(100, 300), y=200)], lights=[Light(x=350)],
         sensors=["infrared", "light"], reward="near-light")

is the same as the section [ARENA] of an experiment file with `environment = ErArena`:

    robot1  = e-puck, x 100 to 300, y 200
    light1  = x 350
    sensors = infrared, light
    reward  = near-light

Lengths are in mm, angles in degrees, counter-clockwise from the x axis. A position or a heading is
a number or a range (low, high) from which every episode draws; if it is left out, it can be
anywhere. You may also give objects as texts, as in a file. docs/specification.md, "Declared
arenas".
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np

from botschool import _core
from botschool.arenas.robots import RobotModel
from botschool.arenas.section import WORDS, ArenaConfig, Scalars, reader, sensors_of
from botschool.arenas.things import (
    KINDS,
    Cylinder,
    Light,
    Range,
    Robot,
    Thing,
    Wall,
    Zone,
    is_number,
)
from botschool.errors import BotschoolError
from botschool.inifile import nearest, shown

__all__ = ["ArenaConfig", "Cylinder", "Light", "Plan", "PlanError", "Robot", "Wall", "Zone"]

PROBLEM = "ErArena"
TRIED = 100
"""Episodes whose starts are tried before a plan is accepted."""


class PlanError(BotschoolError):
    """An error in a plan; `key` is the line of the file that causes it, such as robot1."""

    def __init__(self, key: str, sentence: str) -> None:
        super().__init__(sentence if sentence.endswith("?") else f"{sentence}.")
        self.key = key


NEEDS = {
    "near-cylinder": "cylinder", "near-light": "light", "on-zone": "zone", "same-zone": "zone",
    "every-zone": "zone", "cylinders": "cylinder", "light": "light", "ground": "zone",
}  # fmt: skip
"""Objects that a reward or a sensor needs in the arena."""
TEAM = ("same-zone", "every-zone", "together", "camera")
"""Rewards and sensors for two robots or more."""


@dataclass(frozen=True)
class Plan:
    """A declared arena, checked; see the top of this module. Raises BotschoolError.

    Without robots there is one Khepera. The other fields are the keys of the section [ARENA].
    """

    width: float = 400.0
    height: float = 400.0
    robots: tuple[Robot, ...] = ()
    walls: tuple[Wall, ...] = ()
    cylinders: tuple[Cylinder, ...] = ()
    lights: tuple[Light, ...] = ()
    zones: tuple[Zone, ...] = ()
    sensors: tuple[str, ...] = ("infrared",)
    reward: str = "avoid"
    distance: float = 60.0
    collisions: str = "block"
    noise: float = 0.0
    steps: int = 1000
    light_distance: float = 200.0
    laser_beams: int = 8
    laser_angle: float = 360.0
    laser_range: float = 500.0

    @classmethod
    def of(cls, config: ArenaConfig) -> Plan:
        """Return the plan that a section [ARENA] describes. Raises PlanError."""
        values = {f.name: getattr(config, f.name) for f in fields(Scalars)}
        for kind in KINDS:
            given = [getattr(config, f"{kind}{n}") for n in range(1, WORDS[f"{kind}s"] + 1)]
            count = max((n for n, text in enumerate(given, 1) if text), default=0)
            for n, text in enumerate(given[:count], 1):
                if not text:
                    raise PlanError(
                        f"{kind}{count}", f"there is a {kind}{count}, but no {kind}{n}: number them"
                    )
            if count:
                values[f"{kind}s"] = tuple(given[:count])
        return cls(**values)

    def __post_init__(self) -> None:
        for kind, cls in KINDS.items():
            given = getattr(self, f"{kind}s")
            given = (given,) if isinstance(given, (str, Thing)) else tuple(given)
            most = WORDS[f"{kind}s"]
            if len(given) > most:
                raise PlanError(f"{kind}{most + 1}", f"an arena has at most {most} {kind}s")
            made = []
            for number, thing in enumerate(given, 1):
                try:
                    key = f"{kind}{number}"
                    made.append(thing if isinstance(thing, cls) else reader(key, cls)(thing))
                except ValueError as error:
                    raise PlanError(key, str(error)) from None
            object.__setattr__(self, f"{kind}s", tuple(made))
        if not self.robots:
            object.__setattr__(self, "robots", (Robot(),))
        self._check_scalars()
        self._check_needs()
        self._check_places()
        self._check_starts()

    def _check_scalars(self) -> None:
        for f in fields(Scalars):
            value, limits = getattr(self, f.name), f.metadata
            if f.name == "sensors":
                names = value if isinstance(value, str) else ",".join(map(str, value))
                try:
                    object.__setattr__(self, "sensors", sensors_of(names))
                except ValueError as error:
                    raise PlanError(f.name, str(error)) from None
            elif "choices" in limits:
                if value not in limits["choices"]:
                    near = nearest(str(value), limits["choices"])
                    raise PlanError(f.name, f"there is no {f.name} '{shown(value)}': {near}")
            elif (
                not is_number(value, 1e6)
                or (isinstance(f.default, int) and value != int(value))
                or value < limits.get("low", value)
                or value > limits["high"]
                or value <= limits.get("above", value - 1)
            ):
                least = f"above {limits['above']}" if "above" in limits else limits["low"]
                whole = "a whole number" if isinstance(f.default, int) else "a number"
                span = f"{whole}, {least} to {limits['high']:g}"
                raise PlanError(f.name, f"{f.name} is {span}, not {shown(value)}")
            else:
                kind: Any = type(f.default)
                object.__setattr__(self, f.name, kind(value))

    def _check_needs(self) -> None:
        for key, names in (("reward", (self.reward,)), ("sensors", self.sensors)):
            for name in names:
                said = f"the {'reward' if key == 'reward' else 'sensor'} {name}"
                kind = NEEDS.get(name)
                if kind and not getattr(self, f"{kind}s"):
                    raise PlanError(
                        key,
                        f"{said} needs a {kind}, but there is none: add {kind}1 = x 100, y 100",
                    )
                if name in TEAM and len(self.robots) < 2:
                    raise PlanError(
                        key, f"{said} is for two robots or more: add a line robot2 = Khepera"
                    )
        if self.reward == "every-zone" and len(self.zones) > len(self.robots):
            raise PlanError(
                "reward",
                f"the reward every-zone needs a robot for each zone, but there are "
                f"{len(self.zones)} zones and {len(self.robots)} robots",
            )

    def _check_places(self) -> None:
        """Check that ranges lie within the arena."""
        for kind in KINDS:
            for number, thing in enumerate(getattr(self, f"{kind}s"), 1):
                key = f"{kind}{number}"
                inset = thing.radius if kind in ("robot", "cylinder") else 0.0
                for name, side in (("x", self.width), ("y", self.height)):
                    self._check_inside(key, name, getattr(thing, name), inset, side)
                if kind == "wall":
                    self._check_inside(key, "x2", thing.x2, 0.0, self.width)
                    self._check_inside(key, "y2", thing.y2, 0.0, self.height)
                    if (thing.x, thing.y) == (thing.x2, thing.y2):
                        raise PlanError(key, f"{key} has no length: its two ends are the same")

    def _check_inside(self, key: str, name: str, value: Range, inset: float, side: float) -> None:
        if 2 * inset > side:
            raise PlanError(key, f"{key} is {2 * inset:g} mm wide and does not fit into the arena")
        low, high = _ends(value, inset, side - inset)
        if low < inset or high > side - inset:
            given = f"{low:g}" if low == high else f"{low:g} to {high:g}"
            raise PlanError(
                key,
                f"{key} stands outside the arena or inside its walls: {name} is {given}, but must "
                f"be {inset:g} to {side - inset:g}",
            )

    def _check_starts(self) -> None:
        """Check that nothing overlaps at the starts of some episodes."""
        stepper = _core.make_stepper(PROBLEM)
        options = _core.ArenaOptions(declaration=self.core)
        stepper.set(1, options)
        fixed = not any(
            isinstance(value, tuple) or value is None
            for things in (self.robots, self.cylinders, self.zones)
            for thing in things
            for value in (thing.x, thing.y)
        )
        for episode in range(1 if fixed else TRIED):
            stepper.start(0, episode)
            self._check_start(stepper.state)

    def _check_start(self, state: np.ndarray) -> None:
        spots = self.spots(state)
        round_things = [
            (f"{kind}{n}", thing, spot)
            for kind in ("cylinder", "robot")
            for n, (thing, spot) in enumerate(
                zip(getattr(self, f"{kind}s"), spots[kind], strict=True), 1
            )
        ]
        for i, (key, thing, (x, y)) in enumerate(round_things):
            for number, wall in enumerate(self.walls, 1):
                if _gap(wall, x, y) < thing.radius:
                    raise self._overlap(key, thing, x, y, f"wall{number}")
            for other, its, (x2, y2) in round_things[:i]:
                if math.hypot(x - x2, y - y2) < thing.radius + its.radius:
                    raise self._overlap(key, thing, x, y, other)

    def _overlap(self, key: str, thing: Any, x: float, y: float, other: str) -> PlanError:
        if isinstance(thing.x, float) and isinstance(thing.y, float):
            return PlanError(
                key,
                f"{key} stands inside {other}: at ({x:g}, {y:g}) its radius of {thing.radius:g} mm "
                "does not fit beside it, so move one of them",
            )
        return PlanError(
            key,
            f"there is not enough room for {key} beside {other}: widen its x and y, or take "
            "something away",
        )

    def __getstate__(self) -> dict:
        """Return the state to copy, without the C++ objects."""
        return {name: value for name, value in vars(self).items() if name != "core"}

    @property
    def models(self) -> tuple[RobotModel, ...]:
        """Return the model of each robot."""
        return tuple(robot.model for robot in self.robots)

    @cached_property
    def core(self) -> _core.Declaration:
        """Return the same plan as a C++ declaration."""
        return _core.Declaration(
            width=self.width,
            height=self.height,
            models=[robot.kind for robot in self.robots],
            robots=[
                [*self._spot(robot, robot.radius), *_ends(robot.heading, 0.0, 360.0), robot.speed]
                for robot in self.robots
            ],
            walls=[[wall.x, wall.y, wall.x2, wall.y2] for wall in self.walls],
            cylinders=[[*self._spot(c, c.radius), c.radius] for c in self.cylinders],
            lights=[self._spot(light, 0.0) for light in self.lights],
            zones=[[*self._spot(z, 0.0), z.radius, z.shade] for z in self.zones],
            sensors=list(self.sensors),
            noise=self.noise,
            half_light=self.light_distance,
            beams=self.laser_beams,
            field=self.laser_angle,
            reach=self.laser_range,
            reward=self.reward,
            distance=self.distance,
            bumps_end=self.collisions == "end",
        )

    def _spot(self, thing: Any, inset: float) -> list[float]:
        x = _ends(thing.x, inset, self.width - inset)
        return [*x, *_ends(thing.y, inset, self.height - inset)]

    @property
    def sizes(self) -> list[tuple[str, int]]:
        """Return each sensor and its number of values."""
        return [(name, self.core.size_of(name)) for name in self.sensors]

    @property
    def beams(self) -> list[float]:
        """Return the directions of the laser's beams in radians from the heading."""
        count, field = self.laser_beams, self.laser_angle
        if field >= 360 or count == 1:
            return [math.radians(field * beam / count) for beam in range(count)]
        return [math.radians(field * (beam / (count - 1) - 0.5)) for beam in range(count)]

    @property
    def firsts(self) -> dict[str, int]:
        """Return the indices in a state where robots, cylinders, lights and zones begin."""
        found, first = {}, 0
        for kind, values in _ROWS.items():
            found[kind] = first
            first += values * WORDS[f"{kind}s"]
        return found | {"visited": first}

    def spots(self, state: np.ndarray) -> dict[str, np.ndarray]:
        """Return the positions in a state of the arena: kind -> x, y of each object."""
        found = {}
        for kind, first in self.firsts.items():
            if kind in _ROWS:
                count = len(getattr(self, f"{kind}s"))
                rows = state[first : first + _ROWS[kind] * count].reshape(-1, _ROWS[kind])
                found[kind] = rows[:, :2]
        return found


_ROWS = {"robot": 3, "cylinder": 2, "light": 2, "zone": 2}
"""Numbers of an object in a state."""


def _ends(value: Range, low: float, high: float) -> tuple[float, float]:
    if value is None:
        return low, high
    return value if isinstance(value, tuple) else (value, value)


def _gap(wall: Wall, x: float, y: float) -> float:
    """Return the distance from a point to a wall."""
    ux, uy = wall.x2 - wall.x, wall.y2 - wall.y
    t = min(max(((x - wall.x) * ux + (y - wall.y) * uy) / (ux * ux + uy * uy), 0.0), 1.0)
    return math.hypot(x - wall.x - t * ux, y - wall.y - t * uy)
