"""List and copy the experiments and robots that come with botschool."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.inifile import nearest
from botschool.paths import material

ROBOTS = "genotypes"
KINDS = {"experiments": ".ini", ROBOTS: ".npy"}
"""Folder of data/ -> ending of its files' names."""


def examples(kind: str) -> dict[str, Path]:
    """Return name -> file or folder for a kind of KINDS."""
    folder = material() / "data" / kind
    found = sorted(folder.iterdir()) if folder.is_dir() else []
    return {path.name: path for path in found if path.suffix == KINDS[kind] or path.is_dir()}


def purpose(experiment: Path) -> str:
    """Return the first sentence of an experiment file's comment."""
    lines = []
    for line in experiment.read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.removeprefix("#").strip())
    text = " ".join(lines)
    return (re.match(r".{15,}?(?=[.:] |$)", text) or re.match("", text))[0].rstrip(".")


def copy(names: list[str], folder: Path) -> Iterator[Path]:
    """Copy examples into a folder; yield each new path. Raises BotschoolError.

    Existing files are never overwritten.
    """
    known = {name: path for kind in KINDS for name, path in examples(kind).items()}
    for name in names:
        if name not in known:
            raise BotschoolError(f"There is no example {name}; {nearest(name, known)}.")
        if (folder / name).exists():
            raise BotschoolError(f"{folder / name} is there already: move it away first.")
    for name in names:
        try:
            folder.mkdir(parents=True, exist_ok=True)
            whole = shutil.copytree if known[name].is_dir() else shutil.copyfile
            whole(known[name], folder / name)
        except OSError as error:
            raise BotschoolError(f"{folder / name} cannot be written ({error.strerror}).") from None
        yield folder / name
