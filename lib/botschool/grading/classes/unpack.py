"""Unpack zip and tar files of submissions within limits, and trust nothing in them."""

from __future__ import annotations

import bz2
import contextlib
import gzip
import io
import lzma
import mmap
import os
import re
import stat
import tarfile
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import islice
from pathlib import Path, PurePosixPath
from typing import IO, Any

from botschool.grading.run.confined import SHORTAGES

MAX_LEVELS = 5
"""Levels of zip files within zip files."""
MAX_PARTS, MAX_NAME = 30, 240
"""Folders in the name of a file, and bytes of each of its parts."""
ARCHIVES = (".zip", ".tar", ".tgz", ".tbz2", ".tbz", ".txz", ".gz", ".bz2", ".xz")
"""Suffixes of archives to unpack."""
PACKED = (".rar", ".7z", ".zst")
"""Suffixes of archives that stay packed."""
_COMPRESSED: tuple[tuple[bytes, Callable[[IO[bytes]], Any]], ...] = (
    (b"\x1f\x8b", gzip.open),
    (b"BZh", bz2.open),
    (b"\xfd7zXZ", lzma.open),
)


_ENTRY = re.compile(b"PK\x01\x02")
"""The beginning of each entry in a zip file's list."""
_TOO_MUCH = "holds too many or too large files"


@dataclass
class Room:
    """Room for further files: bytes and number."""

    size: int
    files: int


def room_of_download() -> Room:
    """Return the limits of a whole class's zip file."""
    return Room(8 * 2**30, 200_000)


def room_of_submission() -> Room:
    """Return the limits of all zip files that a person handed in."""
    return Room(200 * 2**20, 10_000)


class Unpackable(Exception):
    """The zip file stays packed; the message ends the sentence "NAME ...": the reason."""


@dataclass(frozen=True)
class _Member:
    """A file or folder in an archive."""

    name: str
    size: int
    is_folder: bool
    is_file: bool
    open: Callable[[], Any]


def unpack(archive: Path | bytes, target: Path, room: Room, name: str = "") -> list[str]:
    """Unpack regular files and folders into the folder `target`; return names that are left out.

    name: of the archive; a file that is only compressed gets it, without its last suffix.

    Links are left out, but their folder is there. Names that lead elsewhere lose what leads there:
    drives, roots and "..". Of two files with one name the second gets another.
    Raises Unpackable, after which `target` may hold a part.
    """
    left_out: list[str] = []
    numbers: dict[Path, int] = {}
    if holds_more(archive, 2 * room.files):
        raise Unpackable(_TOO_MUCH)
    try:
        for member in _members(archive, room, name):
            room.files -= 1
            if room.files < 0:
                raise Unpackable(_TOO_MUCH)
            place = _inside(target, member, numbers)
            if place is None or not _write(member, place, room):
                left_out.append(member.name)
                _keep_folder(target, member)
    except Unpackable:
        raise
    except Exception as error:
        if isinstance(error, OSError) and error.errno in SHORTAGES:
            raise
        needs = "password" in str(error) and type(error) is RuntimeError
        reason = "needs a password" if needs else "is damaged, or no zip file"
        raise Unpackable(reason) from None
    return left_out


def holds_more(archive: Path | bytes, most: int) -> bool:
    """Return whether a zip file lists more entries, without reading the list. Raises OSError."""
    with contextlib.ExitStack() as stack:
        content: Any = archive
        if isinstance(archive, Path):
            file = stack.enter_context(archive.open("rb"))
            if not os.fstat(file.fileno()).st_size:
                return False
            content = stack.enter_context(mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ))
        return any(True for _ in islice(_ENTRY.finditer(content), most, None))


def _members(archive: Path | bytes, room: Room, name: str) -> Iterator[_Member]:
    if isinstance(archive, bytes):
        content = _decompressed(archive, room)
        if content[257:262] == b"ustar":
            yield from _of_tar(content)
            return
        if content is not archive:
            file = io.BytesIO(content)
            yield _Member(name.rpartition(".")[0], len(content), False, True, lambda: file)
            return
    with zipfile.ZipFile(io.BytesIO(archive) if isinstance(archive, bytes) else archive) as zip:
        for entry in zip.infolist():
            shown, is_link = _readable(entry), stat.S_ISLNK(entry.external_attr >> 16)
            folder = shown.endswith("/")
            yield _Member(shown, entry.file_size, folder, not is_link, partial(zip.open, entry))


def _decompressed(content: bytes, room: Room) -> bytes:
    for sign, opener in _COMPRESSED:
        if content.startswith(sign):
            with opener(io.BytesIO(content)) as file:
                plain = file.read(room.size + 1)
            if len(plain) > room.size:
                raise Unpackable(_TOO_MUCH)
            return plain
    return content


def _of_tar(archive: bytes) -> Iterator[_Member]:
    with tarfile.open(fileobj=io.BytesIO(archive), mode="r:") as tar:
        for info in tar:
            yield _Member(
                info.name.encode("utf-8", "surrogateescape").decode("utf-8", "replace"),
                info.size,
                info.isdir(),
                info.isreg() and not info.issparse(),
                partial(tar.extractfile, info),
            )


def _readable(entry: zipfile.ZipInfo) -> str:
    """Return the name in Unicode; some systems write UTF-8 without saying so."""
    name = entry.filename
    if not entry.flag_bits & 0x800:
        with contextlib.suppress(UnicodeError):
            name = name.encode("cp437").decode("utf-8")
    return name.replace("\\", "/")


def _inside(target: Path, member: _Member, numbers: dict[Path, int]) -> Path | None:
    """Return a new place for a file below a folder; None if no place is possible.

    numbers: the last number of each name that occurred twice.
    """
    parts = _parts(member)
    if not (member.is_file or member.is_folder):
        return None
    if not parts:
        return target if member.is_folder else None
    wanted = place = target.joinpath(*parts)
    if member.is_folder:
        return place
    while place.exists():
        number = numbers[wanted] = numbers.get(wanted, 1) + 1
        place = place.with_name(f"{wanted.stem} ({number}){place.suffix}")
    return place


def _parts(member: _Member) -> list[str]:
    """Return the folders and the name of a member; of too many folders, only the first ones."""
    name = re.sub(r"^[A-Za-z]:", "", member.name)
    parts = [_short(part) for part in PurePosixPath(name).parts if part not in ("/", "//", "..")]
    return parts if len(parts) <= MAX_PARTS else [*parts[: MAX_PARTS - 1], parts[-1]]


def _keep_folder(target: Path, member: _Member) -> None:
    """Make the folder of a file that is left out, so that its owner does not vanish."""
    with contextlib.suppress(OSError):
        target.joinpath(*_parts(member)[:-1]).mkdir(parents=True, exist_ok=True)


def _short(part: str) -> str:
    """Return a part of a name that every file system takes; its end, with the suffix, stays."""
    part = re.sub(r"[\x00-\x1f\x7f]", "_", part.encode("utf-8", "replace").decode())
    while len(part.encode()) > MAX_NAME:
        part = part[len(part.encode()) - MAX_NAME :]
    return part


def _write(member: _Member, place: Path, room: Room) -> bool:
    """Unpack a file; return False where the name of one of its folders is that of a file."""
    if member.is_file and member.size > room.size:
        raise Unpackable(_TOO_MUCH)
    try:
        (place if member.is_folder else place.parent).mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):
        return False
    if member.is_folder:
        return True
    with member.open() as source, place.open("xb") as file:
        while part := source.read(2**20):
            room.size -= len(part)
            if room.size < 0:
                raise Unpackable(_TOO_MUCH)
            file.write(part)
    return True
