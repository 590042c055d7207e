"""Sensors and rewards of declared arenas written a second time from their description
(docs/specification.md, "Declared arenas"), for the tests: plain Python, places as complex
numbers."""

from __future__ import annotations

import cmath
import math

from reference_arena import PI, nearest_point, off


def _place(pose) -> complex:
    return complex(pose[0], pose[1])


class Declared:
    """A plan at a moment: reference_arena.World, and what it does not know."""

    def __init__(self, world, plan, lights, zones) -> None:
        self.world, self.plan = world, plan
        self.lights = [complex(*light) for light in lights]
        self.zones = [
            (complex(*place), zone.radius, zone.shade)
            for place, zone in zip(zones, plan.zones, strict=True)
        ]

    def rounds(self, robot: int):
        """Centre and radius of the cylinders and of the other robots."""
        for x, y, radius in self.world.cylinders:
            yield complex(x, y), radius
        for other, pose in enumerate(self.world.poses):
            if other != robot:
                yield _place(pose), self.world.bodies[other].radius

    def laser(self, robot: int) -> list[float]:
        """In the frame of each beam, which runs along the positive real axis."""
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
        """A camera for things: centre and radius of each."""
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
        """To the nearest wall, cylinder or robot."""
        x, y, _ = self.world.poses[robot]
        own = self.world.bodies[robot].radius
        gaps = [abs(complex(*nearest_point(w, x, y)) - complex(x, y)) for w in self.world.walls]
        gaps += [abs(c - complex(x, y)) - radius for c, radius in self.rounds(robot)]
        return min(gaps) - own

    def paid(self, before, action, bumps, visited: set) -> float:
        """The reward of a step; `before` are the poses that it began with."""
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
