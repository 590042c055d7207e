"""Paint a body in space: ground, shadow and lit limbs, as replay_space.js does in a page."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from botschool.render.canvas import FINE, blank, import_pygame, to_frame, write_text
from botschool.render.shapes import PALETTE

if TYPE_CHECKING:
    import pygame

Triple = tuple[float, float, float]

ROUND = np.array([[np.cos(a), np.sin(a)] for a in 2 * np.pi * np.arange(32) / 32])
WHITE, BLACK = np.full(3, 255.0), np.zeros(3)


@dataclass(frozen=True)
class Space:
    """What both painters know of a body and of the camera that follows it, in metres.

    links: of each its parent, its place there, its axis, whether it slides along it. limbs: of each
    its link, both ends there, radius, colour. height: of what the camera looks at, from `distance`,
    with the axes right, up and back. memory: steps in about a second, which the camera remembers;
    seconds: of a step. near, far: from the camera, and from what it looks at, to what is drawn of
    the ground.
    sun: where the light comes from, on so many bands of a limb. shade: opacity of a shadow.
    slope, step: metres that the ground rises with each metre ahead, and at x = 2.
    strokes: two ends each; digits: which of the strokes each has, a bit each.
    """

    links: tuple[tuple[float, ...], ...]
    limbs: tuple[tuple, ...]
    height: float
    memory: int
    seconds: float
    distance: float = 6.0
    axes: tuple[Triple, ...] = ((0.913, 0.408, 0), (-0.121, 0.27, 0.955), (0.39, -0.872, 0.296))
    near: float = 1.0
    far: float = 10.0
    sun: Triple = (-0.2, -0.3, 1.0)
    bands: int = 24
    shade: float = 0.28
    slope: float = 0.0
    step: float = 0.0
    strokes: tuple[tuple[float, ...], ...] = (
        (0, 2, 1, 2), (0, 1, 0, 2), (1, 1, 1, 2), (0, 1, 1, 1), (0, 0, 0, 1), (1, 0, 1, 1),
        (0, 0, 1, 0),
    )  # fmt: skip
    digits: tuple[int, ...] = (0x77, 0x24, 0x5D, 0x6D, 0x2E, 0x6B, 0x7B, 0x25, 0x7F, 0x6F)


class SpacePainter:
    """Paints the frames of a scene in space on white; arguments as in `canvas.Painter`."""

    def __init__(
        self,
        space: Space,
        places: Callable[[np.ndarray], np.ndarray],
        view: tuple[float, float, float, float],
        scale: float,
    ) -> None:
        """Make the painter; places: as in `_core.SpatialBody`."""
        left, bottom, right, top = view
        self._space, self._places = space, places
        self._size = round((right - left) * scale), round((top - bottom) * scale)
        self._corner, self._pixels = np.array([left, top]), FINE * scale
        self._axes = np.array(space.axes)
        self._coordinates = len(space.links) + 6
        self._ends = np.array([limb[1:7] for limb in space.limbs]).reshape(-1, 2, 3)
        self._radii = np.array([limb[7] for limb in space.limbs])

    def frame(self, past: Sequence[np.ndarray]) -> np.ndarray:
        """Return a frame, (height, width, 3) uint8; past: the numbers of the last steps."""
        space = self._space
        way = np.array([numbers[:2] for numbers in past[: -space.memory - 2 : -1]])
        steps = len(way) - 1
        way = np.concatenate([way, way[-1:].repeat(space.memory - steps, axis=0)])
        middle = followed(way)
        self._target = np.array([*middle, space.height + self._ground(middle)[0]])
        surface = blank(*(FINE * side for side in self._size))
        self._paint_ground(surface)
        places = self._places(past[-1][: self._coordinates])
        ends = np.array(
            [places[limb[0], 0] + own @ places[limb[0], 1:]
             for limb, own in zip(space.limbs, self._ends, strict=True)]
        )  # fmt: skip
        self._paint_shadow(surface, ends)
        self._paint_limbs(surface, ends)
        small = import_pygame().transform.smoothscale(surface, self._size)
        speed = (way[0, 0] - way[steps, 0]) / max(steps, 1) / space.seconds
        write_text(small, f"{way[0, 0]:.1f} m    {speed:.1f} m/s", (12, 12), 26)
        return to_frame(small)

    def _paint_ground(self, surface: pygame.Surface) -> None:
        """Paint every other square metre, and how many metres it is from the start."""
        space, middle = self._space, self._target[:2]
        around = np.arange(-space.far - 1, space.far + 1)
        corners = np.floor(middle) + np.stack(np.meshgrid(around, around), axis=-1).reshape(-1, 2)
        away = np.linalg.norm(corners + 0.5 - middle, axis=1) / space.far
        corners, strengths = corners[away < 1], (1 - away[away < 1] ** 2) ** 2
        dark = corners.sum(axis=1) % 2 == 1
        square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
        self._fill(surface, corners[dark][:, None] + square, "ground", strengths[dark])
        marks = np.array(
            [(x + stroke[0], y + stroke[1], x + stroke[2], y + stroke[3], strength)
             for (x, y), strength in zip(corners, strengths, strict=True)
             if x >= 0 and (y + 1) % 4 == 0 for stroke in self._strokes(f"{x:.0f}")]
        ).reshape(-1, 5)  # fmt: skip
        outlines = hull(marks[:, :2], 0.022, marks[:, 2:4], 0.022)
        self._fill(surface, outlines, "muted", marks[:, 4])

    def _strokes(self, number: str) -> Iterator[np.ndarray]:
        for place, digit in enumerate(number):
            for bit, stroke in enumerate(self._space.strokes):
                if self._space.digits[int(digit)] >> bit & 1:
                    left = 0.08 + 0.22 * place
                    yield 0.15 * np.array(stroke) + (left, -0.4, left, -0.4)

    def _ground(self, points: np.ndarray) -> np.ndarray:
        """Return the height of the ground at points, with a last axis of size 1."""
        ahead = points[..., :1]
        return self._space.slope * ahead + self._space.step * (ahead > 2)

    def _seen(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return pixels, and pixels per metre, of points."""
        x, y, back = np.moveaxis((points - self._target) @ self._axes.T, -1, 0)
        size = self._space.distance / np.maximum(self._space.distance - back, self._space.near)
        flat = np.stack([x * size - self._corner[0], self._corner[1] - y * size], axis=-1)
        return np.clip(flat * self._pixels, -1e4, 1e4), size * self._pixels

    def _fill(
        self, surface: pygame.Surface, polygons: np.ndarray, colour: str, strengths: np.ndarray
    ) -> None:
        """Fill polygons on the ground, (polygons, corners, 2), that are not too near the camera."""
        inside = 0.99 * polygons + 0.01 * polygons.mean(axis=1, keepdims=True)
        pixels, sizes = self._seen(np.concatenate([polygons, self._ground(inside)], axis=-1))
        nearest = self._pixels * self._space.distance / self._space.near
        for points, size, strength in zip(pixels, sizes, strengths, strict=True):
            if size.max() < nearest:
                import_pygame().draw.polygon(surface, mixed(colour, WHITE, 1 - strength), points)

    def _paint_shadow(self, surface: pygame.Surface, ends: np.ndarray) -> None:
        pygame, sun = import_pygame(), self._space.sun
        above = ends[..., 2:] - self._ground(ends)
        fallen = ends[..., :2] - above * np.array(sun[:2]) / sun[2]
        around = hull(fallen[:, 0], self._radii, fallen[:, 1], self._radii)
        outlines, _ = self._seen(np.concatenate([around, self._ground(around)], axis=-1))
        shadow = pygame.Surface(surface.get_size(), pygame.SRCALPHA)
        for points in outlines:
            pygame.draw.polygon(shadow, (0, 0, 0, round(255 * self._space.shade)), points)
        surface.blit(shadow, (0, 0))

    def _paint_limbs(self, surface: pygame.Surface, ends: np.ndarray) -> None:
        pixels, sizes = self._seen(ends)
        radii = self._radii[:, None] * sizes
        sun = self._axes @ self._space.sun / np.linalg.norm(self._space.sun)
        towards = np.array([sun[0], -sun[1]])
        shares = np.arange(self._space.bands)[:, None, None] / self._space.bands
        centres = pixels + (shares * radii)[..., None] * towards
        outlines = [
            hull(middles[:, 0], within[:, 0], middles[:, 1], within[:, 1])
            for middles, within in zip(centres, radii * (1 - shares), strict=True)
        ]
        for limb in np.argsort(sizes.sum(axis=1)):
            for share, outline in zip(shares.flat, outlines, strict=True):
                colour = lit(self._space.limbs[limb][8], share)
                import_pygame().draw.polygon(surface, colour, outline[limb])


def followed(way: np.ndarray) -> np.ndarray:
    """Return where a smooth camera looks; way: places of the body, the newest first, (steps, 2).

    It goes at the speed of the last second, and would be right at a constant speed.
    """
    half = len(way) // 2
    late, early = way[:half].mean(axis=0), way[half : 2 * half].mean(axis=0)
    return late + (half - 1) / (2 * half) * (late - early)


def mixed(colour: str, other: np.ndarray, share: float) -> tuple[int, int, int]:
    """Return a colour of the palette with a share of another."""
    red, green, blue = PALETTE[colour][0] + share * (other - PALETTE[colour][0])
    return round(red), round(green), round(blue)


def lit(colour: str, share: float) -> tuple[int, int, int]:
    """Return the colour of a place on a limb: 0 where it is darkest, to 1."""
    if share < 0.5:
        return mixed(colour, BLACK, 0.45 * (1 - 2 * share))
    return mixed(colour, WHITE, 0.6 * (2 * share - 1))


def hull(a: np.ndarray, ra, b: np.ndarray, rb) -> np.ndarray:
    """Return the outlines of discs at a with radius ra, and at b with rb, each a convex polygon."""
    ra, rb = (np.broadcast_to(r, len(a))[:, None, None] for r in (ra, rb))
    a, b = a[:, None], b[:, None]
    farther = (b * ROUND).sum(-1, keepdims=True) + rb > (a * ROUND).sum(-1, keepdims=True) + ra
    return np.where(farther, b + rb * ROUND, a + ra * ROUND)
