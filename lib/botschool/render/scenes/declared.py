"""Draw ErArena: any declared arena."""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np

from botschool.arenas.plan import Plan
from botschool.arenas.robots import RobotModel
from botschool.render.scene import draws
from botschool.render.scenes.arenas import CAMERA_SECTORS, ArenaScene, Look, infrared_numbers
from botschool.render.shapes import rectangle, ring

COLOURS = ("blue", "orange", "short pole", "object")
SECTORS = 8
CELLS = 8
"""Cells along a side, for the reward of exploring."""


@draws("ErArena")
class DeclaredScene(ArenaScene):
    """The arena from above: zones, explored cells, walls, lights, cylinders, and robots with their
    sensors' readings. Rewarded objects are drawn stronger while they pay.
    """

    trail = 120

    def __init__(self, robots: tuple[RobotModel, ...], plan: Plan | None = None) -> None:
        self.plan = plan = plan or Plan()
        self.side, self.tall = plan.width, plan.height
        self.scale_bar = 10.0 ** np.floor(np.log10(plan.width / 2))
        self.state_size = plan.firsts["visited"] + 3
        names = [f"robot {n}" if len(robots) > 1 else "robot" for n in range(1, len(robots) + 1)]
        self.looks = tuple(
            Look(name, colour, plan.core.observations)
            for name, colour in zip(names, COLOURS, strict=False)
        )
        self.robots = tuple(names) if len(robots) > 1 else ("",)
        super().__init__(robots)

    def _add_ground(self) -> None:
        self._cells = []
        if self.plan.reward == "explore":
            width, height = self.side / CELLS, self.tall / CELLS
            for cell in range(CELLS * CELLS):
                x, y = (cell % CELLS) * width, (cell // CELLS) * height
                self._cells.append(self.value())
                corners = rectangle(x, y, x + width, y + height)
                self.add("polygon", corners, "goal", opacity=0.16, level=self._cells[-1])

    def _add_objects(self, poses: list[int]) -> None:
        plan, longer = self.plan, max(self.side, self.tall)
        self._rewarded = self.value()
        self._places = {}
        near = {"near-cylinder": "cylinder", "near-light": "light"}.get(plan.reward)
        for kind in ("zone", "light", "cylinder"):
            things = getattr(plan, f"{kind}s")
            self._places[kind] = [self.pose() for _ in things]
            for thing, pose in zip(things, self._places[kind], strict=True):
                zone = kind == "zone"
                if zone:
                    shade = 0.15 + 0.55 * thing.shade
                    self._disc("shade", thing.radius, pose, shade)
                if (zone and "zone" in plan.reward) or kind == near:
                    most = thing.radius
                    if not zone:
                        most += plan.distance + max(model.radius for model in self.models)
                    self._disc("goal", most, pose, 0.08)
                    self._disc("goal", most, pose, 0.2, level=self._rewarded)
        for wall in plan.walls:
            ends = [(wall.x, wall.y), (wall.x2, wall.y2)]
            self.add("line", ends, "wall", radius=0.008 * longer)
        for cylinder, pose in zip(plan.cylinders, self._places["cylinder"], strict=True):
            self._disc("object", cylinder.radius, pose)
        for pose in self._places["light"]:
            for share, opacity in ((0.05, 0.15), (0.035, 0.25), (0.018, 1.0)):
                self._disc("light", share * longer, pose, opacity)

    def _disc(self, colour: str, radius: float, pose: int, opacity=1.0, level=None) -> None:
        self.add(
            "disc", [(0.0, 0.0)], colour, radius=radius, pose=pose, opacity=opacity, level=level
        )

    def _objects(self, state: np.ndarray, reward: float) -> list[float]:
        """Return the numbers in the order of `_add_ground` and `_add_objects`."""
        where = self.plan.spots(state)
        numbers = [float(reward)]
        for kind in self._places:
            for x, y in where[kind]:
                numbers += [float(x), float(y), 0.0]
        return numbers

    def _numbers(self, state, action, observation, reward) -> list[float]:
        first = self.plan.firsts["visited"]
        low, high = (int(np.clip(half, 0, 2**32 - 1)) for half in state[first : first + 2])
        visited = low | high << 32
        cells = [float(visited >> cell & 1) for cell in range(len(self._cells))]
        return cells + super()._numbers(state, action, observation, reward)

    def _add_sensors(self, look: Look, model: RobotModel, pose: int) -> None:
        radius = model.radius
        for sensor in self.plan.sensors:
            if sensor == "infrared":
                self._add_infrared(model, pose)
            elif sensor == "camera":
                self._add_camera(pose, 1.55 * radius, 1.8 * radius, "camera")
            elif sensor == "cylinders":
                self._add_camera(pose, 1.85 * radius, 2.1 * radius, "object")
            elif sensor == "light":
                self._add_light(radius, pose)
            elif sensor == "laser":
                self._add_laser(radius, pose)
            elif sensor == "ground":
                for angle in (-0.0872, 0.0872, pi - 0.0872, pi + 0.0872):
                    spot = (0.9 * radius * cos(angle), 0.9 * radius * sin(angle))
                    self.add(
                        "disc", [spot], "ink", radius=0.08 * radius, pose=pose, level=self.value()
                    )

    def _add_light(self, radius: float, pose: int) -> None:
        width, inner, outer = 2 * pi / SECTORS, 1.1 * radius, 1.4 * radius
        for sector in range(SECTORS):
            piece = ring((sector - 0.45) * width, (sector + 0.45) * width, inner, outer)
            self.add("polygon", piece, "muted", pose=pose, opacity=0.12)
            self.add("polygon", piece, "light", pose=pose, level=self.value())

    def _add_laser(self, radius: float, pose: int) -> None:
        for direction in self.plan.beams:
            ahead = (cos(direction), sin(direction))
            edge = (radius * ahead[0], radius * ahead[1])
            length, hit = self.value(), self.value()
            self.add(
                "line", [(0.0, 0.0), ahead], "infrared",
                radius=0.02 * radius, at=edge, pose=pose, size=length, opacity=0.45,
            )  # fmt: skip
            self.add(
                "disc", [ahead], "infrared",
                radius=0.12 * radius, at=edge, pose=pose, size=length, level=hit,
            )  # fmt: skip

    def _sensed(self, look: Look, model: RobotModel, readings: np.ndarray) -> list[float]:
        numbers, first = [], 0
        for sensor, size in self.plan.sizes:
            values = readings[first : first + size]
            first += size
            if sensor == "infrared":
                numbers += infrared_numbers(model, values)
            elif sensor in ("camera", "cylinders"):
                numbers += list(values[:CAMERA_SECTORS])
            elif sensor == "light":
                numbers += list(np.sqrt(values))
            elif sensor == "laser":
                for value in values:
                    numbers += [self.plan.laser_range * (1 - value), float(value > 0)]
            elif sensor == "ground":
                numbers += list(values)
        return numbers
