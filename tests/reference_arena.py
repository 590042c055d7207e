"""Robots, walls and sensors, implemented a second time from docs/specification.md, "Wheeled
robots", for the tests: plain Python, one robot after another, with complex numbers for some angles.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass

PI = math.pi


@dataclass
class Response:
    """The response of an infrared sensor to a kind of object."""

    d0: float
    w: float
    m: float


@dataclass
class Body:
    """One kind of robot."""

    radius: float
    axle: float
    directions: list[float]
    gains: list[float]
    n: float
    range: float
    wall: Response
    round: Response


KHEPERA = Body(
    27.5, 53.0,
    [290.9, 318.1, 351.6, 15.7, 44.1, 74.1, 168.6, 193.9],
    [47.8, 43.2, 32.2, 20.3, 51.7, 97.6, 36.3, 105.5],
    1.0, 45.0, Response(5.24, 0.487, 2.0), Response(4.23, 0.308, 2.0),
)  # fmt: skip
MARXBOT = Body(
    85.0, 104.0,
    [202.5, 247.5, 292.5, 337.5, 22.5, 67.5, 112.5, 157.5],
    [0.935] * 8,
    1.5, 105.0, Response(40.0, 1.258, 22.2), Response(39.2, 0.583, 2.6),
)  # fmt: skip


def off(angle: float, other: float) -> float:
    """Return the size of the angle between two directions, 0 to pi."""
    return abs(cmath.phase(cmath.rect(1.0, angle - other)))


def arc(x: float, y: float, heading: float, left: float, right: float, axle: float):
    """Return the pose after the wheels have rolled that far: a turn about a centre beside the
    robot.
    """
    turn = (right - left) / axle
    if abs(turn) < 1e-7:
        way = cmath.rect((left + right) / 2, heading + turn / 2)
        return x + way.real, y + way.imag, heading + turn
    radius = axle / 2 * (left + right) / (right - left)  # the centre is to the left
    spoke = cmath.rect(radius, heading - PI / 2)
    moved = spoke * (cmath.exp(1j * turn) - 1)
    return x + moved.real, y + moved.imag, heading + turn


def nearest_point(wall, x: float, y: float) -> tuple[float, float]:
    """Return the point of a wall (x, y, x2, y2) that is nearest to (x, y)."""
    start, end, point = complex(*wall[:2]), complex(*wall[2:4]), complex(x, y)
    along = (point - start) / (end - start)  # in units of the wall
    nearest = start + (end - start) * min(max(along.real, 0.0), 1.0)
    return nearest.real, nearest.imag


def crosses(wall, x: float, y: float, x2: float, y2: float) -> bool:
    """Return whether the way from (x, y) to (x2, y2) crosses a wall."""
    start, end = complex(*wall[:2]), complex(*wall[2:4])
    before, after = ((complex(*p) - start) / (end - start) for p in ((x, y), (x2, y2)))
    if before.imag * after.imag >= 0:
        return False
    share = before.imag / (before.imag - after.imag)
    return 0 < before.real + share * (after.real - before.real) < 1


class World:
    """Robots, walls and cylinders; `drive` moves a robot."""

    def __init__(self, bodies, speeds, poses, walls, cylinders) -> None:
        self.bodies, self.speeds = bodies, speeds
        self.poses = [tuple(map(float, pose)) for pose in poses]
        self.walls = [tuple(map(float, wall)) for wall in walls]
        self.cylinders = [tuple(map(float, c)) for c in cylinders]  # x, y, radius

    def drive(self, robot: int, left: float, right: float) -> str:
        """Move a robot for a step unless it would collide; return what it would hit, or ""."""
        reach = self.speeds[robot] * 0.1
        x, y, heading = arc(
            *self.poses[robot], left * reach, right * reach, self.bodies[robot].axle
        )
        what = self.bump(robot, x, y)
        if not what:
            self.poses[robot] = (x, y, heading % (2 * PI))
        return what

    def bump(self, robot: int, x: float, y: float) -> str:
        """Return the obstacle at (x, y)."""
        own = self.bodies[robot].radius
        before = self.poses[robot]
        for wall in self.walls:
            px, py = nearest_point(wall, x, y)
            if math.hypot(px - x, py - y) < own or crosses(wall, *before[:2], x, y):
                return "wall"
        for cx, cy, radius in self.cylinders:
            if math.hypot(cx - x, cy - y) < own + radius:
                return "cylinder"
        for other, (ox, oy, _) in enumerate(self.poses):
            if other != robot and math.hypot(ox - x, oy - y) < own + self.bodies[other].radius:
                return "robot"
        return ""

    def infrared(self, robot: int) -> list[float]:
        """Return eight readings."""
        body, (x, y, heading) = self.bodies[robot], self.poses[robot]
        seen = [(*nearest_point(wall, x, y), 0.0, body.wall) for wall in self.walls]
        seen += [(*cylinder, body.round) for cylinder in self.cylinders]
        for other, (ox, oy, _) in enumerate(self.poses):
            if other != robot:
                seen.append((ox, oy, self.bodies[other].radius, body.round))
        totals = [0.0] * 8
        for ox, oy, radius, response in seen:
            d = max(math.hypot(ox - x, oy - y) - body.radius - radius, 0.0)
            if d > body.range:
                continue
            direction = math.atan2(oy - y, ox - x) - heading
            for sensor in range(8):
                delta = off(direction, math.radians(body.directions[sensor]))
                totals[sensor] += (
                    body.gains[sensor]
                    * math.exp(-((d / response.d0) ** body.n))
                    * math.exp(-((delta / response.w) ** response.m))
                )
        return [min(total, 1.0) for total in totals]

    def camera(self, robot: int) -> list[float]:
        """Return eight sectors in which one robot of two sees the other, and its apparent size."""
        (x, y, heading), (ox, oy, _) = self.poses[robot], self.poses[1 - robot]
        direction = math.atan2(oy - y, ox - x) - heading
        sector = PI / 4
        sectors = [max(0.0, 1 - off(direction, (s + 0.5) * sector) / sector) for s in range(8)]
        distance, radius = math.hypot(ox - x, oy - y), self.bodies[1 - robot].radius
        return [*sectors, 2 * (PI / 2 - math.atan(distance / radius))]

    def ground(self, robot: int, width: float, height: float) -> list[float]:
        """Return four sensors, then their mean."""
        x, y, heading = self.poses[robot]
        readings = []
        for angle in (-0.0872, 0.0872, PI - 0.0872, PI + 0.0872):
            spot = complex(x, y) + cmath.rect(0.9 * self.bodies[robot].radius, heading + angle)
            half = abs(complex(width, height)) / 2
            readings.append(abs(spot - complex(width, height) / 2) / half)
        mean = math.fsum(readings) / 4
        return [*(0.5 + 10 * (r - mean) for r in readings), mean]


# --- Sensors and rewards of declared arenas, implemented a second time from docs/specification.md,
# "Declared arenas", for the tests: plain Python, positions as complex numbers.


def _place(pose) -> complex:
    return complex(pose[0], pose[1])


class Declared:
    """A plan at a moment: a reference_arena.World, and what that does not contain."""

    def __init__(self, world, plan, lights, zones) -> None:
        self.world, self.plan = world, plan
        self.lights = [complex(*light) for light in lights]
        self.zones = [
            (complex(*place), zone.radius, zone.shade)
            for place, zone in zip(zones, plan.zones, strict=True)
        ]

    def rounds(self, robot: int):
        """Return centre and radius of the cylinders and of the other robots."""
        for x, y, radius in self.world.cylinders:
            yield complex(x, y), radius
        for other, pose in enumerate(self.world.poses):
            if other != robot:
                yield _place(pose), self.world.bodies[other].radius

    def laser(self, robot: int) -> list[float]:
        """Return the readings, computed in the frame of each beam, which runs along the positive
        real axis.
        """
        plan, pose = self.plan, self.world.poses[robot]
        count, edge = plan.laser_beams, self.world.bodies[robot].radius
        readings = []
        for beam in range(count):
            if plan.laser_angle == 360 or count == 1:
                degrees = plan.laser_angle / count * beam
            else:
                degrees = -plan.laser_angle / 2 + plan.laser_angle / (count - 1) * beam
            turn = cmath.rect(1.0, -(pose[2] + math.radians(degrees)))
            first = math.inf
            for x, y, x2, y2 in self.world.walls:
                a, b = ((complex(*p) - _place(pose)) * turn for p in ((x, y), (x2, y2)))
                if (a.imag <= 0 <= b.imag or b.imag <= 0 <= a.imag) and a.imag != b.imag:
                    at = a.real + (b.real - a.real) * a.imag / (a.imag - b.imag)
                    if at >= 0:
                        first = min(first, at)
            for centre, radius in self.rounds(robot):
                q = (centre - _place(pose)) * turn
                if abs(q.imag) <= radius and q.real >= 0:
                    first = min(first, q.real - math.sqrt(radius**2 - q.imag**2))
            readings.append(1 - min(max(first - edge, 0.0), plan.laser_range) / plan.laser_range)
        return readings

    def light(self, robot: int) -> list[float]:
        pose, readings = self.world.poses[robot], []
        for sensor in range(8):
            axis = cmath.rect(1.0, pose[2] + sensor * PI / 4)
            total = 0.0
            for light in self.lights:
                way = light - _place(pose)
                ahead = (way * axis.conjugate()).real / abs(way)
                total += max(0.0, ahead) / (1 + (abs(way) / self.plan.light_distance) ** 2)
            readings.append(min(total, 1.0))
        return readings

    def ground(self, robot: int) -> list[float]:
        pose, readings = self.world.poses[robot], []
        for angle in (-0.0872, 0.0872, PI - 0.0872, PI + 0.0872):
            arm = 0.9 * self.world.bodies[robot].radius
            spot = _place(pose) + cmath.rect(arm, pose[2] + angle)
            below = [shade for place, radius, shade in self.zones if abs(spot - place) < radius]
            readings.append(below[-1] if below else 0.0)
        return readings

    def sectors(self, robot: int, things) -> list[float]:
        """Return the readings of a camera for objects, given as centre and radius."""
        pose = self.world.poses[robot]
        seen, size = [0.0] * 8, 0.0
        for centre, radius in things:
            way = centre - _place(pose)
            for s in range(8):
                offset = off(cmath.phase(way) - pose[2], (s + 0.5) * PI / 4)
                seen[s] = max(seen[s], 1 - offset / (PI / 4))
            size = max(size, 2 * math.atan2(radius, abs(way)))
        return [*seen, size]

    def observation(self, robot: int, time: float) -> list[float]:
        world, values = self.world, []
        cylinders = [(complex(x, y), radius) for x, y, radius in world.cylinders]
        robots = list(self.rounds(robot))[len(cylinders) :]
        for sensor in self.plan.sensors:
            values += {
                "infrared": lambda: world.infrared(robot),
                "camera": lambda: self.sectors(robot, robots),
                "cylinders": lambda: self.sectors(robot, cylinders),
                "ground": lambda: self.ground(robot),
                "gradient": lambda: world.ground(robot, self.plan.width, self.plan.height),
                "light": lambda: self.light(robot),
                "laser": lambda: self.laser(robot),
                "time": lambda: [time],
                "bias": lambda: [1.0],
            }[sensor]()
        return values

    def gap(self, robot: int) -> float:
        """Return the distance to the nearest wall, cylinder or robot."""
        x, y, _ = self.world.poses[robot]
        own = self.world.bodies[robot].radius
        gaps = [abs(complex(*nearest_point(w, x, y)) - complex(x, y)) for w in self.world.walls]
        gaps += [abs(c - complex(x, y)) - radius for c, radius in self.rounds(robot)]
        return min(gaps) - own

    def paid(self, before, action, bumps, visited: set) -> float:
        """Return the reward of a step; `before` are the poses at its start."""
        plan, world = self.plan, self.world
        places = [_place(pose) for pose in world.poses]
        radii = [body.radius for body in world.bodies]
        on = [[abs(p - place) < radius for place, radius, _ in self.zones] for p in places]
        team = range(len(places))

        def near(things) -> float:
            close = [
                any(abs(places[r] - c) < radii[r] + radius + plan.distance for c, radius in things)
                for r in team
            ]
            return sum(close) / len(close)

        if plan.reward == "avoid":
            total = 0.0
            for r in team:
                a, b = (min(max(x, -1.0), 1.0) for x in action[2 * r : 2 * r + 2])
                clear = min(self.gap(r) / plan.distance, 1.0)
                if not bumps[r]:
                    total += max((a + b) / 2, 0) * (1 - math.sqrt(abs(a - b) / 2)) * clear
            return total / len(places)
        if plan.reward == "explore":
            cells = {(int(p.real / plan.width * 8), int(p.imag / plan.height * 8)) for p in places}
            fresh = len(cells - visited)
            visited |= cells
            return fresh
        if plan.reward == "near-cylinder":
            return near([(complex(x, y), radius) for x, y, radius in world.cylinders])
        if plan.reward == "near-light":
            return near([(light, 0.0) for light in self.lights])
        if plan.reward == "on-zone":
            return sum(map(any, on)) / len(on)
        if plan.reward == "same-zone":
            return float(any(all(row[z] for row in on) for z in range(len(self.zones))))
        if plan.reward == "every-zone":
            return float(all(any(row[z] for row in on) for z in range(len(self.zones))))
        pairs = [(i, j) for i in team for j in team if i < j]
        if any(abs(places[i] - places[j]) >= radii[i] + radii[j] + plan.distance for i, j in pairs):
            return 0.0
        way = sum(places) / len(places) - sum(map(_place, before)) / len(places)
        return min(1.0, abs(way) / (0.1 * sum(world.speeds) / len(places)))
