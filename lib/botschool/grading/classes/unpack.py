"""Zip files of submissions, unpacked within limits; nothing in them is trusted."""

from __future__ import annotations

import contextlib
import io
import stat
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

MAX_LEVELS = 3
"""Zip files within zip files."""
MAX_PARTS, MAX_NAME = 30, 240
"""Folders in the name of a file, and bytes of each of its parts."""
ARCHIVES = (".rar", ".7z", ".tar", ".tgz", ".gz", ".bz2", ".xz")
"""Suffixes of archives that are not unpacked."""


_TOO_MUCH = "holds too many or too large files"


@dataclass
class Room:
    """What may still be unpacked: bytes and files."""

    size: int
    files: int


def room_of_download() -> Room:
    """Return the limits of a whole class's zip file."""
    return Room(8 * 2**30, 200_000)


def room_of_submission() -> Room:
    """Return the limits of all zip files that a person handed in."""
    return Room(200 * 2**20, 10_000)


class Unpackable(Exception):
    """A zip file that stays packed; the message ends the sentence "NAME ...": the reason."""


def unpack(archive: Path | bytes, target: Path, room: Room) -> list[str]:
    """Unpack the regular files into the folder `target`; return names that are left out.

    Links, names that lead out of the folder, and names that no file can have are left out. Of two
    files with one name the second gets another. Raises Unpackable, after which `target` may hold
    a part.
    """
    left_out: list[str] = []
    numbers: dict[Path, int] = {}
    try:
        with zipfile.ZipFile(io.BytesIO(archive) if isinstance(archive, bytes) else archive) as zip:
            entries = zip.infolist()
            if len(entries) > 2 * room.files:
                raise Unpackable(_TOO_MUCH)
            for entry in entries:
                name = _readable(entry)
                if name.endswith("/"):
                    continue
                place = _inside(target, name, numbers)
                link = stat.S_ISLNK(entry.external_attr >> 16)
                if place is None or link or not _write(zip, entry, place, room):
                    left_out.append(name)
    except RuntimeError:
        raise Unpackable("needs a password") from None
    except (zipfile.BadZipFile, zlib.error, EOFError, ValueError, NotImplementedError):
        raise Unpackable("is damaged, or no zip file") from None
    return left_out


def _readable(entry: zipfile.ZipInfo) -> str:
    """Return the name, with the letters of systems that write UTF-8 without saying so."""
    name = entry.filename
    if not entry.flag_bits & 0x800:
        with contextlib.suppress(UnicodeError):
            name = name.encode("cp437").decode("utf-8")
    return name.replace("\\", "/")


def _inside(target: Path, name: str, numbers: dict[Path, int]) -> Path | None:
    """Return a new place for a file below a folder; None if the name leads out of it.

    numbers: of each name that was there twice, the last number it got.
    """
    parts = PurePosixPath(name).parts
    if not parts or len(parts) > MAX_PARTS or name.startswith("/") or ":" in parts[0]:
        return None
    for part in parts:
        try:
            too_long = len(part.encode()) > MAX_NAME
        except UnicodeError:
            return None
        if part == ".." or too_long or any(ord(letter) < 32 for letter in part):
            return None
    wanted = place = target.joinpath(*parts)
    while place.exists():
        number = numbers[wanted] = numbers.get(wanted, 1) + 1
        place = place.with_name(f"{PurePosixPath(name).stem} ({number}){place.suffix}")
    return place


def _write(zip: zipfile.ZipFile, entry: zipfile.ZipInfo, place: Path, room: Room) -> bool:
    """Unpack a file; return False where the name of one of its folders is that of a file."""
    room.files -= 1
    if room.files < 0 or entry.file_size > room.size:
        raise Unpackable(_TOO_MUCH)
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        return False
    with zip.open(entry) as source, place.open("xb") as file:
        while part := source.read(2**20):
            room.size -= len(part)
            if room.size < 0:
                raise Unpackable(_TOO_MUCH)
            file.write(part)
    return True
