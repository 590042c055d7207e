"""botschool: training robots in simulation by evolution and by reinforcement learning.

`evolve`, `train`, `problem` and `load` are all that a program needs (docs/python.md).
"""

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

_PLACES = {
    "evolve": "interface.evolving",
    "load": "interface.loading",
    "problem": "interface.problem",
    "train": "interface.training",
    "BotschoolError": "errors",
}
"""Names that a program imports from here, and their modules, which are loaded when first used."""

__all__ = ["BotschoolError", "evolve", "load", "problem", "train"]


def __getattr__(name: str) -> Any:
    if name not in _PLACES:
        raise AttributeError(f"module 'botschool' has no attribute '{name}'")
    return getattr(import_module(f"botschool.{_PLACES[name]}"), name)


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
