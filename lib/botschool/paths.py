"""Where the course is, and modules in the present folder."""

from __future__ import annotations

import importlib
import importlib.util
import multiprocessing
import os
import sys
from functools import cache
from pathlib import Path
from types import ModuleType

from botschool.errors import BotschoolError, said


def course_root() -> Path:
    """Return the folder that holds exercises/; looked for from the present folder upwards."""
    given = os.environ.get("BOTSCHOOL_COURSE")
    here = Path(given) if given else Path.cwd()
    for folder in (here, *here.resolve().parents):
        if (folder / "exercises").is_dir():
            return folder
    raise BotschoolError(
        "There is no course here: go to the folder that holds exercises/, or name it in "
        "BOTSCHOOL_COURSE."
    )


def look_here(module: str) -> None:
    """Let a module be imported from the present folder, and say so if it is there."""
    if os.getcwd() not in sys.path:
        sys.path.insert(0, os.getcwd())
    _say_if_here(module)


def import_here(module: str, purpose: str) -> ModuleType:
    """Return the module, installed or in the present folder.

    purpose: what is wanted of it, as "take the wrapper Doubled from". Raises BotschoolError.
    """
    look_here(module)
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name and not f"{module}.".startswith(f"{error.name}."):
            reason = f"it needs {error.name}, which is not installed"
        else:
            reason = "is its package installed, or are you in its folder"
        raise BotschoolError(f"There is no module {module} to {purpose}; {reason}?") from None
    except Exception as error:
        raise BotschoolError(
            f"The module {module}, to {purpose}, cannot be imported "
            f"({type(error).__name__}: {said(error)}): mend it."
        ) from error


@cache
def _say_if_here(module: str) -> None:
    """A line on stderr, once, when a module is taken from the present folder."""
    if multiprocessing.parent_process() is not None:
        return
    try:
        spec = importlib.util.find_spec(module.partition(".")[0])
    except (ImportError, ValueError):
        return
    places = [] if spec is None else [spec.origin, *(spec.submodule_search_locations or ())]
    for place in filter(None, places):
        if Path(place).parent.resolve() == Path.cwd().resolve():
            print(f"{module} is taken from the present folder: {place}", file=sys.stderr)
            return
