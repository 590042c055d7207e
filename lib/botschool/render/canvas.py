"""Drawing with pygame without a window, and without leaving traces in the environment."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np

from botschool.errors import BotschoolError

if TYPE_CHECKING:
    import pygame

WHITE = (255, 255, 255)
BLACK = (0, 0, 0)
GREY = (128, 128, 128)


def import_pygame() -> ModuleType:
    """pygame, without its greeting. Raises BotschoolError if it is not installed."""
    try:
        with _environment(PYGAME_HIDE_SUPPORT_PROMPT="1"):
            import pygame
    except ImportError as error:
        raise BotschoolError(
            "drawing needs pygame: install it with `pip install 'gymnasium[classic-control]'`."
        ) from error
    return pygame


def draw_offscreen() -> None:
    """Call this before Gymnasium or pygame draws frames that go to no window.

    Where no display is open yet, pygame's dummy one is opened, so that nothing is asked of the
    machine's screen; an open window stays as it is.
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
    """A white surface."""
    pygame = import_pygame()
    surface = pygame.Surface((width, height), depth=24)
    surface.fill(WHITE)
    return surface


def to_frame(surface: pygame.Surface) -> np.ndarray:
    """A copy of the surface, (height, width, 3) uint8."""
    pygame = import_pygame()
    return np.ascontiguousarray(pygame.surfarray.array3d(surface).swapaxes(0, 1))


def write_text(
    surface: pygame.Surface, text: str, left_top: tuple[float, float], size: int = 20
) -> None:
    """Writes one black line in pygame's own font, which comes with it."""
    surface.blit(_text(text, size), left_top)


@lru_cache(maxsize=256)
def _text(text: str, size: int) -> pygame.Surface:
    pygame = import_pygame()
    if not pygame.font.get_init():
        pygame.font.init()
    return pygame.font.Font(None, size).render(text, True, BLACK)


def polygon(
    surface: pygame.Surface, corners: list[tuple[float, float]], colour: tuple[int, int, int]
) -> None:
    """A filled polygon with smooth edges."""
    from pygame import gfxdraw

    gfxdraw.aapolygon(surface, corners, colour)
    gfxdraw.filled_polygon(surface, corners, colour)


def disc(
    surface: pygame.Surface,
    centre: tuple[float, float],
    radius: float,
    colour: tuple[int, int, int],
) -> None:
    """A filled circle with a smooth edge."""
    from pygame import gfxdraw

    x, y, radius = round(centre[0]), round(centre[1]), round(radius)
    gfxdraw.aacircle(surface, x, y, radius, colour)
    gfxdraw.filled_circle(surface, x, y, radius, colour)
