"""What goes over the wire: dicts of plain values and arrays as bytes, by msgpack. Nothing that is
unpacked can be code."""

from __future__ import annotations

import zlib
from hashlib import blake2b
from typing import Any

import msgpack
import numpy as np

from botschool.evolution.algorithms.drawing import Cloud

ARRAY, PACKED = 1, 2
TYPES = {"<f8", "<f4", "<i4", "<i8", "<u4", "<u8", "|u1"}
STREAM = ("counter", "key")
WORTH = 64
"""Bytes from which whole numbers are compressed: seeds and places are regular."""


def pack(value: Any) -> bytes:
    """Numbers, strings, bytes, arrays, and lists and dicts of such, as bytes."""
    return msgpack.packb(value, default=_array, use_bin_type=True)


def unpack(data: bytes) -> Any:
    """The reverse of `pack`; raises ValueError for anything else."""
    return msgpack.unpackb(data, ext_hook=_from, raw=False, strict_map_key=False)


def _array(value: Any) -> msgpack.ExtType:
    if isinstance(value, np.generic):
        value = np.array(value)
    if not isinstance(value, np.ndarray):
        raise TypeError(f"{type(value).__name__} does not go over the wire")
    value = np.ascontiguousarray(value).view(np.ndarray)
    data, code = value.tobytes(), ARRAY
    if value.dtype.kind in "iu" and len(data) >= WORTH:
        data, code = zlib.compress(data, 1), PACKED
    return msgpack.ExtType(code, msgpack.packb([value.dtype.str, list(value.shape), data]))


def _from(code: int, data: bytes) -> np.ndarray:
    kind, shape, content = msgpack.unpackb(data)
    if kind not in TYPES or code not in (ARRAY, PACKED):
        raise ValueError(f"{kind} is no array of botschool's")
    content = zlib.decompress(content) if code == PACKED else content
    return np.frombuffer(content, dtype=kind).reshape(shape)


def digest(data: bytes) -> bytes:
    """A name for data: equal if and only if the data are."""
    return blake2b(data, digest_size=12).digest()


def cloud_packed(cloud: Cloud) -> bytes:
    """A cloud as a table: see `table`."""
    stream = cloud.stream
    words = [stream["buffer_pos"], stream["has_uint32"], stream["uinteger"]]
    return pack(
        {
            "centres": cloud.centres,
            "samplesize": cloud.samplesize,
            "deviation": cloud.deviation,
            "both": cloud.both,
            "stream": {name: stream["state"][name] for name in STREAM},
            "buffer": stream["buffer"],
            "words": words,
        }
    )


def table(data: bytes) -> Any:
    """What a table holds: an array, a Cloud, or an experiment as a dict."""
    value = unpack(data)
    if not (isinstance(value, dict) and "centres" in value):
        return value
    position, has, rest = value["words"]
    stream = {
        "bit_generator": "Philox",
        "state": {name: np.array(value["stream"][name]) for name in STREAM},
        "buffer": np.array(value["buffer"]),
        "buffer_pos": position,
        "has_uint32": has,
        "uinteger": rest,
    }
    deviation = value["deviation"]
    return Cloud(value["centres"], value["samplesize"], deviation, value["both"], stream)
