"""Sends what is no message: lengths beyond all bounds, brackets, endless digits, nothing."""

import itertools
import os

_turn = itertools.count(os.getpid())


def hostile(*arguments, **options):
    text = [
        b"[" * 8_000_000,
        b"9" * 8_000_000,
        b'"\\ud800\\u0000"' * 1000,
        b'{"value": {"__array__": ["<f8", [1e9, -1]]}}',
        b'{"value": {"__array__": ["O", [100000000]]}}',
        b'{"value": {"__array__": ["<f8", [4611686018427387904, 4611686018427387904]]}}',
        b'{"value": [' + b"{}," * 2_500_000 + b"{}]}",
    ][next(_turn) % 7]
    head = len(text).to_bytes(8, "little") + bytes(8)
    for message in (head + text, b"\xff" * 16, b"\x10" + bytes(15)):
        for fd in range(3, 30):
            try:
                os.write(fd, message)
            except OSError:
                continue
    while True:
        pass
