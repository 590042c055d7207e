"""Exchange plain data between the caller and untrusted code: no pickles, no live objects.

A message is two lengths of 8 bytes, UTF-8 JSON, and the bytes of the arrays one after another.
It can hold numbers, strings, booleans, None, lists (tuples become lists), dicts with string keys
and numpy arrays of numbers; in the JSON an array is {"__array__": [type, shape]}. An incoming
message may be forged, so its size is bounded and it yields nothing but plain data.
"""

from __future__ import annotations

import json
import math
import os
import re
import select
import selectors
import time
from collections.abc import Callable
from typing import Any

import numpy as np

MAX_TEXT = 4 * 2**20
"""Bytes of JSON in a message; the Python objects take about ten times as much."""
MAX_ARRAYS = 50_000
"""Arrays in a message."""
MAX_DATA = 64 * 2**20
"""Bytes of the arrays in a message."""
MAX_DEPTH = 50
"""Levels of nested lists."""
MAX_DIGITS = 300
"""Digits of an integer."""
POLL_SECONDS = 0.05
"""Seconds between two checks of the time left."""
Left = Callable[[], float]
_HEAD = 16
_AT_ONCE = 2**16
"""Bytes of a read: what a pipe holds."""
_KIND = re.compile(r"[<>|=]?[biuf][1248]")


class NotPlain(Exception):
    """The value holds something that a message cannot; the text says what."""


def pack(value: Any) -> bytes:
    """Return the message of a value. Raises NotPlain."""
    blobs: list[bytes] = []
    text = json.dumps(_simple(value, blobs, 0)).encode()
    data = b"".join(blobs)
    if len(blobs) > MAX_ARRAYS:
        raise NotPlain(f"{len(blobs)} arrays, which are too many")
    if len(text) > MAX_TEXT or len(data) > MAX_DATA:
        raise NotPlain(f"{(len(text) + len(data)) / 2**20:.0f} MB of data, which is too much")
    return len(text).to_bytes(8, "little") + len(data).to_bytes(8, "little") + text + data


def unpack(message: bytes) -> Any:
    """Return the value of a message. Raises ValueError if the message is damaged."""
    try:
        length = int.from_bytes(message[:8], "little")
        text, data = message[_HEAD : _HEAD + length], memoryview(message)[_HEAD + length :]
        restored = _Restored(data)
        value = restored.of(json.loads(text.decode(), parse_int=_integer), 0)
    except (ValueError, KeyError, TypeError, RecursionError, MemoryError, OverflowError) as error:
        raise ValueError("damaged message") from error
    if restored.used != len(data):
        raise ValueError("damaged message")
    return value


def receive(fd: int, seconds: float | Left) -> bytes | None:
    """Return the next message from a pipe; None at its end. Raises TimeoutError and ValueError.

    seconds: to wait, or a function that returns the seconds left.
    """
    left, parts, length = _left(seconds), bytearray(), _HEAD
    while len(parts) < length:
        _wait(fd, select.POLLIN, left)
        part = os.read(fd, _AT_ONCE)
        if not part:
            return None
        parts += part
        if length == _HEAD <= len(parts):
            text, data = (int.from_bytes(parts[at : at + 8], "little") for at in (0, 8))
            if text > MAX_TEXT or data > MAX_DATA:
                raise ValueError("message too long")
            length += text + data
    if len(parts) > length:
        raise ValueError("more than a message")
    return bytes(parts)


def read_some(fd: int, most: int, seconds: float) -> bytes:
    """Return up to about `most` bytes that arrive from a pipe within some seconds.

    The function stops early when nothing has come for 2 * POLL_SECONDS.
    """
    parts, deadline = bytearray(), time.monotonic() + seconds
    with selectors.DefaultSelector() as selector:
        selector.register(fd, selectors.EVENT_READ)
        while len(parts) < most and (left := deadline - time.monotonic()) > 0:
            if not selector.select(min(left, 2 * POLL_SECONDS) if parts else left):
                break
            part = os.read(fd, most - len(parts))
            if not part:
                break
            parts += part
    return bytes(parts)


def send(fd: int, message: bytes, seconds: float | Left) -> None:
    """Write to a pipe that does not block. Raises TimeoutError and BrokenPipeError.

    seconds: to wait, or a function that returns the seconds left.
    """
    left, rest = _left(seconds), memoryview(message)
    while rest:
        try:
            rest = rest[os.write(fd, rest) :]
        except BlockingIOError:
            _wait(fd, select.POLLOUT, left)


def _left(seconds: float | Left) -> Left:
    if callable(seconds):
        return seconds
    deadline = time.monotonic() + seconds
    return lambda: deadline - time.monotonic()


def _wait(fd: int, event: int, left: Left) -> None:
    """Wait until the pipe is ready, or closed. Raises TimeoutError."""
    waiting = select.poll()
    waiting.register(fd, event)
    while True:
        seconds = left()
        if seconds <= 0:
            raise TimeoutError
        if waiting.poll(1000 * min(seconds, POLL_SECONDS)):
            return


def _simple(value: Any, blobs: list[bytes], depth: int) -> Any:
    if depth > MAX_DEPTH:
        raise NotPlain("lists nested too deeply")
    if type(value) is int and value.bit_length() > 3 * MAX_DIGITS:
        raise NotPlain("an integer with hundreds of digits")
    if value is None or type(value) in (bool, int, float, str):
        return value
    if isinstance(value, np.generic) and _KIND.fullmatch(value.dtype.str):
        return value.item()
    if isinstance(value, np.ndarray):
        if not _KIND.fullmatch(value.dtype.str):
            raise NotPlain(f"an array of {value.dtype}")
        if value.nbytes > MAX_DATA:
            raise NotPlain(f"an array of {value.nbytes // 2**20} MB")
        blobs.append(value.tobytes())
        return {"__array__": [value.dtype.str, list(value.shape)]}
    if isinstance(value, (list, tuple)):
        return [_simple(item, blobs, depth + 1) for item in value]
    if isinstance(value, dict):
        simple = {}
        for key, item in value.items():
            if type(key) not in (str, int):
                raise NotPlain(f"a dict with a {type(key).__name__} as key")
            simple[str(key)] = _simple(item, blobs, depth + 1)
        return simple
    raise NotPlain(f"an object of type {type(value).__name__}")


class _Restored:
    """Rebuild values from JSON and the arrays' bytes."""

    def __init__(self, data: memoryview) -> None:
        self._data = data
        self._arrays = 0
        self.used = 0

    def of(self, value: Any, depth: int) -> Any:
        if depth > 2 * MAX_DEPTH:
            raise ValueError("too deep")
        if isinstance(value, str):
            return value.encode("utf-8", "replace").decode()
        if isinstance(value, list):
            return [self.of(item, depth + 1) for item in value]
        if not isinstance(value, dict):
            return value
        if "__array__" in value:
            return self._array(*value["__array__"])
        return {self.of(key, depth): self.of(item, depth + 1) for key, item in value.items()}

    def _array(self, kind: str, shape: list[int]) -> np.ndarray:
        if not _KIND.fullmatch(kind) or any(type(n) is not int or n < 0 for n in shape):
            raise ValueError("an array of something other than numbers")
        self._arrays += 1
        if self._arrays > MAX_ARRAYS:
            raise ValueError("too many arrays")
        dtype = np.dtype(kind)
        start = self.used
        self.used += math.prod(shape) * dtype.itemsize
        if self.used > len(self._data):
            raise ValueError("an array with missing numbers")
        return np.frombuffer(self._data[start : self.used], dtype).reshape(shape).copy()


def _integer(digits: str) -> int:
    if len(digits) > MAX_DIGITS + 1:
        raise ValueError("a number with too many digits")
    return int(digits)
