"""What the figure of exercise 12 needs."""

from typing import Any

from botschool.page.exercise import robot

CORE = "classic"


def data() -> dict[str, Any]:
    """Return the cart-pole, with episodes of 200 steps as in the exercise."""
    return {"pole": robot("cartpole.ini", maxsteps=200)}
