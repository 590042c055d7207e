"""Write TensorBoard's event files without TensorFlow or torch.

A file is a sequence of records: length (uint64), its checksum, the bytes of an Event, their
checksum. The Event is a protocol buffer: wall_time = 1 (double), step = 2 (varint), file_version =
3 (string), summary = 5 of value = 1 of tag = 1 (string) and simple_value = 2 (float).
"""

from __future__ import annotations

import struct
from collections.abc import Mapping


def version(wall_time: float) -> bytes:
    """Return the record that a file begins with."""
    return _record(_double(1, wall_time) + _bytes(3, b"brain.Event:2"))


def scalars(step: int, values: Mapping[str, float], wall_time: float) -> bytes:
    """Return a record with the value of each tag after this many steps."""
    summary = b"".join(
        _bytes(1, _bytes(1, tag.encode()) + b"\x15" + struct.pack("<f", value))
        for tag, value in values.items()
    )
    return _record(_double(1, wall_time) + b"\x10" + _varint(step) + _bytes(5, summary))


def _double(field: int, value: float) -> bytes:
    return bytes([field << 3 | 1]) + struct.pack("<d", value)


def _bytes(field: int, content: bytes) -> bytes:
    return bytes([field << 3 | 2]) + _varint(len(content)) + content


def _varint(value: int) -> bytes:
    out = bytearray()
    while value > 127:
        out.append(value & 127 | 128)
        value >>= 7
    return bytes([*out, value])


def _record(content: bytes) -> bytes:
    length = struct.pack("<Q", len(content))
    return length + _checksum(length) + content + _checksum(content)


def _table() -> list[int]:
    table = []
    for value in range(256):
        for _ in range(8):
            value = value >> 1 ^ (0x82F63B78 if value & 1 else 0)
        table.append(value)
    return table


_TABLE = _table()


def _checksum(content: bytes) -> bytes:
    """Return the CRC-32C, masked as TensorBoard's files require."""
    crc = 0xFFFFFFFF
    for byte in content:
        crc = crc >> 8 ^ _TABLE[(crc ^ byte) & 255]
    crc ^= 0xFFFFFFFF
    return struct.pack("<I", ((crc >> 15 | crc << 17) + 0xA282EAD8) & 0xFFFFFFFF)
