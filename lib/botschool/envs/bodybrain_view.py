"""Draw a BodyBrain robot in the style of Gymnasium's Box2D environments.

`env` is always a botschool.envs.bodybrain.BodyBrain.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
from gymnasium.error import DependencyNotInstalled

from botschool.envs.morphology import START_X, TERRAIN_STEP

try:
    import pygame
    from pygame import gfxdraw
except ImportError as error:
    raise DependencyNotInstalled(
        "pygame, which `pip install 'gymnasium[box2d]'` installs"
    ) from error

WIDTH, HEIGHT = 600, 400
SCALE = 30.0
"""Pixels per metre."""
GROUND_AT = 110.0
"""Average height of the ground in the picture, in pixels."""

SKY = (215, 215, 255)
CLOUD = (255, 255, 255)
GRASS, EARTH = (102, 178, 76), (139, 186, 103)
FLAG = (230, 51, 0)
MARK = (90, 110, 80)
TORSO, TORSO_EDGE = (213, 120, 60), (140, 70, 30)
NEAR, FAR = np.array([127, 76, 180]), np.array([90, 170, 200])
"""Colours of the first and the last segment behind the torso; the others lie between."""
HINGE = (60, 40, 80)

CLOUDS = ((3.0, 9.6, 1.5), (11.0, 8.4, 1.0), (16.5, 10.2, 1.8), (24.0, 9.0, 1.2))
"""x, y and size in metres; clouds repeat every 30 m, and move at half the ground's pace."""
CLOUDS_EVERY = 30.0


class View:
    """Draws an environment into a window ("human") or into arrays ("rgb_array")."""

    def __init__(self, mode: str, fps: int) -> None:
        self._mode, self._fps = mode, fps
        self._surface = pygame.Surface((WIDTH, HEIGHT))
        self._left = self._bottom = 0.0
        self._font: Any = None
        self._window: Any = None
        self._clock: Any = None

    def draw(self, env) -> np.ndarray | None:
        """Return the picture as (400, 600, 3) uint8, or None if the window shows it."""
        if self._mode == "human":
            self._open()
        if not env.exploded:
            self._look_at(env)
        self._surface.fill(SKY)
        self._draw_clouds()
        self._draw_ground(env.heights)
        self._draw_flag(env.heights)
        if not env.exploded:
            self._draw_robot(env)
        if self._mode == "human":
            self._show()
            return None
        return np.ascontiguousarray(pygame.surfarray.array3d(self._surface).swapaxes(0, 1))

    def _look_at(self, env) -> None:
        """Put the robot in the middle, and the visible ground at its usual height."""
        x = float(np.mean([segment.position.x for segment in env.segments]))
        self._left = x - WIDTH / SCALE / 2
        seen = np.interp(np.linspace(x - 10, x + 10, 21), *_ground(env.heights))
        self._bottom = float(np.mean(seen)) - GROUND_AT / SCALE

    def _at(self, x: float, y: float) -> tuple[float, float]:
        """Return a point in metres as pixels."""
        return SCALE * (x - self._left), HEIGHT - SCALE * (y - self._bottom)

    def _draw_clouds(self) -> None:
        shift = self._left / 2
        first = math.floor((shift - 5) / CLOUDS_EVERY)
        for turn in (first, first + 1, first + 2):
            for x, y, size in CLOUDS:
                left = SCALE * (x + turn * CLOUDS_EVERY - shift)
                for dx, dy, radius in ((-0.9, 0, 0.45), (0, 0.18, 0.7), (0.95, 0, 0.5)):
                    centre = (left + SCALE * size * dx, HEIGHT - SCALE * (y - 0.4 + size * dy))
                    _disc(self._surface, centre, SCALE * size * radius, CLOUD)
                bar = (left - SCALE * size * 0.9, HEIGHT - SCALE * (y - 0.4 - size * 0.45))
                width, height = SCALE * size * 1.9, SCALE * size * 0.5
                self._surface.fill(CLOUD, (bar[0], bar[1] - height, width, height))

    def _draw_ground(self, heights: list[float]) -> None:
        points = [self._at(x, y) for x, y in zip(*_ground(heights), strict=True)]
        for (x1, y1), (x2, y2) in pairwise(points):
            if x2 < 0 or x1 > WIDTH:
                continue
            corners = [(x1, y1), (x2, y2), (x2, HEIGHT), (x1, HEIGHT)]
            gfxdraw.filled_polygon(self._surface, corners, EARTH)
            pygame.draw.line(self._surface, GRASS, (x1, y1 + 3), (x2, y2 + 3), 7)
            pygame.draw.aaline(self._surface, (76, 140, 56), (x1, y1), (x2, y2))

    def _draw_flag(self, heights: list[float]) -> None:
        """Draw a flag where robots start, and a number every 5 m from there."""
        x, y = self._at(START_X, heights[0])
        pygame.draw.aaline(self._surface, (0, 0, 0), (x, y), (x, y - 50))
        flag = [(x, y - 50), (x, y - 40), (x + 25, y - 45)]
        _polygon(self._surface, flag, FLAG)
        if self._font is None:
            pygame.font.init()
            self._font = pygame.font.Font(None, 18)
        end = TERRAIN_STEP * (len(heights) - 1)
        for metres in range(-5, int(end - START_X) + 1, 5):
            place = START_X + metres
            px, py = self._at(place, float(np.interp(place, *_ground(heights))))
            if -20 < px < WIDTH + 20:
                pygame.draw.line(self._surface, MARK, (px, py + 12), (px, py + 18), 2)
                text = self._font.render(f"{metres} m", True, MARK)
                self._surface.blit(text, (px - text.get_width() / 2, py + 20))

    def _draw_robot(self, env) -> None:
        last = len(env.segments) - 1
        for i in range(last, -1, -1):
            segment = env.segments[i]
            vertices = segment.fixtures[0].shape.vertices
            corners = [self._at(*(segment.transform * vertex)) for vertex in vertices]
            share = max(i - 1, 0) / (last - 1)
            colour = TORSO if i == 0 else tuple(map(int, (1 - share) * NEAR + share * FAR))
            edge = TORSO_EDGE if i == 0 else tuple(c // 2 for c in colour)
            _polygon(self._surface, corners, colour)
            pygame.draw.aalines(self._surface, edge, True, corners)
        for joint in env.joints:
            _disc(self._surface, self._at(*joint.anchorA), 2.5, HINGE)

    def _open(self) -> None:
        if self._window is None:
            pygame.display.init()
            self._window = pygame.display.set_mode((WIDTH, HEIGHT))
            pygame.display.set_caption("BodyBrain")
            self._clock = pygame.time.Clock()

    def _show(self) -> None:
        self._window.blit(self._surface, (0, 0))
        pygame.event.pump()
        self._clock.tick(self._fps)
        pygame.display.flip()

    def close(self) -> None:
        """Close the window, if there is one."""
        if self._window is not None:
            pygame.display.quit()
            self._window = None


def _ground(heights: list[float]) -> tuple[np.ndarray, list[float]]:
    return TERRAIN_STEP * np.arange(len(heights)), heights


def _polygon(surface, corners, colour) -> None:
    gfxdraw.filled_polygon(surface, corners, colour)
    gfxdraw.aapolygon(surface, corners, colour)


def _disc(surface, centre, radius: float, colour) -> None:
    x, y, radius = round(centre[0]), round(centre[1]), round(radius)
    gfxdraw.filled_circle(surface, x, y, radius, colour)
    gfxdraw.aacircle(surface, x, y, radius, colour)
