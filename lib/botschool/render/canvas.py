"""Draw with pygame without a window, and without side effects on the environment."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from botschool.errors import BotschoolError
from botschool.render.shapes import PALETTE, Colour, Shape

if TYPE_CHECKING:
    import pygame

WHITE = (255, 255, 255)
BLACK = (0, 0, 0)
GREY = (128, 128, 128)

FINE = 2
"""Frames are drawn larger by this factor, then reduced, which smooths edges."""
_FAR = 16_000.0  # pygame stores coordinates in 16 bits


def import_pygame() -> ModuleType:
    """Import pygame without its greeting. Raises BotschoolError if it is not installed."""
    try:
        with _environment(PYGAME_HIDE_SUPPORT_PROMPT="1"):
            import pygame
    except ImportError as error:
        raise BotschoolError(
            "drawing needs pygame: install it with `pip install 'gymnasium[classic-control]'`."
        ) from error
    return pygame


def draw_offscreen() -> None:
    """Prepare for Gymnasium or pygame to draw frames without a window.

    If no display is open yet, pygame's dummy display is opened, so that the machine's screen is not
    needed; an open window stays as it is.
    """
    pygame = import_pygame()
    if not pygame.display.get_init():
        with _environment(SDL_VIDEODRIVER="dummy"):
            pygame.display.init()


@contextmanager
def _environment(**variables: str) -> Iterator[None]:
    before = {name: os.environ.get(name) for name in variables}
    os.environ.update(variables)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def blank(width: int, height: int) -> pygame.Surface:
    """Return a white surface."""
    pygame = import_pygame()
    surface = pygame.Surface((width, height), depth=24)
    surface.fill(WHITE)
    return surface


def to_frame(surface: pygame.Surface) -> np.ndarray:
    """Return a copy of the surface, (height, width, 3) uint8."""
    pygame = import_pygame()
    return np.ascontiguousarray(pygame.surfarray.array3d(surface).swapaxes(0, 1))


def write_text(
    surface: pygame.Surface, text: str, left_top: tuple[float, float], size: int = 20
) -> None:
    """Write one black line in pygame's own font, which comes with it."""
    surface.blit(_text(text, size, BLACK), left_top)


@lru_cache(maxsize=256)
def _text(text: str, size: int, colour: Colour) -> pygame.Surface:
    pygame = import_pygame()
    if not pygame.font.get_init():
        pygame.font.init()
    return pygame.font.Font(None, size).render(text, True, colour)


class Painter:
    """Paints the frames of a scene on white.

    view: left, bottom, right, top of the visible world; scale: pixels per unit of length.
    """

    def __init__(
        self, shapes: Sequence[Shape], view: tuple[float, float, float, float], scale: float
    ) -> None:
        left, bottom, right, top = view
        self._size = round((right - left) * scale), round((top - bottom) * scale)
        self._origin, self._scale = (left, top), scale
        still = list(itertools.takewhile(lambda shape: not shape.moves, shapes))
        self._moving = shapes[len(still) :]
        self._texts = [shape for shape in shapes if shape.kind == "text"]
        self._still = blank(*(FINE * side for side in self._size))
        self._paint(self._still, still, [np.zeros(0)])

    def frame(self, past: Sequence[np.ndarray]) -> np.ndarray:
        """Return a frame, (height, width, 3) uint8.

        past: the numbers of the steps so far, oldest first; the last ones belong to this frame.
        """
        large = self._still.copy()
        self._paint(large, self._moving, past)
        surface = import_pygame().transform.smoothscale(large, self._size)
        for shape in self._texts:
            if not shape.visible(past[-1]):
                continue
            [(x, y)] = _to_pixels(shape.placed(past[-1]), self._origin, self._scale)
            written = _text(shape.text, 20, PALETTE[shape.colour][0])
            surface.blit(written, (x - written.get_width() / 2, y - written.get_height() / 2))
        return to_frame(surface)

    def _paint(
        self, surface: pygame.Surface, shapes: Sequence[Shape], past: Sequence[np.ndarray]
    ) -> None:
        pixels = FINE * self._scale
        for shape in shapes:
            if shape.kind == "trail":
                _paint_trail(surface, shape, past, self._origin, pixels)
            elif shape.kind != "text" and (opacity := shape.visible(past[-1])):
                points = _to_pixels(shape.placed(past[-1]), self._origin, pixels)
                if _within(surface, points, shape.radius * pixels):
                    _paint_shape(surface, shape, points, pixels, opacity)


def _to_pixels(points: np.ndarray, origin: tuple[float, float], pixels: float) -> np.ndarray:
    left, top = origin
    placed = np.column_stack([points[:, 0] - left, top - points[:, 1]]) * pixels
    return np.clip(placed, -_FAR, _FAR)


def _within(surface: pygame.Surface, points: np.ndarray, margin: float) -> bool:
    """Return whether part of a shape can lie between the left and the right edge."""
    return points[:, 0].max() >= -margin and points[:, 0].min() <= surface.get_width() + margin


def _paint_shape(
    surface: pygame.Surface, shape: Shape, points: np.ndarray, pixels: float, opacity: float
) -> None:
    from pygame import gfxdraw

    colour = (*PALETTE[shape.colour][0], round(255 * opacity))
    if shape.kind == "disc":
        [(x, y)] = points.round().astype(int)
        gfxdraw.filled_circle(surface, x, y, round(shape.radius * pixels), colour)
    elif shape.kind == "line":
        for a, b in itertools.pairwise(points):
            _paint_stroke(surface, a, b, shape.radius * pixels, colour)
    elif shape.kind == "polygon":
        gfxdraw.filled_polygon(surface, points, colour)


def _paint_trail(
    surface: pygame.Surface,
    shape: Shape,
    past: Sequence[np.ndarray],
    origin: tuple[float, float],
    pixels: float,
) -> None:
    way = np.array(past[-shape.steps - 1 :])[:, shape.pose : shape.pose + 2]
    points = _to_pixels(way, origin, pixels)
    for age, (a, b) in enumerate(itertools.pairwise(points[::-1])):
        opacity = 0.7 * (1 - age / shape.steps)
        colour = (*PALETTE[shape.colour][0], round(255 * opacity))
        _paint_stroke(surface, a, b, shape.radius * pixels, colour)


def _paint_stroke(
    surface: pygame.Surface, a: np.ndarray, b: np.ndarray, half: float, colour: tuple
) -> None:
    from pygame import gfxdraw

    length = float(np.hypot(*(b - a)))
    if length > 0.0:
        across = np.array([a[1] - b[1], b[0] - a[0]]) / length * max(half, 1.0)
        gfxdraw.filled_polygon(surface, [a + across, b + across, b - across, a - across], colour)
