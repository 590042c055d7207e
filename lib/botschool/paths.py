"""Find the course, the files that come with botschool, and modules in the current folder."""

from __future__ import annotations

import importlib
import importlib.util
import multiprocessing
import os
import re
import sys
from functools import cache
from pathlib import Path
from types import ModuleType

from botschool.errors import BotschoolError, said

MATERIAL = "material"
"""Folder of the installed package with a copy of the course, as `botschool course` makes it."""

HINTS = "<!-- hints:"
"""With this an exercise's text begins the comment that holds its hints."""


def course_root() -> Path:
    """Return the folder that holds exercises/: the current one or the nearest one above it.

    BOTSCHOOL_COURSE names another place to start from. Raises BotschoolError if there is none.
    """
    given = os.environ.get("BOTSCHOOL_COURSE")
    here = Path(given) if given else Path.cwd()
    for folder in (here, *here.resolve().parents):
        if (folder / "exercises").is_dir():
            return folder
    raise BotschoolError(
        "There is no course here: go to the folder that holds exercises/, name it in "
        "BOTSCHOOL_COURSE, or make one with 'botschool course FOLDER'."
    )


def uses_make(root: Path) -> bool:
    """Return whether `make` sets up this course; else botschool is installed, as from a wheel."""
    sets_up = (root / "lib").is_dir() or (root / "wheels").is_dir()
    return sets_up and (root / "Makefile").is_file()


def for_make(root: Path) -> str:
    """Return how to name a submission for `make`, to end a sentence about --submission with."""
    return ", or SUBMISSION=FOLDER for make" if uses_make(root) else ""


def material() -> Path:
    """Return the folder with the data/ and exercises/ that come with botschool.

    It is part of the installed package, or else the checkout that holds the package.
    """
    package = Path(__file__).resolve().parent
    installed = package / MATERIAL
    return installed if installed.is_dir() else package.parents[1]


def own_file(name: str | os.PathLike[str], folder: str = "") -> Path:
    """Return the file with this name, or botschool's own file in data/FOLDER.

    name: as the user wrote it, such as acrobot.ini or data/experiments/acrobot.ini. An existing
    file comes first. Names as in the chapter and its library are understood, too: ErPredprey.ini is
    predprey.ini, HopperBulletEnv-v5.ini is hopper.ini.
    """
    path = Path(name)
    if not path.exists() and not path.is_absolute() and ".." not in path.parts:
        ours = material() / "data" / folder
        for place in (ours / path, material() / path, ours / f"{_plain(path.stem)}{path.suffix}"):
            if place.is_file():
                print(f"{name} is the one that comes with botschool: {place}", file=sys.stderr)
                return place
    return path


def _plain(name: str) -> str:
    """Return the name of our file for a problem's name in the chapter's library."""
    return re.sub(r"^(Er|env)(?=[A-Z])|(BulletEnv(-v\d+)?|Custom)$", "", name).lower()


def look_here(module: str) -> None:
    """Let Python import a module from the current folder; say so if it lies there."""
    if os.getcwd() not in sys.path:
        sys.path.insert(0, os.getcwd())
    _say_if_here(module)


def import_here(module: str, purpose: str) -> ModuleType:
    """Return the module, which is installed or lies in the current folder.

    purpose: what the caller wants of it, such as "take the wrapper Doubled from". Raises
    BotschoolError.
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
    """Print a line on stderr, once, if a module lies in the current folder."""
    if multiprocessing.parent_process() is not None:
        return
    try:
        spec = importlib.util.find_spec(module.partition(".")[0])
    except (ImportError, ValueError):
        return
    if spec is None:
        return
    files = [spec.origin] if spec.has_location else []  # Python's own may have none
    for place in filter(None, [*files, *(spec.submodule_search_locations or ())]):
        if Path(place).parent.resolve() == Path.cwd().resolve():
            print(f"{module} is taken from the present folder: {place}", file=sys.stderr)
            return
