"""Compare the files that an evaluation runs on: here and on a worker.

These are botschool's Python files, the C++ sources of its module (compiled files differ between
machines that compute the same), and the files of the modules that an experiment names: a whole
package, or a module and the modules that it imports from its own folder.
"""

from __future__ import annotations

import sys
import sysconfig
from collections.abc import Iterable
from functools import cache
from hashlib import blake2b
from pathlib import Path

import botschool
from botschool import _core
from botschool.problems import Problem

CORE = "botschool._core"
COMPILED = {".pyc", ".pyo", ".so", ".pyd", ".dll", ".dylib", ".o", ".a", ".lib"}
"""Endings of files that may differ between machines."""
TOLD = 1_000
"""Largest number of differing files that a worker reports."""

Manifest = dict[str, dict[str, bytes]]
"""Module -> path from the module's folder -> digest of the file."""


def manifest(problem: Problem) -> Manifest:
    """Return the digests of all files that episodes of this problem run on."""
    root = Path(botschool.__file__).parent
    found = {"botschool": _digests(root.parent, root.rglob("*.py")), CORE: _sources()}
    for name in sorted({module.partition(".")[0] for module in problem.modules()} - {"botschool"}):
        if (place := _place(name)) is not None:
            found[name] = _digests(place.parent, _files(place))
    return found


def differing(asked: Manifest) -> list[str]:
    """Return the names of files in a manifest that are missing here or differ."""
    found = []
    for module, files in asked.items():
        if module == CORE:
            own = _sources()
            found += [f"compiled {name}" for name in files if own.get(name) != files[name]]
            continue
        place = _place(module)
        for name, digest in files.items():
            if place is None or _digest(place.parent / name) != digest:
                found.append(name)
    return found[:TOLD]


def _place(module: str) -> Path | None:
    """Return the folder of a package, or the file of a module; None if it has neither."""
    found = sys.modules.get(module)
    if file := getattr(found, "__file__", None):
        return Path(file).parent if Path(file).stem == "__init__" else Path(file)
    paths = list(getattr(found, "__path__", []))
    return Path(paths[0]) if paths else None


def _files(place: Path) -> list[Path]:
    if place.is_dir():
        return sorted(p for p in place.rglob("*") if p.is_file() and p.suffix not in COMPILED)
    beside = (getattr(module, "__file__", None) for module in list(sys.modules.values()))
    own = {Path(file) for file in beside if file and not _installed(Path(file))}
    return sorted({place, *(file for file in own if place.parent in file.parents)})


def _installed(file: Path) -> bool:
    """Return whether a file belongs to an installed package, the standard library or botschool."""
    library = (sysconfig.get_path("stdlib"), Path(botschool.__file__).parent)
    packages = {"site-packages", "dist-packages"} & set(file.parts)
    compiled = file.suffix in COMPILED
    return compiled or bool(packages) or any(Path(each) in file.parents for each in library)


def _digests(folder: Path, files: Iterable[Path]) -> dict[str, bytes]:
    return {file.relative_to(folder).as_posix(): _digest(file) for file in files}


@cache
def _digest(file: Path) -> bytes:
    """Return a file's digest at the first request of this process, because imported code stays."""
    try:
        return blake2b(file.read_bytes(), digest_size=12).digest()
    except OSError:
        return b""


def _sources() -> dict[str, bytes]:
    lines = (line.split() for line in _core.sources.splitlines())
    return {name: bytes.fromhex(digest) for digest, name in lines}
