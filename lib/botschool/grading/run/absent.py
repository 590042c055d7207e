"""Replace PyBullet's modules by stand-ins if PyBullet is not installed.

A submission that imports PyBullet then loads, and tasks that simulate nothing can be graded.
Every function of a stand-in raises ModuleNotFoundError.
"""

from __future__ import annotations

import sys
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from types import ModuleType
from typing import Any

NAMES = ("pybullet", "pybullet_data")


class Absent(ModuleType):
    """A module in which every name is a function that raises."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        if name == "getDataPath":  # of pybullet_data, called during the import of a submission
            return lambda: ""
        return self._raises(name)

    def _raises(self, name: str) -> Any:
        def absent(*arguments: Any, **options: Any) -> None:
            raise ModuleNotFoundError(f"{self.__name__}.{name}: PyBullet is not installed here")

        return absent


def stand_in() -> None:
    """Put the stand-ins among the imported modules."""
    for name in NAMES:
        if name not in sys.modules and find_spec(name) is None:
            sys.modules[name] = Absent(name)
            sys.modules[name].__spec__ = ModuleSpec(name, None)


stand_in()
