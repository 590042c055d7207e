"""Writes its own answers, and whole results, into every pipe."""

import json
import os


def hostile(*arguments, **options):
    for value in (
        {"value": [1, 2, 0]}, {"points": 100}, {"value": True, "points": 100, "max_points": 100},
        [100], None, {"error": 1, "text": {}, "line": []}, {"value": {"__array__": ["<f8", [3]]}},
    ):  # fmt: skip
        text = json.dumps(value).encode()
        message = len(text).to_bytes(8, "little") + bytes(8) + text
        for fd in range(3, 30):
            try:
                os.write(fd, message * 3)
            except OSError:
                continue
    return 0
