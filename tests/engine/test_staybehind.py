"""ErStaybehind step by step against an independent account, and how it is drawn."""

from __future__ import annotations

import cmath

import numpy as np
import pytest

from botschool import arena
from reference_arena import MARXBOT, PI, World, off
from reference_network import philox

NEAR = {"rel": 0, "abs": 1e-9}


def driven(seed, episode, actions, start=None):
    """The native arena and the reference through the same actions; what the reference says."""
    own = arena.make("staybehind", max_steps=len(actions))
    own.reset(seed, episode)
    reference = Staybehind(seed, episode, len(actions))
    if start is not None:
        own.robots = start
        reference.world.poses = [tuple(map(float, pose)) for pose in start]
    told = []
    for action in actions:
        assert own.sense() == pytest.approx(reference.observation(), **NEAR)
        own.action = action
        reward = own.step()
        expected, bumped = reference.step(action)
        assert own.state == pytest.approx(states(reference), **NEAR)
        assert reward == expected
        assert own.terminated == bumped
        told.append((expected, bumped, *reference.blocked))
        if bumped:
            break
    return told


def convoy(rng, steps):
    """Actions of two robots that drive along one behind the other, a little unsteadily."""
    actions = rng.uniform(-0.2, 0.2, (steps, 4))
    actions[:, 0::2] += -0.6
    return actions


@pytest.mark.slow
def test_episodes_follow_the_reference_step_by_step():
    """Of random drivers, and of two that drive in a line, so that rewards are earned."""
    rng = np.random.default_rng(4)
    rewarded = bumps = blocked = freed = 0
    for episode in range(40):
        seed = int(rng.integers(2**62))
        if episode % 2:
            told = driven(seed, episode, rng.uniform(-1, 1, (200, 4)))
        else:
            start = (300.0, 1500.0, 0.1), (800.0, 1540.0, 0.0)
            told = driven(seed, episode, convoy(rng, 200), start)
        rewards, ends, first, second = map(np.array, zip(*told, strict=True))
        rewarded += np.count_nonzero(rewards)
        bumps += ends.sum()
        for held in (first, second):
            blocked += np.count_nonzero(np.diff(held.astype(int)) == 1)
            freed += np.count_nonzero(np.diff(held.astype(int)) == -1)
    assert rewarded > 200 and bumps > 5 and blocked > 50 and freed > 20


@pytest.mark.slow
def test_who_is_blocked_stays_and_how_often():
    own = arena.make("staybehind", max_steps=500)
    held, onsets, steps = np.zeros(2), np.zeros(2), 0
    for episode in range(50):
        own.reset(7, episode)
        own.robots = (700, 700, 0), (2300, 2300, 1)
        before = own.state.copy()
        own.action = [-0.8, 1, -0.8, 1]  # in circles
        while not own.done:
            own.step()
            state = own.state
            for robot in range(2):
                pose = slice(3 * robot, 3 * robot + 3)
                assert (state[pose].tolist() == before[pose].tolist()) == bool(state[6 + robot])
            held += state[6:8]
            onsets += state[6:8] > before[6:8]
            steps += 1
            before = state.copy()
        assert not own.terminated
    # 0.95 of the blocked ones remain, those newly blocked among them; odds of a two-state chain
    share = 0.01 * 0.95 / (0.01 * 0.95 + 0.05)
    assert held / steps == pytest.approx(share, abs=0.04)  # episodes begin with both free
    assert onsets / (steps - held) == pytest.approx(0.01 * 0.95, rel=0.2)


# --- ErStaybehind written a second time from its description in docs/specification.md,
# "ErStaybehind": plain Python on the robots and walls of reference_arena.


SIDE = 3000.0
SPEED = 500.0
WORD = 1 << 32


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
        words = philox(self.seed, (0, self.steps, 4, self.episode))
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
