"""What the figures of exercise 3 need."""

from typing import Any

from botschool.page.exercise import robot

CORE = "classic"


def data() -> dict[str, Any]:
    """Return the pendulum with the network of the exercise's `Robot`."""
    network: dict[str, Any] = {"nhiddens": 10, "winit": 0, "normalize": 0, "clip": 0}
    return {"pendulum": robot("pendulum.ini", episodes=5, pepisodes=20, **network)}
