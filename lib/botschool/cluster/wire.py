"""Encode messages: msgpack turns plain values and arrays into bytes, with a checksum in front.

Unpacked data cannot contain code.
"""

from __future__ import annotations

import math
import zlib
from hashlib import blake2b
from typing import Any

import msgpack
import numpy as np

from botschool.errors import said
from botschool.evolution.algorithms.ascent import Start
from botschool.evolution.algorithms.drawing import Cloud

ARRAY, PACKED = 1, 2
TYPES = {"<f8", "<f4", "<i4", "<i8", "<u4", "<u8", "|u1"}
FIELDS = {
    Cloud: ("centres", "samplesize", "deviation", "both"),
    Start: ("centres", "m", "v", "samplesize", "deviation", "stepsize", "wdecay"),
}
"""Contents of a table of each kind, besides a stream."""
WORTH = 64
"""Size in bytes from which whole numbers are compressed: seeds and indices are regular."""
LARGEST = 64_000_000
"""Largest size in bytes of a message's arrays when decompressed."""
CHECKSUM = 4
"""Bytes of the checksum before a message."""


def pack(value: Any) -> bytes:
    """Return numbers, strings, bytes, arrays, and lists and dicts of such, as bytes."""
    data = msgpack.packb(value, default=_array, use_bin_type=True)
    return _checksum(data) + data


def unpack(data: bytes) -> Any:
    """Reverse `pack`. Raises ValueError for damaged or foreign data, and for arrays that would
    become larger than LARGEST.
    """
    content = memoryview(data)[CHECKSUM:]
    if data[:CHECKSUM] != _checksum(content):
        raise ValueError("the message is damaged")
    try:
        return msgpack.unpackb(content, ext_hook=_Arrays(), raw=False, strict_map_key=False)
    except Exception as error:  # msgpack, zlib and numpy each raise their own
        raise ValueError(f"the message is not one of botschool's ({said(error)})") from None


def _checksum(data: bytes | memoryview) -> bytes:
    return zlib.crc32(data).to_bytes(CHECKSUM, "little")


def _array(value: Any) -> msgpack.ExtType:
    if isinstance(value, np.generic):
        value = np.array(value)
    if not isinstance(value, np.ndarray):
        raise TypeError(f"{type(value).__name__} cannot be sent")
    value = np.ascontiguousarray(value).view(np.ndarray)
    data, code = value.tobytes(), ARRAY
    if value.dtype.kind in "iu" and WORTH <= len(data) <= LARGEST // 8:
        data, code = zlib.compress(data, 1), PACKED
    return msgpack.ExtType(code, msgpack.packb([value.dtype.str, list(value.shape), data]))


class _Arrays:
    """The arrays of one message, unpacked one after another."""

    def __init__(self) -> None:
        self._left = LARGEST

    def __call__(self, code: int, data: bytes) -> np.ndarray:
        kind, shape, content = msgpack.unpackb(data)
        if kind not in TYPES or code not in (ARRAY, PACKED):
            raise ValueError(f"{kind} is not an array of botschool's")
        if code == PACKED:
            content = self._decompressed(content, np.dtype(kind).itemsize * math.prod(shape))
        return np.frombuffer(content, dtype=kind).reshape(shape)

    def _decompressed(self, content: bytes, size: int) -> bytes:
        self._left -= size
        if size < 1 or self._left < 0:
            raise ValueError(f"its arrays have more than {LARGEST} bytes")
        decompressor = zlib.decompressobj()
        found = decompressor.decompress(content, size + 1)
        if len(found) != size or not decompressor.eof:
            raise ValueError("an array has another size than it declares")
        return found


def digest(data: bytes) -> bytes:
    """Return a name for data: equal if and only if the data are."""
    return blake2b(data, digest_size=12).digest()


def packed(value: Cloud | Start) -> bytes:
    """Return the source of drawn candidates as a table: see `table`."""
    kind = type(value)
    told = {"kind": kind.__name__, "fields": {name: getattr(value, name) for name in FIELDS[kind]}}
    places = value.places[1:] if isinstance(value, Cloud) else []
    return pack(told | {"stream": value.stream, "places": places})


def table(data: bytes) -> Any:
    """Return the contents of a table: an array, a Cloud, a Start, or an experiment as a dict."""
    value = unpack(data)
    name = value.get("kind") if isinstance(value, dict) else None
    kind = next((each for each in FIELDS if each.__name__ == name), None)
    if kind is None:
        return value
    stream = tuple(value["stream"])
    if kind is Start:
        return Start(**value["fields"], stream=stream)
    places = [stream, *map(tuple, value["places"])]
    return Cloud(**value["fields"], stream=stream, places=places)
