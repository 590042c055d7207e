"""What the figures of exercise 1 need."""

from typing import Any

from botschool.page.exercise import robot

CORE = "classic"


def data() -> dict[str, Any]:
    """Return the cart-pole, with 500 steps an episode as in Gymnasium."""
    return {"pole": robot("cartpole.ini", maxsteps=500)}
