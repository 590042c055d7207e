"""What the figures of exercise 8 need: the core's steps of OpenAI-ES."""

from typing import Any

CORE = "classic"


def data() -> dict[str, Any]:
    """Return nothing: landscapes are formulas of the page."""
    return {}
