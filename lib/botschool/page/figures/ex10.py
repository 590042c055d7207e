"""What the figures of exercise 10 need."""

from typing import Any

from botschool.page.exercise import robot

CORE = "spatial"


def data() -> dict[str, Any]:
    """Return the native twin of the robot that the exercise builds, evolved."""
    return {"balancer": robot("spatialbalancebot.ini", "spatialbalancebot.npy")}
