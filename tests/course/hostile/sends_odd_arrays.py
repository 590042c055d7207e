"""Sends arrays that keep the letter of the protocol: of giant shapes, many axes, odd bits."""

import itertools
import json
import os

_turn = itertools.count(os.getpid())


def hostile(*arguments, **options):
    value, data = [
        ({"__array__": ["|b1", [3]]}, b"\x02\xff\x80"),
        ({"__array__": ["<f8", [0, 2**62, 2**62]]}, b""),
        ({"__array__": ["<f8", [1] * 70]}, bytes(8)),
        ({"__array__": ["<f8", [3]]}, b"\x01\x00\x00\x00\x00\x00\xf8\x7f" * 3),
        ([{"__array__": ["|u1", [0]]}] * 200_000, b""),
        ({"a": 1, "__array__": {"x": 1}}, b""),
        ({"best": float("inf"), "mean": -0.0, "x" * 10**6: None}, b""),
        ([[]] * 1_500_000, b""),
    ][next(_turn) % 8]
    text = json.dumps({"value": value}).encode()
    message = len(text).to_bytes(8, "little") + len(data).to_bytes(8, "little") + text + data
    for fd in range(3, 256):
        try:
            os.write(fd, message)
        except OSError:
            continue
    return 0
