"""Show episodes in a window."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterable
from typing import Any

import numpy as np

from botschool.errors import BotschoolError
from botschool.render.canvas import import_pygame


def show(frames: Iterable[np.ndarray], fps: float, title: str) -> bool:
    """Show frames, each (height, width, 3) uint8, in a window, `fps` per second.

    The space key pauses and continues; Esc, q or closing the window ends. Return True if all frames
    were shown, False if the user ended earlier. Raises BotschoolError if there is no display.
    """
    pygame = import_pygame()
    open_display(pygame)
    try:
        pygame.display.set_caption(title)
        clock = pygame.time.Clock()
        window = None
        for frame in frames:
            size = (frame.shape[1], frame.shape[0])
            if window is None or window.get_size() != size:
                window = pygame.display.set_mode(size)
            pygame.surfarray.blit_array(window, frame.swapaxes(0, 1))
            pygame.display.flip()
            clock.tick(fps)
            if not _goes_on(pygame, clock):
                return False
        return True
    except pygame.error as error:
        raise _no_display() from error
    finally:
        pygame.display.quit()


def open_display(pygame: Any) -> None:
    """Open the machine's display, replacing one that was opened for drawing offscreen."""
    pygame.display.quit()
    places = ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")
    if sys.platform == "linux" and not any(map(os.environ.get, places)):
        raise _no_display()
    try:
        pygame.display.init()
    except pygame.error as error:
        raise _no_display() from error
    driver = pygame.display.get_driver()
    if driver in ("dummy", "offscreen") and os.environ.get("SDL_VIDEODRIVER") != driver:
        pygame.display.quit()
        raise _no_display()


def _no_display() -> BotschoolError:
    return BotschoolError(
        "there is no display to open a window on: make a film with `--video FILE.mp4` instead."
    )


def _goes_on(pygame: Any, clock: Any) -> bool:
    """Handle keys, and wait while paused; return False if the user wants to end."""
    paused = False
    while True:
        for event in pygame.event.get():
            if event.type == pygame.QUIT:
                return False
            if event.type == pygame.KEYDOWN:
                if event.key in (pygame.K_ESCAPE, pygame.K_q):
                    return False
                if event.key == pygame.K_SPACE:
                    paused = not paused
        if not paused:
            return True
        clock.tick(30)
