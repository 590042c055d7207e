"""What the figures of exercise 7 need."""

from typing import Any

from botschool.page.exercise import robot

CORE = "classic"


def data() -> dict[str, Any]:
    """Return an evolved pendulum, and the experiment that evolves one in the page."""
    return {"pendulum": robot("pendulum.ini", "pendulum.npy"), "evolving": robot("pendulum.ini")}
