"""Import modules by their old names, which files of users may still have."""

from __future__ import annotations

import sys
from importlib import import_module
from importlib.machinery import ModuleSpec

TYPE_CHECKING = False  # typing's own costs 5 ms in which Ctrl-C ends in a traceback
if TYPE_CHECKING:
    from types import ModuleType
    from typing import Any

MOVED = {
    **{
        f"course_{n}": f"course.{n}"
        for n in ["coevolution", "foraging", "locomotion", "rl", "robots"]
    },
    **{name: f"arenas.{name}" for name in ("plan", "robots", "samples", "section", "things")},
    **{name: f"policies.{name}" for name in ("hyperparameters", "pair", "policy")},
}
"""Old name -> new name, both below botschool."""


class Finder:
    """Imports an old name as a module with the contents of the new one."""

    def find_spec(self, name: str, path: Any = None, target: Any = None) -> ModuleSpec | None:
        """Return a spec for an old name; Python asks here last."""
        package, _, old = name.partition(".")
        loader: Any = self
        return ModuleSpec(name, loader) if package == "botschool" and old in MOVED else None

    def create_module(self, spec: ModuleSpec) -> None:
        """Let Python make an empty module."""

    def exec_module(self, module: ModuleType) -> None:
        """Fill the module with the contents of the new one."""
        new = import_module(f"botschool.{MOVED[module.__name__.partition('.')[2]]}")
        vars(module).update({k: v for k, v in vars(new).items() if not k.startswith("__")})


finder: Any = Finder()
sys.meta_path.append(finder)
