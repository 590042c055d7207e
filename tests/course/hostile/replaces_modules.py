"""Puts modules of its own beside its file and in the interpreter."""

import sys
import types
from pathlib import Path


def hostile(*arguments, **options):
    for name in ("numpy", "json", "botschool", "gymnasium", "sitecustomize", "usercustomize"):
        Path(f"{name}.py").write_text("raise SystemExit(0)\n")
        Path("..", f"{name}.py").write_text("raise SystemExit(0)\n")
    sys.modules["json"] = sys.modules["numpy"] = types.ModuleType("fake")
    return 0
