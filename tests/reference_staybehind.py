"""ErStaybehind written a second time from its description (docs/specification.md, "ErStaybehind"),
for the tests: plain Python on the robots and walls of reference_arena."""

from __future__ import annotations

import cmath

from reference_arena import MARXBOT, PI, World, off

SIDE = 3000.0
SPEED = 500.0
WORD = 1 << 32


def philox(seed: int, episode: int, stream: int, step: int, index: int) -> list[int]:
    """Philox4x32-10 (Salmon and others 2011): four words of 32 bits."""
    counter, key = [index, step, stream, episode], [seed % WORD, seed // WORD]
    for _ in range(10):
        a, b, c, d = counter
        upper, lower = divmod(0xD2511F53 * a, WORD)
        over, under = divmod(0xCD9E8D57 * c, WORD)
        counter = [over ^ b ^ key[0], under, upper ^ d ^ key[1], lower]
        key = [(key[0] + 0x9E3779B9) % WORD, (key[1] + 0xBB67AE85) % WORD]
    return counter


class Staybehind:
    """An episode: `step` moves both robots."""

    def __init__(self, seed: int, episode: int, maxsteps: int) -> None:
        corners = [(0, 0), (SIDE, 0), (SIDE, SIDE), (0, SIDE)]
        walls = [(*corners[i], *corners[(i + 1) % 4]) for i in range(4)]
        poses = [(1000, 1500, 0), (2000, 1500, PI)]
        self.world = World([MARXBOT, MARXBOT], [SPEED, SPEED], poses, walls, [])
        self.seed, self.episode, self.maxsteps = seed, episode, maxsteps
        self.blocked = [False, False]
        self.steps = 0

    def observation(self) -> list[float]:
        """Of the first robot, then of the second."""
        values = []
        for robot in (0, 1):
            values += self.world.infrared(robot) + self.world.camera(robot)
            values += self.world.camera(1 - robot)[:8]
            values += self.world.ground(robot, SIDE, SIDE)
            values += [self.steps / self.maxsteps, 1.0]
        return values

    def step(self, action) -> tuple[float, bool]:
        """The reward, and whether the episode has ended by a collision."""
        (x, y, heading), (ox, oy, _) = self.world.poses
        way = complex(ox - x, oy - y)
        ahead = off(cmath.phase(way), heading) < PI / 4
        due = 340 < abs(way) < 600
        words = philox(self.seed, self.episode, 4, self.steps, 0)
        bumped = False
        for robot in (0, 1):
            block, free = words[2 * robot] / WORD, words[2 * robot + 1] / WORD
            if not self.blocked[robot] and block < 0.01:
                self.blocked[robot] = True
            if self.blocked[robot] and free < 0.05:
                self.blocked[robot] = False
            if not self.blocked[robot]:
                left, right = motors(*action[2 * robot : 2 * robot + 2])
                bumped |= self.world.drive(robot, left, right) != ""
        self.steps += 1
        aligned = off(self.world.poses[0][2], self.world.poses[1][2]) < PI / 4
        return 0.01 if ahead and due and aligned and not bumped else 0.0, bumped


def motors(speed: float, turn: float) -> tuple[float, float]:
    """Left and right wheel, shares of the greatest speed."""
    v, t = (speed + 1) / 2, (turn + 1) / 2
    if t < 0.5:
        return v * (1 - 2 * (0.5 - t)), v
    return v, v * (1 - 2 * (t - 0.5))


def states(world: Staybehind) -> list[float]:
    """As the native problem's state."""
    poses = [value for pose in world.world.poses for value in pose]
    return [*poses, *map(float, world.blocked), float(world.steps)]
