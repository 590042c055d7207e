"""Write curves for TensorBoard (`tensorboard --logdir FOLDER`) without importing it.

An event file is a TFRecord file of Event messages in Protocol Buffers' wire format. This module
writes both, because importing TensorBoard takes longer than many runs. Formats:
https://github.com/tensorflow/tensorboard/tree/master/tensorboard/compat/proto (event.proto,
summary.proto), https://protobuf.dev/programming-guides/encoding and
https://www.tensorflow.org/tutorials/load_data/tfrecord#tfrecords_format_details
"""

from __future__ import annotations

import math
import shutil
import struct
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from botschool.evolution.record import STAT
from botschool.output import cannot_write, make_again

VERSION = "brain.Event:2"
"""The version that begins an event file."""
BUCKETS = 30
"""Intervals of a histogram."""
POINTS = 1000
"""Points per curve; TensorBoard shows no more."""


class Events:
    """Appends generations to an event file, about POINTS of them in a whole run."""

    def __init__(self, folder: Path, whole: float) -> None:
        """Start the file and remove older ones; whole: steps of the whole run, 0 to keep all."""
        self._folder = folder
        self._spacing = whole / POINTS
        self._next = 0.0
        self._file: Path | None = None

    def lost(self) -> bool:
        """Return whether the file was removed; if so, the next `append` begins another one."""
        if self._file is None or self._file.exists():
            return False
        self._file, self._next = None, 0.0
        return True

    def append(self, first: int, rows: np.ndarray, columns: Sequence[str] = STAT) -> None:
        """Append generations from number `first`; rows: (generations, columns), steps first."""
        now = time.time()
        events = [] if self._file else [event(now, version=VERSION)]
        for generation, row in enumerate(rows.tolist(), first + 1):
            if row[0] < self._next:
                continue
            self._next = row[0] + self._spacing
            values = [*zip(columns[1:], row[1:], strict=True), ("generation", generation)]
            events.append(event(now, int(row[0]), values))
        try:
            if self._file is None:
                shutil.rmtree(self._folder, ignore_errors=True)
                make_again(self._folder.parent)
                self._folder.mkdir()
                self._file = self._folder / f"events.out.tfevents.{int(now)}"
            with open(self._file, "ab") as file:
                file.write(b"".join(map(record, events)))
        except OSError as error:
            raise cannot_write(self._folder, error.strerror or str(error)) from error


def event(
    now: float,
    step: int = 0,
    values: Sequence[tuple[str, float]] = (),
    version: str = "",
    histograms: Sequence[tuple[str, np.ndarray]] = (),
) -> bytes:
    """Return an Event message: values of tags at a step, or the version that begins a file.

    histograms: tags with the numbers whose distribution is shown.
    """
    message = b"\x09" + struct.pack("<d", now)  # 1: wall_time
    if step:
        message += b"\x10" + _varint(step)  # 2: step
    if version:
        message += _field(b"\x1a", version.encode())  # 3: file_version
    if values:
        parts = [_value(*each) for each in values] + [_histogram(*each) for each in histograms]
        summary = b"".join(_field(b"\x0a", part) for part in parts)  # 1: value
        message += _field(b"\x2a", summary)  # 5: summary
    return message


def _value(tag: str, number: float) -> bytes:
    try:
        single = struct.pack("<f", number)
    except OverflowError:
        single = struct.pack("<f", math.copysign(math.inf, number))
    return _field(b"\x0a", tag.encode()) + b"\x15" + single  # 1: tag, 2: simple_value


def _histogram(tag: str, numbers: np.ndarray) -> bytes:
    numbers = np.asarray(numbers, dtype=np.float64).ravel()
    if not numbers.size or not np.isfinite(numbers).all():
        return _field(b"\x0a", tag.encode())
    counts, edges = np.histogram(numbers, BUCKETS)
    squares = float((numbers**2).sum())
    moments = (numbers.min(), numbers.max(), numbers.size, numbers.sum(), squares)
    keys = (b"\x09", b"\x11", b"\x19", b"\x21", b"\x29")  # 1: min, max, num, sum, sum_squares
    message = b"".join(k + struct.pack("<d", n) for k, n in zip(keys, moments, strict=True))
    for key, row in ((b"\x32", edges[1:]), (b"\x3a", counts)):  # 6: bucket_limit, 7: bucket
        message += _field(key, struct.pack(f"<{BUCKETS}d", *row))
    return _field(b"\x0a", tag.encode()) + _field(b"\x2a", message)  # 1: tag, 5: histo


def _field(key: bytes, content: bytes) -> bytes:
    return key + _varint(len(content)) + content


def _varint(number: int) -> bytes:
    """Return the number as a varint: seven bits per byte, the lowest first."""
    coded = bytearray()
    while number > 0x7F:
        coded.append(number & 0x7F | 0x80)
        number >>= 7
    coded.append(number)
    return bytes(coded)


def record(content: bytes) -> bytes:
    """Return a TFRecord: length, its checksum, content, its checksum."""
    length = struct.pack("<Q", len(content))
    return b"".join([length, _checksum(length), content, _checksum(content)])


def _checksum(content: bytes) -> bytes:
    """Return the masked CRC-32C."""
    crc = 0xFFFFFFFF
    for byte in content:
        crc = CRC[(crc ^ byte) & 0xFF] ^ crc >> 8
    crc ^= 0xFFFFFFFF
    return struct.pack("<I", ((crc >> 15 | crc << 17) + 0xA282EAD8) & 0xFFFFFFFF)


def _table() -> list[int]:
    """Return the CRC-32C of every byte: Castagnoli's polynomial, its lowest bit first."""
    table = np.arange(256, dtype=np.uint32)
    for _ in range(8):
        table = np.where(table & 1, table >> 1 ^ np.uint32(0x82F63B78), table >> 1)
    return table.tolist()


CRC = _table()
