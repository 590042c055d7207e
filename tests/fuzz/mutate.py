"""Damage files: the same seed and number give the same damage."""

from __future__ import annotations

import io
import random
import re
import zipfile

WORDS = (
    b"", b"nan", b"inf", b"-1", b"0", b"1e309", b"99999999999999999999", b"0x10", b"true", b"null",
    b"../..", b"\x00", b"\xff\xfe", b"\xc3\x28", "\u0663".encode(), "\u2028".encode(), b"%s", b"[]",
    b"{}", b"&a *a", b"!!python/object:os.system", b"1_000", b"--", b"\r", b"\t", b"=", b"[", b"]",
)  # fmt: skip
NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:e-?\d+)?")
LENGTHS = (1, 1, 2, 4, 8, 64, 1000)


def damaged_file(valid: list[bytes], chance: random.Random) -> bytes:
    """Return a damaged file; most of those that are archives have a damaged member instead."""
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
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w") as archive:
        for name, content in members.items():
            archive.writestr(zipfile.ZipInfo(name), content)
    return out.getvalue()


def damaged(valid: list[bytes], chance: random.Random) -> bytes:
    """Return one of the valid files with one to four kinds of damage."""
    data = bytearray(chance.choice(valid))
    for _ in range(chance.choice((1, 1, 2, 4))):
        chance.choice(KINDS)(data, valid, chance)
    return bytes(data)


def _place(data: bytearray, chance: random.Random) -> int:
    return min(chance.randrange(len(data) + 1), chance.randrange(len(data) + 1))


def _flip(data: bytearray, valid: list[bytes], chance: random.Random) -> None:
    if data:
        data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)


def _byte(data: bytearray, valid: list[bytes], chance: random.Random) -> None:
    if data:
        data[chance.randrange(len(data))] = chance.randrange(256)


def _cut(data: bytearray, valid: list[bytes], chance: random.Random) -> None:
    place = _place(data, chance)
    del data[place : place + chance.choice(LENGTHS)]


def _end(data: bytearray, valid: list[bytes], chance: random.Random) -> None:
    del data[chance.randrange(len(data) + 1) :]


def _twice(data: bytearray, valid: list[bytes], chance: random.Random) -> None:
    place, length = _place(data, chance), chance.choice(LENGTHS)
    data[place:place] = data[place : place + length] * chance.choice((1, 1, 20))


def _word(data: bytearray, valid: list[bytes], chance: random.Random) -> None:
    place = _place(data, chance)
    data[place : place + chance.choice((0, 1, 4))] = chance.choice(WORDS)


def _number(data: bytearray, valid: list[bytes], chance: random.Random) -> None:
    found = list(NUMBER.finditer(data))
    if found:
        match = chance.choice(found)
        data[match.start() : match.end()] = chance.choice(WORDS)


def _other(data: bytearray, valid: list[bytes], chance: random.Random) -> None:
    """The rest of another file."""
    other = chance.choice(valid)
    place = chance.randrange(len(other) + 1)
    data[_place(data, chance) :] = other[place:]


def _line(data: bytearray, valid: list[bytes], chance: random.Random) -> None:
    lines = data.split(b"\n")
    first, second = chance.randrange(len(lines)), chance.randrange(len(lines))
    if chance.random() < 0.3:
        del lines[first]
    elif chance.random() < 0.5:
        lines[first], lines[second] = lines[second], lines[first]
    else:
        lines.insert(first, lines[second])
    data[:] = b"\n".join(lines)


KINDS = (_flip, _byte, _cut, _end, _twice, _word, _number, _other, _line)
