"""Answers at once, and from a thread again and again, also when nothing was asked."""

import json
import os
import threading
import time


def talk():
    text = json.dumps({"value": [1, 2, 0]}).encode()
    message = len(text).to_bytes(8, "little") + bytes(8) + text
    while True:
        for fd in range(3, 256):
            try:
                os.write(fd, message)
            except OSError:
                continue
        time.sleep(0.001)


def hostile(*arguments, **options):
    for _ in range(3):
        threading.Thread(target=talk, daemon=True).start()
    time.sleep(0.2)
    return [1, 2, 0]
