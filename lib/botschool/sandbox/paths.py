"""List what sandboxed code may read beside its own copy: Python, packages, system libraries."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path

SYSTEM = (
    "/usr", "/lib", "/lib32", "/lib64", "/bin", "/nix/store", "/etc/ld.so.cache", "/etc/localtime",
    "/etc/fonts", "/etc/passwd", "/etc/mime.types", "/etc/ssl/openssl.cnf", "/dev/null",
    "/dev/zero", "/dev/urandom", "/dev/random", "/proc/cpuinfo", "/proc/meminfo",
    "/sys/devices/system/cpu",
)  # fmt: skip
IMPORT_ROOT = Path(__file__).parents[2]
"""The folder that this package was imported from."""


def is_packages(path: str) -> bool:
    """Return whether an entry of sys.path holds installed packages."""
    return Path(path).name in ("site-packages", "dist-packages")


def interpreter_paths() -> list[Path]:
    """Return the folders of this interpreter and of its installed packages."""
    packages = [Path(path).resolve() for path in sys.path if path and is_packages(path)]
    return [*packages, Path(sys.prefix).resolve(), Path(sys.base_prefix).resolve()]


def system_paths() -> list[Path]:
    """Return the places of the operating system's libraries, fonts and devices."""
    return [Path(place).resolve() for place in SYSTEM]


def without(places: Iterable[Path], closed: Iterable[Path]) -> list[Path]:
    """Return the existing places, without the closed ones.

    A place that contains a closed one is replaced by its parts that contain none.
    """
    closed = list(closed)
    parts = {part for place in places for part in _open_parts(place, closed)}
    return sorted(part for part in parts if part.exists())


def _open_parts(place: Path, closed: list[Path]) -> list[Path]:
    inside = [each for each in closed if each.is_relative_to(place)]
    if not inside:
        return [place]
    if place in inside or not place.is_dir():
        return []
    return [
        part
        for child in place.iterdir()
        if not child.is_symlink()
        for part in _open_parts(child, inside)
    ]
