"""What the figures of exercise 6 need."""

from typing import Any

from botschool.page.exercise import robot

CORE = "discrim"


def data() -> dict[str, Any]:
    """Return the evolved Khepera."""
    return {"khepera": robot("discrim.ini", "discrim.npy")}
