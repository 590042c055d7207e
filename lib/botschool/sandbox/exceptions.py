"""Describe an exception as plain data, with its place in the untrusted files."""

from __future__ import annotations

import builtins
import difflib
import inspect
import pkgutil
import re
import sys
import traceback
from collections.abc import Iterable
from pathlib import Path
from types import FrameType
from typing import Any

MAX_TEXT = 500
MAX_NAMES, MAX_NAME = 5000, 60
"""Number of names to compare; characters of each name."""
ALIKE = 0.7
"""Smallest similarity of two names, as difflib's ratio."""
_STARTERS = ("/multiprocessing/", "/subprocess.py", "/concurrent/futures/process.py")
"""Modules that start processes."""
_FORKS = {"fork", "forkpty", "posix_spawn", "posix_spawnp", "execv", "execve", "execvp"}
_WRONG_CALL = re.compile(r"(?:\w+\.)*(\w+)\(\) (?:missing|takes|got an unexpected|got multiple)")


class Missing(Exception):
    """The module has no function of this name."""

    def __init__(self, name: str, module: Any) -> None:
        super().__init__(name)
        self.name, self.module = name, module


def explain(error: BaseException, file: Path, module: Any = None) -> dict[str, Any]:
    """Return an exception as plain data.

    error, text: its type and message. file, line: the innermost place in the untrusted files (the
    file's name in its folder), or None. column: of a syntax error. near: an existing name that
    resembles the unknown one. call: the function's signature, if the grader's call does not fit it.
    process: whether the confinement has refused to start a process.
    A missing function is an error "Missing", and a call that does not fit a "Signature".
    """
    folder = file.parent
    frames = [frame for frame, _ in traceback.walk_tb(error.__traceback__)]
    lines = [line for _, line in traceback.walk_tb(error.__traceback__)]
    places = [
        (name, line)
        for frame, line in zip(frames, lines, strict=True)
        if (name := _inside(frame.f_code.co_filename, folder))
    ]
    name, line = places[-1] if places else (None, None)
    told = {"error": type(error).__name__, "text": str(error)[:MAX_TEXT], "file": name,
            "line": line, "column": None, "near": None, "call": None,
            "process": _started_process(error)}  # fmt: skip
    if isinstance(error, SyntaxError) and (own := _inside(str(error.filename), folder)):
        text = str(error.msg)[:MAX_TEXT]
        return told | {"text": text, "file": own, "line": error.lineno, "column": error.offset}
    if missing := _missing(error, module if not places else None):
        near = nearest(missing, _public(module))
        return told | {"error": "Missing", "text": missing, "near": near}
    if not places and isinstance(error, TypeError) and (found := _WRONG_CALL.match(str(error))):
        function = getattr(module, found[1], None)
        if function is not None:
            call = f"{found[1]}{inspect.signature(function)}"[:MAX_TEXT]
            return told | {"error": "Signature", "call": call}
    return told | {"near": _near(error, frames[-1] if frames else None)}


def _started_process(error: BaseException | None) -> bool:
    """Return whether an exception, or one behind it, says that no process may be started."""
    for _ in range(10):
        if isinstance(error, PermissionError):
            codes = [frame.f_code for frame, _ in traceback.walk_tb(error.__traceback__)]
            if any(part in code.co_filename for code in codes for part in _STARTERS):
                return True
            return bool(codes) and not _FORKS.isdisjoint(codes[-1].co_names)
        error = error and (error.__cause__ or error.__context__)
    return False


def _inside(filename: str, folder: Path) -> str | None:
    """Return the name of a file relative to the folder; None if it lies elsewhere."""
    top = f"{folder}/"
    return filename[len(top) :] if filename.startswith(top) else None


def _missing(error: BaseException, module: Any) -> str | None:
    """Return the name of a function that the module lacks; None for any other error."""
    if isinstance(error, Missing):
        return error.name
    if isinstance(error, AttributeError) and module is not None and error.obj is module:
        return error.name
    return None


def _public(module: Any) -> list[str]:
    return [name for name, value in vars(module).items() if callable(value)] if module else []


def _near(error: BaseException, frame: FrameType | None) -> str | None:
    if isinstance(error, NameError) and error.name and frame is not None:
        return nearest(error.name, [*frame.f_locals, *frame.f_globals, *vars(builtins)])
    if isinstance(error, AttributeError) and error.name:
        return nearest(error.name, dir(error.obj))
    if isinstance(error, ModuleNotFoundError) and error.name:
        loaded = {name.partition(".")[0] for name in sys.modules} - sys.stdlib_module_names
        others = {each.name for each in pkgutil.iter_modules()} | sys.stdlib_module_names
        return nearest(error.name, sorted(loaded)) or nearest(error.name, sorted(others))
    if isinstance(error, ImportError) and error.name in sys.modules and error.args:
        found = re.match(r"cannot import name '(\w+)'", str(error))
        return nearest(found[1], dir(sys.modules[error.name])) if found else None
    return None


def nearest(name: str, names: Iterable[str]) -> str | None:
    """Return the name that most resembles another one; None if none does."""
    known = [each for each in names if len(each) <= MAX_NAME and each != name][:MAX_NAMES]
    if len(name) > MAX_NAME:
        return None
    if alike := [each for each in known if _plain(each) == _plain(name)]:
        return alike[0]
    found = difflib.get_close_matches(name, known, 1, ALIKE)
    if not found:  # rank for rank_individuals, or the reverse
        found = [each for each in known if min(len(each), len(name)) > 3 and (
            each.startswith(name) or name.startswith(each))]  # fmt: skip
    return found[0] if found else None


def _plain(name: str) -> str:
    return name.replace("_", "").lower()
