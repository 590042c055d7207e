"""What every kind of files is: valid bytes, damage, and what reads it."""

from __future__ import annotations

import io
import random
import zipfile
from pathlib import Path

from fuzz.mutate import damaged


class Kind:
    """A kind of files."""

    suffix = ""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def path(self) -> Path:
        """Where the damaged file lies."""
        return self.folder / f"damaged{self.suffix}"

    def valid(self) -> list[bytes]:
        raise NotImplementedError

    def read(self, path: Path) -> None:
        raise NotImplementedError

    def damage(self, valid: list[bytes], chance: random.Random) -> bytes:
        """Return a damaged file; half of those that are archives have a damaged member instead."""
        data = chance.choice(valid)
        if not zipfile.is_zipfile(io.BytesIO(data)) or chance.random() < 0.3:
            return damaged(valid, chance)
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            members = {name: archive.read(name) for name in archive.namelist()}
        name = chance.choice(list(members))
        others = [members[name], *(m for n, m in members.items() if n.endswith(name[-4:]))]
        members[name] = damaged(others, chance)
        if chance.random() < 0.1:
            del members[chance.choice(list(members))]
        return archive_of(members)


def archive_of(members: dict[str, bytes]) -> bytes:
    """Return a zip archive, the same for the same members."""
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        for name, content in members.items():
            archive.writestr(zipfile.ZipInfo(name), content)
    return out.getvalue()
