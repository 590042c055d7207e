"""Answers requests from the background without reading them, so that the pipe fills."""

import os
import threading
import time


def answer():
    text = b'{"value": [1, 2, 0]}'
    while True:
        for fd in range(3, 30):
            try:
                os.write(fd, len(text).to_bytes(8, "little") + bytes(8) + text)
            except OSError:
                continue


def hostile(*arguments, **options):
    threading.Thread(target=answer, daemon=True).start()
    time.sleep(86400)
