"""Tell by its first bytes what a file is, whatever its name."""

from __future__ import annotations

import re

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
