"""Tell by its first bytes what a file is, and unpack archives within limits, trusting nothing."""

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
from typing import IO, Any, NamedTuple

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


DOWNLOAD, SUBMISSION = (8 * 2**30, 200_000), (200 * 2**20, 10_000)
"""The room for a whole class's zip file, and for all zip files that a person handed in."""


class Unpackable(Exception):
    """The zip file stays packed; the message ends the sentence "NAME ...": the reason."""


class _Member(NamedTuple):
    """A file, a folder, or anything else in an archive."""

    name: str
    size: int
    kind: str
    """"file", "folder", or "" for a link or a device."""
    open: Callable[[], Any]


def unpack(archive: Path | bytes, target: Path, room: Room, name: str = "") -> list[str]:
    """Unpack regular files and folders into the folder `target`; return names that are left out.

    name: of the archive; a file that is only compressed gets it, without its last suffix.

    Links are left out, but their folder is there, so that nobody vanishes. Names that lead
    elsewhere lose what leads there: drives, roots and "..". Of two files with one name the second
    gets another. Raises Unpackable, after which `target` may hold a part.
    """
    left_out, numbers = list[str](), dict[Path, int]()
    if holds_more(archive, 2 * room.files):
        raise Unpackable(_TOO_MUCH)
    try:
        for member in _members(archive, room, name):
            room.files -= 1
            if room.files < 0:
                raise Unpackable(_TOO_MUCH)
            left_out += [] if _write(member, target, room, numbers) else [member.name]
    except Unpackable:
        raise
    except Exception as error:
        if isinstance(error, OSError) and error.errno in SHORTAGES:
            raise
        reason = "is damaged, or no zip file"
        if "password" in str(error) and type(error) is RuntimeError:
            reason = "needs a password"
        elif isinstance(error, NotImplementedError):  # Deflate64, which Windows uses above 2 GB
            reason = (
                "is packed by a method that Python cannot unpack (Windows takes it for large "
                "files): unpack it, or hand in a smaller zip file"
            )
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
    content = _decompressed(archive, room) if isinstance(archive, bytes) else b""
    file = io.BytesIO(content)
    if content[257:262] == b"ustar":
        with tarfile.open(fileobj=file, mode="r:") as tar:
            for info in tar:
                shown = info.name.encode("utf-8", "surrogateescape").decode("utf-8", "replace")
                is_file = info.isreg() and not info.issparse()
                kind = "folder" if info.isdir() else "file" if is_file else ""
                yield _Member(shown, info.size, kind, partial(tar.extractfile, info))
    elif content and content is not archive:
        yield _Member(name.rpartition(".")[0], len(content), "file", lambda: file)
    else:
        with zipfile.ZipFile(file if isinstance(archive, bytes) else archive) as zip:
            for entry in zip.infolist():
                shown, is_link = _readable(entry), stat.S_ISLNK(entry.external_attr >> 16)
                kind = "" if is_link else "folder" if shown.endswith("/") else "file"
                yield _Member(shown, entry.file_size, kind, partial(zip.open, entry))


def _decompressed(content: bytes, room: Room) -> bytes:
    for sign, opener in _COMPRESSED:
        if content.startswith(sign):
            with opener(io.BytesIO(content)) as file:
                plain = file.read(room.size + 1)
            if len(plain) > room.size:
                raise Unpackable(_TOO_MUCH)
            return plain
    return content


def _readable(entry: zipfile.ZipInfo) -> str:
    """Return the name in Unicode; some systems write UTF-8 without saying so."""
    name = entry.filename
    if not entry.flag_bits & 0x800:
        with contextlib.suppress(UnicodeError):
            name = name.encode("cp437").decode("utf-8")
    return name.replace("\\", "/")


def _write(member: _Member, target: Path, room: Room, numbers: dict[Path, int]) -> bool:
    """Unpack a file or make a folder; return False for what is left out, whose folder is made.

    numbers: the last number of each name that occurred twice.
    """
    name = re.sub(r"^[A-Za-z]:", "", member.name)
    parts = [_short(part) for part in PurePosixPath(name).parts if part not in ("/", "//", "..")]
    parts = parts if len(parts) <= MAX_PARTS else [*parts[: MAX_PARTS - 1], parts[-1]]
    folder = target.joinpath(*(parts if member.kind == "folder" else parts[:-1]))
    if member.kind == "file" and member.size > room.size:
        raise Unpackable(_TOO_MUCH)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except (FileExistsError, NotADirectoryError):  # a file has the name of one of its folders
        return False
    if member.kind != "file" or not parts:
        return member.kind == "folder"
    place = wanted = folder / parts[-1]
    while place.exists():
        number = numbers[wanted] = numbers.get(wanted, 1) + 1
        place = place.with_name(f"{wanted.stem} ({number}){place.suffix}")
    with member.open() as source, place.open("xb") as file:
        while part := source.read(2**20):
            room.size -= len(part)
            if room.size < 0:
                raise Unpackable(_TOO_MUCH)
            file.write(part)
    return True


def _short(part: str) -> str:
    """Return a part of a name that every file system takes; its end, with the suffix, stays."""
    part = re.sub(r"[\x00-\x1f\x7f]", "_", part.encode("utf-8", "replace").decode())
    while len(part.encode()) > MAX_NAME:
        part = part[len(part.encode()) - MAX_NAME :]
    return part


_SIGNS: tuple[tuple[bytes, str], ...] = (
    (b"%PDF", "a PDF file"),
    (b"{\\rtf", "a rich text file"),
    (b"Rar!\x1a\x07", "a RAR archive"),
    (b"7z\xbc\xaf'\x1c", "a 7z archive"),
    (b"\x28\xb5\x2f\xfd", "a compressed file"),
    (b"\x1f\x8b", "a compressed file"),
    (b"BZh", "a compressed file"),
    (b"\xfd7zXZ", "a compressed file"),
    (b"\xd0\xcf\x11\xe0", "an Office document"),
    (b"\x89PNG", "a picture"),
    (b"\xff\xd8\xff", "a picture"),
    (b"\x93NUMPY", "an array"),
    (b"\x7fELF", "a program of the system"),
    (b"b0VIM", "a file of the editor Vim"),
    (b"version https://git-lfs", "a pointer of Git LFS"),
    (b"Bud1", "a file of the system"),
)
_DOCUMENT = re.compile(r"(?i)\.(docx|docm|odt|pptx|odp|xlsx|ods|pages|key|numbers)$")
_PAGE = re.compile(r"\s*(<\?xml[^>]*>\s*)?(<!--.*?-->\s*)?<(!doctype +html|html)\b", re.I | re.S)
DATA = (
    ".npy", ".npz", ".csv", ".json", ".ini", ".png", ".jpg", ".jpeg", ".gif", ".svg", ".dat", ".pt",
    ".pth", ".onnx", ".yaml", ".yml", ".toml", ".xml", ".urdf", ".stl", ".obj", ".mp4",
)  # fmt: skip
"""Suffixes of data files, which a program reads or writes."""
SIGN = 512
"""Bytes at the beginning of a file that tell what it is."""


def kind_of(head: bytes, name: str) -> str:
    """Return what a file is, in words; "" if it may be a text. head: its first bytes."""
    if head.startswith(b"PK\x03\x04"):
        return "an Office document" if _DOCUMENT.search(name) else "a zip file"
    return next((words for sign, words in _SIGNS if head.startswith(sign)), "")


def is_archive(head: bytes, name: str) -> bool:
    """Return whether `unpack` opens a file with these first bytes."""
    if head.startswith((b"PK\x03\x04", b"PK\x05\x06")):
        return not _DOCUMENT.search(name)
    return head[257:262] == b"ustar" or head.startswith((b"\x1f\x8b", b"BZh", b"\xfd7zXZ"))


def is_page(text: str) -> bool:
    """Return whether a text is a web page, whatever its name."""
    return bool(_PAGE.match(text[:2000]))


def may_hold_code(name: str) -> bool:
    """Return whether a file of this name may be a program or a notebook."""
    lower = name.lower()
    return lower.endswith(".json") or not lower.endswith(DATA)
