"""Compare the files that an evaluation runs on: here and on a worker.

These are botschool's Python files, the C++ sources of its module (compiled files differ between
machines that compute the same), and the files of the modules that an experiment names: a whole
package, or a module and what it uses of its own folder. That is the modules that it imports, files
that were opened while the environment was made and tried (`noticing`), and files that a text in
these modules names.
"""

from __future__ import annotations

import ast
import os
import re
import sys
import sysconfig
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import cache
from hashlib import blake2b
from pathlib import Path
from typing import Any

import botschool
from botschool import _core
from botschool.problems import Problem

CORE = "botschool._core"
COMPILED = {".pyc", ".pyo", ".so", ".pyd", ".dll", ".dylib", ".o", ".a", ".lib"}
"""Endings of files that may differ between machines."""
TOLD = 1_000
"""Largest number of differing files that a worker reports."""

NAME = re.compile(r"[\w .-][\w ./-]{0,200}")
"""Texts that may be names of files beside a module."""

_opened: set[str] = set()
_noticing = False

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


@contextmanager
def noticing() -> Iterator[None]:
    """Remember all files that are opened for reading during the block, for `manifest`."""
    global _noticing
    _listen()
    _noticing = True
    try:
        yield
    finally:
        _noticing = False


@cache
def _listen() -> None:
    """Begin to notice opened files; Python has no way to end it, so it begins once."""

    def notice(event: str, details: tuple[Any, ...]) -> None:
        if not _noticing or event != "open" or not isinstance(details[0], (str, bytes)):
            return
        if not details[2] & (os.O_WRONLY | os.O_RDWR):
            _opened.add(os.path.realpath(os.fsdecode(details[0])))

    sys.addaudithook(notice)


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
    modules = {place, *(file for file in own if place.parent in file.parents)}
    return sorted(modules | _data(place.parent, modules))


def _data(folder: Path, modules: set[Path]) -> set[Path]:
    """Return the files of a folder that were opened, or that a text of its modules names."""
    real = folder.resolve()
    opened = (Path(file) for file in _opened)
    found = {folder / file.relative_to(real) for file in opened if real in file.parents}
    for module in modules:
        tree = ast.parse(module.read_bytes()) if module.suffix == ".py" else ast.Module([], [])
        texts = (str(node.value) for node in ast.walk(tree) if isinstance(node, ast.Constant))
        found |= {folder / text for text in texts if NAME.fullmatch(text)}
    return {
        file
        for file in found
        if file.is_file() and real in file.resolve().parents and not _installed(file)
    }


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
