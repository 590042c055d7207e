"""Which packages of an extra of pyproject.toml are not installed."""

from __future__ import annotations

import re
from importlib import metadata


def missing_packages(extras: tuple[str, ...]) -> list[str]:
    """The names of those packages, as installed botschool's own metadata lists them."""
    try:
        requirements = metadata.requires("botschool") or []
    except metadata.PackageNotFoundError:
        return []
    wanted = []
    for requirement in requirements:
        text, _, marker = requirement.partition(";")
        if any(re.search(f"extra == ['\"]{re.escape(extra)}['\"]", marker) for extra in extras):
            wanted.append(re.match(r"[\w.-]+", text)[0])
    return [name for name in wanted if not _installed(name)]


def _installed(name: str) -> bool:
    try:
        metadata.distribution(name)
    except metadata.PackageNotFoundError:
        return False
    return True
