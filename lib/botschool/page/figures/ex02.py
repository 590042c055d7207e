"""What the figures of exercise 2 need."""

from typing import Any

from botschool.page.exercise import robot

CORE = "classic"


def data() -> dict[str, Any]:
    """Return the cart-pole with a small network: three hidden neurons."""
    return {"pole": robot("cartpole.ini", nhiddens=3, maxsteps=200)}
