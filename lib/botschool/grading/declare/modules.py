"""Find the modules of botschool that a submission may use, and the files of all others."""

from __future__ import annotations

import linecache
import os
import re
from functools import cache
from pathlib import Path
from typing import Any

from botschool import _core
from botschool.sandbox.paths import IMPORT_ROOT

OWN = "botschool"
_CORE = f"{OWN}._core"
CORE = Path(_core.__file__).resolve()
"""The compiled module; of a checkout it does not lie beside the others."""
_IMPORT = re.compile(
    rf"^[ \t]*(?:from ({OWN}[\w.]*) import (\([^)]*\)|[^\n]*)|import ({OWN}[\w.]*))", re.MULTILINE
)
_ENTRY = re.compile(rf"[\"']({OWN}(?:\.\w+)+):\w")
_FOR_TYPES = re.compile(r"^if TYPE_CHECKING:\n(?:[ \t].*\n|\n)*", re.MULTILINE)
_ALWAYS = (OWN, f"{OWN}.sandbox")


def imported(text: str) -> set[str]:
    """Return the modules of botschool that a text imports anywhere, also within functions."""
    found = set()
    for package, names, module in _IMPORT.findall(_FOR_TYPES.sub("", text)):
        found |= {module or package}
        found |= {f"{package}.{name}" for name in re.findall(r"\w+", names) if package}
    return {name for name in found if _file(name)}


def may_use(solution: str, grader: str) -> frozenset[str]:
    """Return the modules of botschool that a submission's process may use.

    These are the ones that the solution imports or names, without the part that runs alone, and
    those of the grader's drivers.
    """
    graded = solution.partition("\nif __name__ ==")[0]
    named = {name for name in re.findall(rf"\b{OWN}(?:\.\w+)+", graded) if _file(name)}
    drivers = imported("\n".join(line for line in grader.split("\n") if line[:1] in (" ", "\t")))
    helpers = {name for name in imported(grader) if name.startswith(f"{OWN}.grading.run.")}
    return frozenset({*imported(graded), *named, *drivers, *helpers} - {OWN})


def text_of(grader: Any) -> str:
    """Return the text of a grader, given as a module, also of a packed one."""
    own = (it for it in vars(grader).values() if getattr(it, "__module__", "") == grader.__name__)
    files = [function.__code__.co_filename for function in own if hasattr(function, "__code__")]
    return "".join(linecache.getlines(files[0])) if files else ""


@cache
def needed(modules: frozenset[str]) -> frozenset[str]:
    """Return these modules of botschool, and all that they import, at once or later."""
    found, waiting = {*_ALWAYS}, [*modules]
    while waiting:
        if (name := waiting.pop()) in found or not (file := _file(name)):
            continue
        found.add(name)
        waiting.append(name.rpartition(".")[0])
        if file.suffix == ".py":
            text = file.read_text(encoding="utf-8")
            waiting += [*imported(text), *_ENTRY.findall(text)]
            if "iter_modules(__path__)" in text:  # a package that imports all its modules
                waiting += [f"{name}.{each.stem}" for each in file.parent.glob("[a-z]*.py")]
    return frozenset(found)


@cache
def closed_files(open_modules: frozenset[str]) -> tuple[Path, ...]:
    """Return the files of botschool's other modules, with Python's copies; folders where all are.

    open_modules: as `needed` returns them.
    """
    closed: list[Path] = []
    for folder, inner, files in os.walk(IMPORT_ROOT / OWN):
        place = Path(folder).resolve()
        package = ".".join(Path(folder).relative_to(IMPORT_ROOT).parts)
        inner[:] = [name for name in inner if name not in ("__pycache__", "sandbox")]
        closed += [place / name for name in inner if f"{package}.{name}" not in open_modules]
        inner[:] = [name for name in inner if f"{package}.{name}" in open_modules]
        modules = {n.partition(".")[0] for n in files if n.endswith((".py", ".so"))}
        shut = {name for name in modules - {"__init__"} if f"{package}.{name}" not in open_modules}
        closed += [place / name for name in files if name.partition(".")[0] in shut]
        copies = place / "__pycache__"
        if shut and copies.is_dir():
            closed += [each for each in copies.iterdir() if each.name.partition(".")[0] in shut]
    return tuple(closed)


def _file(name: str) -> Path | None:
    """Return the file of a module of botschool; None if there is no such module."""
    *packages, last = name.split(".")
    return CORE if name == _CORE else _modules_in(IMPORT_ROOT.joinpath(*packages)).get(last)


@cache
def _modules_in(folder: Path) -> dict[str, Path]:
    found = {}
    for place in folder.iterdir() if folder.is_dir() else ():
        if place.suffix in (".py", ".so"):
            found[place.name.partition(".")[0]] = place
        elif (place / "__init__.py").is_file():
            found[place.name] = place / "__init__.py"
    return found
