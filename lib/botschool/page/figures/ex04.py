"""What the figures of exercise 4 need."""

from typing import Any

from botschool.page.exercise import robot

CORE = "classic"


def data() -> dict[str, Any]:
    """Return Acrobot, with the settings of its experiment."""
    return {"acrobot": robot("acrobot.ini")}
